#pragma once

#include "common/Role.h"
#include "protocol/messages/Daemons.h"
#include "protocol/wire/Outgoing.h"

#include <functional>

namespace hermes {

/// A topic, declared once: `Topic("temperature", "Each reading").schema({{"type", "number"}})`.
class Topic {
public:
    using Snapshot = std::function<Outgoing()>;
    /// Gives the part of the state that follows `cursor` (0 at first) and moves it on; below 0: it was the
    /// last.
    using SnapshotParts = std::function<Outgoing(qint64 &cursor)>;

    Topic(const QString &name, const QString &summary)
        : topicName_(name)
        , topicSummary_(summary) {}

    /// The JSON Schema of the data.
    Topic &schema(const QJsonObject &dataSchema) {
        content_ = dataSchema;
        return *this;
    }
    /// The struct, with fields, that its data are.
    template <typename T>
    Topic &carries() {
        return schema(schemaOf<T>());
    }
    /// Who may subscribe to it; without a word, observers.
    Topic &needs(Role role) {
        role_ = role;
        return *this;
    }
    /// Gives the full state with which a subscription begins; nothing: there is none as yet.
    Topic &snapshot(const Snapshot &function) {
        state_ = function;
        return *this;
    }

    /// For a state that may be large. Changes are published between the parts: a part has what is true when
    /// it is asked for.
    Topic &snapshotParts(const SnapshotParts &function) {
        parts_ = function;
        return *this;
    }

    const QString &name() const { return topicName_; }
    Role role() const { return role_; }
    const Snapshot &snapshot() const { return state_; }
    const SnapshotParts &snapshotParts() const { return parts_; }
    TopicDescription description() const {
        return {topicName_, topicSummary_, content_, bool(state_) || bool(parts_)};
    }

private:
    QString topicName_;
    QString topicSummary_;
    QJsonObject content_;
    Snapshot state_;
    SnapshotParts parts_;
    Role role_ = Role::Observer;
};

} // namespace hermes
