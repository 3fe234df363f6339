#pragma once

#include "common/Result.h"

#include <QHash>
#include <QObject>
#include <QSet>
#include <QString>

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

/// Lines of GPIO chips as outputs, by the kernel's own interface. A line is taken, and low, from the first
/// use on.
class GpioLines {
public:
    /// chip: name, number or path; offset: of its line. DeviceFault names both.
    Result<void> set(const QString &chip, int offset, bool on);
    void close();
    ~GpioLines() { close(); }

private:
    QHash<QString, int> lines_; ///< their descriptors, by chip and offset
};

} // namespace hermes::softwaretrigger
