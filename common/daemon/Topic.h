#pragma once

#include <QJsonObject>
#include <QString>
#include <functional>

namespace hermes {

/// A topic, declared once: `Topic("temperature", "Each reading").schema({{"type", "number"}})`.
class Topic {
public:
    using Snapshot = std::function<QJsonValue()>;

    Topic(const QString &name, const QString &summary)
        : topicName(name)
        , topicSummary(summary) {}

    /// The JSON Schema of the data.
    Topic &schema(const QJsonObject &dataSchema) {
        content = dataSchema;
        return *this;
    }
    /// Gives the full state with which a subscription begins; undefined: nothing yet.
    Topic &snapshot(const Snapshot &function) {
        state = function;
        return *this;
    }

    const QString &name() const { return topicName; }
    const Snapshot &snapshot() const { return state; }
    /// {name, summary, schema, snapshot}
    QJsonObject description() const {
        return {{QStringLiteral("name"), topicName},
                {QStringLiteral("summary"), topicSummary},
                {QStringLiteral("schema"), content},
                {QStringLiteral("snapshot"), bool(state)}};
    }

private:
    QString topicName;
    QString topicSummary;
    QJsonObject content;
    Snapshot state;
};

} // namespace hermes
