#include "common/Turns.h"

#include "common/Time.h"

#include <QCoreApplication>
#include <QThreadPool>
#include <QThreadStorage>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace hermes {
namespace {

constexpr double longest_s = 0.001;
constexpr double rest_s = 0.002;
constexpr int mostKnown = 10000;
constexpr int backgroundNiceness = 5;

} // namespace

Turns &Turns::ofThread() {
    static QThreadStorage<Turns *> all;
    if (!all.hasLocalData())
        all.setLocalData(new Turns);
    return *all.localData();
}

void Turns::add(QObject *owner, const std::function<bool()> &step) {
    (hasRested(owner) ? rested_ : busy_).push_back({owner, step});
    post();
}

bool Turns::hasRested(QObject *owner) {
    const auto last = lastSteps_.constFind(owner);
    return last == lastSteps_.constEnd() || monotonicNow() - *last > rest_s;
}

// In turn, so that a crowd of those who have rested does not keep the others waiting for good.
Turns::Works &Turns::next() {
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
    const double end = monotonicNow() + longest_s;
    for (double now = monotonicNow(); now < end && !(rested_.empty() && busy_.empty());
         now = monotonicNow()) {
        Works &works = next();
        const Work work = std::move(works.front());
        works.pop_front();
        if (!(rested_.empty() && busy_.empty()))
            post(); // a step may run an event loop of its own, which waits for the others
        if (!work.owner)
            continue;
        if (lastSteps_.size() > mostKnown)
            lastSteps_.clear();
        lastSteps_.insert(work.owner, now);
        if (work.step() && work.owner)
            busy_.push_back(work);
    }
    if (!(rested_.empty() && busy_.empty()))
        post();
}

void inBackground(const std::function<void()> &work) {
    static QPointer<QThreadPool> pool;
    if (!pool) {
        pool = new QThreadPool(QCoreApplication::instance());
        pool->setMaxThreadCount(1);
    }
    pool->start([work] {
        static thread_local const int lowered = // a thread inherits the niceness of who starts it
            ::setpriority(PRIO_PROCESS, id_t(::syscall(SYS_gettid)), backgroundNiceness);
        Q_UNUSED(lowered)
        work();
    });
}

} // namespace hermes
