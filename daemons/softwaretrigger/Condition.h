#pragma once

#include <QJsonValue>
#include <QString>
#include <optional>

namespace hermes::softwaretrigger {

/// The value at a dotted path with numbers for elements of arrays; undefined where there is none. "" is the
/// whole.
QJsonValue lookUp(QJsonValue data, const QString &path);

/// Watches for a value in messages to become such that `value OP limit`.
class Condition {
public:
    Condition(QString path, QString op, QJsonValue limit)
        : path_(std::move(path))
        , op_(std::move(op))
        , limit_(std::move(limit)) {}

    /// Whether it is true now and was not before the message; the first message counts as a change. Nothing:
    /// the path is not in the message, or op does not compare what stands there; then nothing is known to
    /// have changed.
    std::optional<bool> becomesTrue(const QJsonValue &data);

private:
    std::optional<bool> holds(const QJsonValue &value) const;

    QString path_, op_;
    QJsonValue limit_;
    bool held_ = false;
};

} // namespace hermes::softwaretrigger
