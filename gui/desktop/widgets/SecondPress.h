#pragma once

#include <QTimer>

namespace hermes::desktop {

/// The second press that asks whether the first one was meant: within five seconds, and no double click.
class SecondPress : public QObject {
    Q_OBJECT
public:
    explicit SecondPress(QObject *parent = nullptr)
        : QObject(parent) {
        timer_.setSingleShot(true);
        timer_.setTimerType(Qt::PreciseTimer); // as its remaining time is looked at
        timer_.setInterval(longest_ms);
        connect(&timer_, &QTimer::timeout, this, &SecondPress::changed);
    }

    /// It has been pressed: true when that was the second time.
    bool press() {
        if (!timer_.isActive()) {
            timer_.start();
            Q_EMIT changed();
            return false;
        }
        if (timer_.remainingTime() > longest_ms - shortest_ms)
            return false;
        forget();
        return true;
    }
    bool isAwaited() const { return timer_.isActive(); }
    void forget() {
        if (!timer_.isActive())
            return;
        timer_.stop();
        Q_EMIT changed();
    }

Q_SIGNALS:
    /// It is awaited now, or no longer.
    void changed();

private:
    static constexpr int longest_ms = 5000, shortest_ms = 500;

    QTimer timer_;
};

} // namespace hermes::desktop
