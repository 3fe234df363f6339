#pragma once

#include <QObject>
#include <QPointer>
#include <deque>
#include <functional>

namespace hermes {

/// Work of a thread's event loop that may wait, in small steps: one step of each work in turn, for a
/// millisecond altogether, then sockets and timers are served. However much there is to do, what is urgent
/// waits no longer than that and one step.
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

    void post();
    void run();

    std::deque<Work> works_;
    bool posted_ = false; // a call is in the event queue
};

/// Does this in a thread of its own, one after the other, where it delays nothing that is urgent.
void inBackground(const std::function<void()> &work);

} // namespace hermes
