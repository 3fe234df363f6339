#pragma once

#include <QHash>
#include <QObject>
#include <QPointer>
#include <deque>
#include <functional>

namespace hermes {

/// Work of a thread's event loop that may wait, in small steps: one step of each work in turn, for a
/// millisecond altogether, then sockets and timers are served. However much there is to do, what is urgent
/// waits no longer than that and one step. Who has had nothing to do for a while goes first: whoever asks now
/// and then does not wait for all of a crowd that asks without end.
class Turns : public QObject {
    Q_OBJECT
public:
    /// That of the calling thread.
    static Turns &ofThread();

    /// Calls step from the event loop until it gives false, or owner is gone.
    void add(QObject *owner, const std::function<bool()> &step);

private:
    struct Work {
        QPointer<QObject> owner;
        std::function<bool()> step;
    };
    using Works = std::deque<Work>;

    void post();
    void run();
    Works &next();
    bool hasRested(QObject *owner);

    Works rested_;
    Works busy_;
    bool wasRested_ = false;             // the step before was of one of those
    QHash<QObject *, double> lastSteps_; // monotonic; of some who have gone, too
    bool posted_ = false;                // a call is in the event queue
};

/// Does this in a thread of its own, one after the other, where it delays nothing that is urgent.
void inBackground(const std::function<void()> &work);

} // namespace hermes
