#pragma once

#include <QHash>
#include <QObject>
#include <QPointer>
#include <deque>
#include <functional>

namespace hermes {

/// Work of a thread's event loop that may wait, in small steps: one step of each owner in turn, those of one
/// owner in the order in which they were added, for a millisecond altogether, then sockets and timers are
/// served. However much there is to do, what is urgent waits no longer than that and one step. Who has had
/// nothing to do for a while since its last step goes first: whoever asks now and then does not wait for all
/// of a crowd that asks, or comes, without end.
class Turns : public QObject {
    Q_OBJECT
public:
    /// That of the calling thread.
    static Turns &ofThread();

    using Step = std::function<bool()>;

    /// Calls step from the event loop until it gives false, or owner is gone; one that gives true is added
    /// again. The owner lives in this thread.
    void add(QObject *owner, const Step &step);

private:
    struct Work {
        QPointer<QObject> owner;
        std::deque<Step> steps;
    };
    struct LastStep {
        QPointer<QObject> owner;
        double end; // monotonic; infinity while it runs
    };
    using Owners = std::deque<QObject *>;

    void add(QObject *owner, const Step &step, Owners &owners);
    void post();
    void run();
    void runNext();
    bool isIdle() const { return rested_.empty() && busy_.empty(); }
    Owners &next();
    bool hasRested(QObject *owner) const;
    void noteStep(QObject *owner, double end);

    QHash<QObject *, Work> works_; // whoever has one is once in one of these:
    Owners rested_;
    Owners busy_;
    bool wasRested_ = false;               // the step before was of one of those
    QHash<QObject *, LastStep> lastSteps_; // of some who have gone, too
    bool posted_ = false;                  // a call is in the event queue
};

/// Does this in a thread of its own, one after the other, where it delays nothing that is urgent. To be
/// called from the main thread.
void inBackground(const std::function<void()> &work);

} // namespace hermes
