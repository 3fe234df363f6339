#pragma once

#include <pthread.h>

/// Notices when a processor stands still for everybody, as those of a virtual machine do at times: a
/// real-time thread on each wakes every few milliseconds. What is measured meanwhile tells nothing of the
/// program under test.
class MachineStalls {
public:
    MachineStalls() {
        const auto processors = unsigned(std::max(1L, ::sysconf(_SC_NPROCESSORS_ONLN)));
        for (unsigned i = 0; i < processors; ++i)
            threads_.emplace_back([this, i] { watch(i); });
    }
    ~MachineStalls() {
        ends_ = true;
        for (std::thread &thread : threads_)
            thread.join();
    }

    /// Seconds of the longest stall since this was called last.
    double takeLongest() { return longest_.exchange(0); }

private:
    void watch(unsigned processor) {
        cpu_set_t only;
        CPU_ZERO(&only);
        CPU_SET(processor, &only);
        ::pthread_setaffinity_np(::pthread_self(), sizeof(only), &only);
        sched_param realtime{};
        realtime.sched_priority = 40;
        ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &realtime);
        constexpr std::chrono::milliseconds nap{4};
        for (auto due = std::chrono::steady_clock::now() + nap; !ends_; due += nap) {
            std::this_thread::sleep_until(due);
            const auto now = std::chrono::steady_clock::now();
            const double late = std::chrono::duration<double>(now - due).count();
            double longest = longest_;
            while (late > longest && !longest_.compare_exchange_weak(longest, late)) {
            }
            due = std::max(due, now);
        }
    }

    std::atomic<double> longest_{0};
    std::atomic<bool> ends_{false};
    std::vector<std::thread> threads_;
};
