#pragma once

#include "daemons/simulator/RoboClawEmulator.h"

#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <deque>
#include <fcntl.h>
#include <mutex>
#include <poll.h>
#include <pthread.h>
#include <pty.h>
#include <stdexcept>
#include <string>
#include <thread>
#include <unistd.h>
#include <vector>

/// Emulated controllers behind a pseudo-terminal whose bytes take the time that they would take on a wire,
/// and what the wire saw of the cycles that drive them. In a thread of its own.
class SerialWire {
public:
    using Clock = std::chrono::steady_clock;

    /// One cycle: from the first byte of a set-point of the first controller to the last answer before the
    /// next one.
    struct Cycle {
        double begin_s;    ///< monotonic
        double busy_s;     ///< until the last answer was handed over
        double wire_bytes; ///< both ways
    };

    SerialWire(double baud, const std::vector<std::uint8_t> &addresses)
        : byte_s_(10 / baud) { // 8N1: ten bits a byte
        for (const std::uint8_t address : addresses) {
            hermes::simulator::RoboClawEmulator::Options options;
            options.address = address;
            emulators_.emplace_back(options);
        }
        first_ = addresses.front();
        char name[256];
        termios raw{};
        cfmakeraw(&raw);
        if (openpty(&far_, &near_, name, &raw, nullptr) != 0)
            throw std::runtime_error("no pseudo-terminal");
        fcntl(far_, F_SETFL, O_NONBLOCK);
        device_ = name;
        thread_ = std::thread([this] { run(); });
    }
    ~SerialWire() {
        ends_ = true;
        thread_.join();
        ::close(far_);
        ::close(near_);
    }

    const std::string &device() const { return device_; }

    /// The next cycle that has ended. Throws when none does for seconds.
    Cycle next() {
        std::unique_lock lock(mutex_);
        if (!ended_.wait_for(lock, std::chrono::seconds(10), [this] { return !cycles_.empty(); }))
            throw std::runtime_error("the controllers were not driven for 10 s");
        const Cycle cycle = cycles_.front();
        cycles_.pop_front();
        return cycle;
    }
    /// Forgets the cycles that have ended.
    void forget() {
        const std::lock_guard lock(mutex_);
        cycles_.clear();
    }

private:
    static constexpr std::uint8_t setPoint = 40;

    struct Answer {
        double due;
        hermes::roboclaw::Bytes bytes;
    };

    static double now() { return std::chrono::duration<double>(Clock::now().time_since_epoch()).count(); }

    void run() {
        sched_param realtime{};
        realtime.sched_priority = 30; // the wire keeps its time, if the system allows it
        ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &realtime);
        double before = now();
        while (!ends_) {
            const double wait = answers_.empty() ? 0.002 : std::max(0.0, answers_.front().due - now());
            const timespec limit{0, long(wait * 1e9)};
            pollfd line{far_, POLLIN, 0};
            ::ppoll(&line, 1, &limit, nullptr);
            receive();
            send();
            const double time = now();
            for (auto &emulator : emulators_)
                emulator.advance(time - before, 25);
            before = time;
        }
    }
    void receive() {
        std::uint8_t bytes[256];
        const auto size = ::read(far_, bytes, sizeof bytes);
        for (int i = 0; i < size; ++i) {
            hear_ = std::max(hear_, now()) + byte_s_; // the last bit of this byte
            overhear(bytes[i]);
            for (auto &emulator : emulators_) {
                for (const auto &answer : emulator.receive(bytes[i], hear_)) {
                    tell_ = std::max(tell_, hear_) + double(answer.bytes.size()) * byte_s_;
                    answers_.push_back({tell_, answer.bytes});
                }
            }
        }
    }
    /// Knows packets by the pause before them: the host sends one and awaits its answer.
    void overhear(std::uint8_t byte) {
        if (awaitsPacket_)
            address_ = byte;
        else if (awaitsCommand_ && byte == setPoint && address_ == first_)
            begin(hear_ - 2 * byte_s_);
        awaitsCommand_ = awaitsPacket_;
        awaitsPacket_ = false;
        ++current_.wire_bytes;
    }
    void begin(double time) {
        const std::lock_guard lock(mutex_);
        if (current_.begin_s > 0) {
            --current_.wire_bytes; // the address that begins the next cycle
            cycles_.push_back(current_);
            ended_.notify_one();
        }
        current_ = {time, 0, 1};
    }
    void send() {
        while (!answers_.empty() && answers_.front().due <= now()) {
            const hermes::roboclaw::Bytes &bytes = answers_.front().bytes;
            if (::write(far_, bytes.data(), bytes.size()) != ssize_t(bytes.size()))
                throw std::runtime_error("the pseudo-terminal takes no more");
            current_.wire_bytes += double(bytes.size());
            current_.busy_s = now() - current_.begin_s;
            awaitsPacket_ = true;
            answers_.pop_front();
        }
    }

    const double byte_s_;
    std::uint8_t first_ = 0;
    std::vector<hermes::simulator::RoboClawEmulator> emulators_;
    std::string device_;
    int far_ = -1, near_ = -1;   // near is held open: without any opener the far end could not be read
    double hear_ = 0, tell_ = 0; // when each direction is free again
    std::deque<Answer> answers_;
    bool awaitsPacket_ = true, awaitsCommand_ = false;
    std::uint8_t address_ = 0;
    Cycle current_{};
    std::mutex mutex_; // guards cycles_
    std::condition_variable ended_;
    std::deque<Cycle> cycles_;
    std::atomic<bool> ends_{false};
    std::thread thread_;
};
