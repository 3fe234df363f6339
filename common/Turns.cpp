#include "common/Turns.h"

#include "common/Time.h"
#include "common/platform/Threads.h"

#include <QCoreApplication>
#include <QThreadPool>
#include <QThreadStorage>
#include <limits>

namespace hermes {
namespace {

constexpr double longestTurn_s = 0.001;
constexpr double rest_s = 0.002;
constexpr int maxKnown = 10000;

} // namespace

Turns &Turns::ofThread() {
    static QThreadStorage<Turns *> all;
    if (!all.hasLocalData())
        all.setLocalData(new Turns);
    return *all.localData();
}

void Turns::add(QObject *owner, const Step &step) {
    add(owner, step, hasRested(owner) ? rested_ : busy_);
}

void Turns::add(QObject *owner, const Step &step, Owners &owners) {
    auto work = works_.find(owner);
    if (work == works_.end()) {
        work = works_.insert(owner, {owner, {}});
        owners.push_back(owner);
    } else if (!work->owner) { // another one was at this address
        *work = {owner, {}};
    }
    work->steps.push_back(step);
    post();
}

// Of many who have just come each would go before those who were here.
bool Turns::hasRested(QObject *owner) const {
    const auto last = lastSteps_.constFind(owner);
    return last != lastSteps_.constEnd() && last->owner == owner && monotonicNow() - last->end > rest_s;
}

// In turn, so that a crowd of those who have rested does not keep the others waiting for good.
Turns::Owners &Turns::next() {
    wasRested_ = !rested_.empty() && (busy_.empty() || !wasRested_);
    return wasRested_ ? rested_ : busy_;
}

void Turns::post() {
    if (std::exchange(posted_, true))
        return;
    QMetaObject::invokeMethod(this, &Turns::run, Qt::QueuedConnection);
}

void Turns::run() {
    posted_ = false;
    const double end = monotonicNow() + longestTurn_s;
    while (monotonicNow() < end && !isIdle())
        runNext();
    if (!isIdle())
        post();
}

void Turns::noteStep(QObject *owner, double end) {
    if (lastSteps_.size() > maxKnown)
        lastSteps_.clear();
    lastSteps_.insert(owner, {owner, end});
}

void Turns::runNext() {
    Owners &owners = next();
    QObject *const key = owners.front();
    owners.pop_front();
    const auto work = works_.find(key);
    const QPointer<QObject> owner = work->owner;
    const Step step = std::move(work->steps.front());
    work->steps.pop_front();
    if (!owner || work->steps.empty())
        works_.erase(work);
    else
        busy_.push_back(key);
    if (!isIdle())
        post(); // a step may run an event loop of its own, which waits for the others
    if (!owner)
        return;
    noteStep(key, std::numeric_limits<double>::infinity()); // it may add its next one itself
    const bool again = step();
    if (!owner)
        return;
    noteStep(key, monotonicNow());
    if (again)
        add(owner, step, busy_);
}

void inBackground(const std::function<void()> &work) {
    static QPointer<QThreadPool> pool;
    if (!pool) {
        pool = new QThreadPool(QCoreApplication::instance());
        pool->setMaxThreadCount(1);
    }
    pool->start([work] {
        static thread_local const bool lowered =
            (lowerThreadPriority(), true); // it inherits that of who starts it
        Q_UNUSED(lowered)
        work();
    });
}

} // namespace hermes
