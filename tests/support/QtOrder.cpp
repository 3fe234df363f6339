/// Part of every program of a build with the thread sanitizer. Qt is not built with it, so the order in which
/// Qt hands something from one thread to another is unknown to it, and what is handed over would be reported
/// as a race. These functions stand in the way to Qt's own of the same name, call them, and tell that order.
/// They tell no more than what Qt's documentation promises: what happened before a call was queued is seen by
/// what is called.

#include <QCoreApplication>
#include <QObject>
#include <QThread>
#include <QThreadPool>

#include <dlfcn.h>
#include <functional>
#include <utility>

extern "C" void __tsan_acquire(void *address);
extern "C" void __tsan_release(void *address);

namespace {

/// Qt's own function of a mangled name.
template <typename Function>
Function original(const char *name) {
    return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

/// A queued call: what its sender did before is seen by it, and what it did by a sender that waits for it.
class OrderedCall final : public QtPrivate::QSlotObjectBase {
public:
    explicit OrderedCall(QSlotObjectBase *inner)
        : QSlotObjectBase(&run)
        , inner_(inner) {
        __tsan_release(this);
    }

private:
    static void run(int operation, QSlotObjectBase *base, QObject *receiver, void **arguments, bool *same) {
        auto *self = static_cast<OrderedCall *>(base);
        __tsan_acquire(self);
        switch (operation) {
        case Destroy:
            self->inner_->destroyIfLastRef();
            delete self;
            break;
        case Call:
            self->inner_->call(receiver, arguments);
            __tsan_release(self);
            break;
        case Compare:
            *same = self->inner_->compare(arguments);
            break;
        }
    }

    QSlotObjectBase *inner_;
};

/// A job of a pool: it sees what was done before it was started; who waits for the pool sees what it did.
class OrderedJob final : public QRunnable {
public:
    OrderedJob(QRunnable *inner, QThreadPool *pool)
        : inner_(inner)
        , pool_(pool) {
        __tsan_release(this);
    }
    void run() override {
        __tsan_acquire(this);
        const bool owned = inner_->autoDelete();
        inner_->run();
        if (owned)
            delete inner_;
        __tsan_release(pool_);
    }

private:
    QRunnable *inner_;
    QThreadPool *pool_;
};

} // namespace

bool QMetaObject::invokeMethodImpl(QObject *object, QtPrivate::QSlotObjectBase *slot, Qt::ConnectionType type,
                                   void *ret) {
    static const auto queue = original<bool (*)(QObject *, QtPrivate::QSlotObjectBase *, Qt::ConnectionType,
                                                void *)>(
        "_ZN11QMetaObject16invokeMethodImplEP7QObjectPN9QtPrivate15QSlotObjectBaseEN2Qt14ConnectionTypeEPv");
    auto *call = new OrderedCall(slot);
    call->ref();
    const bool ok = queue(object, call, type, ret);
    if (type == Qt::BlockingQueuedConnection)
        __tsan_acquire(call);
    __tsan_release(call);
    call->destroyIfLastRef();
    return ok;
}

void QThreadPool::start(QRunnable *runnable, int priority) {
    static const auto start =
        original<void (*)(QThreadPool *, QRunnable *, int)>("_ZN11QThreadPool5startEP9QRunnablei");
    start(this, new OrderedJob(runnable, this), priority);
}

void QThreadPool::start(std::function<void()> work, int priority) {
    start(QRunnable::create(std::move(work)), priority);
}

bool QThreadPool::waitForDone(int msecs) {
    static const auto wait = original<bool (*)(QThreadPool *, int)>("_ZN11QThreadPool11waitForDoneEi");
    const bool done = wait(this, msecs);
    if (done)
        __tsan_acquire(this);
    return done;
}

// What a thread did, its last deletions too, is seen by who waits for its end.
void QThread::start(Priority priority) {
    static const auto start = original<void (*)(QThread *, Priority)>("_ZN7QThread5startENS_8PriorityE");
    connect(this, &QThread::finished, [this] {
        QCoreApplication::sendPostedEvents(nullptr, QEvent::DeferredDelete);
        __tsan_release(this);
    });
    start(this, priority);
}

bool QThread::wait(QDeadlineTimer deadline) {
    static const auto wait =
        original<bool (*)(QThread *, QDeadlineTimer)>("_ZN7QThread4waitE14QDeadlineTimer");
    const bool ended = wait(this, deadline);
    if (ended)
        __tsan_acquire(this);
    return ended;
}
