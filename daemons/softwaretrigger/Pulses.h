#pragma once

#include "common/Result.h"

#include <QObject>
#include <QSet>
#include <functional>

namespace hermes::softwaretrigger {

/// Pulses on output lines: on, and off again after a time. Two pulses of the same line do not overlap.
class Pulses : public QObject {
    Q_OBJECT
public:
    using Set = std::function<Result<void>(bool on)>;
    using Done = std::function<void(const Result<QJsonValue> &)>;

    explicit Pulses(QObject *parent)
        : QObject(parent) {}

    /// Switches the line on now, off after length_s, then calls done. Fails at once when a pulse of the same
    /// line is under way.
    void start(const QString &line, double length_s, const Set &set, const Done &done);

private:
    QSet<QString> active_;
};

} // namespace hermes::softwaretrigger
