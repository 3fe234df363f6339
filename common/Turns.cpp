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
    works.push_back({owner, step});
    post();
}

void Turns::post() {
    if (std::exchange(posted, true))
        return;
    QMetaObject::invokeMethod(this, &Turns::run, Qt::QueuedConnection);
}

void Turns::run() {
    posted = false;
    const double end = monotonicNow() + longest_s;
    while (!works.empty() && monotonicNow() < end) {
        const Work work = std::move(works.front());
        works.pop_front();
        if (!works.empty())
            post(); // a step may run an event loop of its own, which waits for the others
        if (work.owner && work.step() && work.owner)
            works.push_back(work);
    }
    if (!works.empty())
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
