#pragma once

#include <pthread.h>

namespace hermes {

/// A mutex for std::lock_guard whose holder runs with the priority of a real-time thread that waits for it:
/// on a busy machine an ordinary thread would keep that one waiting for tens of milliseconds.
class PriorityMutex {
public:
    PriorityMutex() {
        pthread_mutexattr_t attributes;
        ::pthread_mutexattr_init(&attributes);
        ::pthread_mutexattr_setprotocol(&attributes, PTHREAD_PRIO_INHERIT);
        ::pthread_mutex_init(&mutex_, &attributes);
        ::pthread_mutexattr_destroy(&attributes);
    }
    ~PriorityMutex() { ::pthread_mutex_destroy(&mutex_); }
    PriorityMutex(const PriorityMutex &) = delete;
    PriorityMutex &operator=(const PriorityMutex &) = delete;

    void lock() { ::pthread_mutex_lock(&mutex_); }
    void unlock() { ::pthread_mutex_unlock(&mutex_); }

private:
    pthread_mutex_t mutex_;
};

} // namespace hermes
