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
constexpr int backgroundNiceness = 5;

} // namespace

Turns &Turns::ofThread() {
    static QThreadStorage<Turns *> all;
    if (!all.hasLocalData())
        all.setLocalData(new Turns);
    return *all.localData();
}

void Turns::add(QObject *owner, const std::function<bool()> &step) {
    works_.push_back({owner, step});
    post();
}

void Turns::post() {
    if (std::exchange(posted_, true))
        return;
    QMetaObject::invokeMethod(this, &Turns::run, Qt::QueuedConnection);
}

void Turns::run() {
    posted_ = false;
    const double end = monotonicNow() + longest_s;
    while (!works_.empty() && monotonicNow() < end) {
        const Work work = std::move(works_.front());
        works_.pop_front();
        if (!works_.empty())
            post(); // a step may run an event loop of its own, which waits for the others
        if (work.owner && work.step() && work.owner)
            works_.push_back(work);
    }
    if (!works_.empty())
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
