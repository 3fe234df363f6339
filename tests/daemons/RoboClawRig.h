#pragma once

#include "daemons/simulator/RoboClawEmulator.h"

#include <QString>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <deque>
#include <fcntl.h>
#include <limits>
#include <mutex>
#include <poll.h>
#include <pthread.h>
#include <pty.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <thread>
#include <unistd.h>
#include <vector>

/// A robot for tests of the motor control: emulated controllers on a pseudo-terminal, in a thread of their
/// own that runs in real time, and an ear on the wire.
class RoboClawRig {
public:
    using Emulator = hermes::RoboClawEmulator;

    /// Counts/s below which a wheel stands: 5 mm/s.
    static constexpr double standing = 300;

    /// A set-point (command 40) as it came over the wire.
    struct SetPoint {
        double time; ///< monotonic
        int address;
        quint32 acceleration;
        qint32 m1, m2;

        bool isZero() const { return m1 == 0 && m2 == 0; }
    };

    /// link: where programs find the line.
    RoboClawRig(const QString &link, const std::vector<Emulator::Options> &controllers)
        : link_(link.toStdString()) {
        for (const Emulator::Options &options : controllers)
            emulators_.emplace_back(options);
        plugIn();
        thread_ = std::thread([this] { run(); });
    }
    ~RoboClawRig() {
        ends_ = true;
        thread_.join();
        pull();
    }

    static double now() {
        return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
    }

    /// Puts the line's plug in, or takes it out: programs see a device that is gone.
    void plugIn() {
        const std::lock_guard lock(mutex_);
        termios raw{};
        cfmakeraw(&raw);
        char name[256];
        if (openpty(&far_, &near_, name, &raw, nullptr) != 0)
            std::abort();
        fcntl(far_, F_SETFL, O_NONBLOCK);
        fcntl(far_, F_SETFD, FD_CLOEXEC);
        fcntl(near_, F_SETFD, FD_CLOEXEC);
        ::unlink(link_.c_str());
        if (::symlink(name, link_.c_str()) != 0)
            std::abort();
    }
    void pull() {
        const std::lock_guard lock(mutex_);
        ::unlink(link_.c_str());
        for (int *end : {&far_, &near_}) {
            if (*end >= 0)
                ::close(*end);
            *end = -1;
        }
    }

    /// Works on the emulators while their time stands.
    template <typename Function>
    auto with(Function function) {
        const std::lock_guard lock(mutex_);
        return function(emulators_);
    }
    /// Counts/s of the four motors in the order of the controllers.
    std::vector<double> speeds() {
        return with([](std::vector<Emulator> &all) {
            std::vector<double> result;
            for (const Emulator &e : all)
                for (int motor : {0, 1})
                    result.push_back(e.channel(motor).speed());
            return result;
        });
    }
    double fastest() {
        double most = 0;
        for (double speed : speeds())
            most = std::max(most, std::abs(speed));
        return most;
    }
    /// When a wheel turned last, and when a controller last meant one to turn.
    double lastMoved() const { return lastMoved_; }
    double lastDriven() const { return lastDriven_; }
    void setVoltage(double volts) { voltage_ = volts; }

    /// When the last controller got a set-point of zero that was followed by nothing else since; infinite
    /// when one of them was told to turn last.
    double zeroSince() {
        const std::lock_guard lock(mutex_);
        double latest = 0;
        for (std::size_t i = 0; i < emulators_.size(); ++i) {
            double since = std::numeric_limits<double>::infinity();
            for (auto s = heard_.rbegin(); s != heard_.rend(); ++s) {
                if (s->address != 0x80 + int(i))
                    continue;
                if (!s->isZero())
                    break;
                since = s->time;
            }
            latest = std::max(latest, since);
        }
        return latest;
    }
    std::vector<SetPoint> heard() {
        const std::lock_guard lock(mutex_);
        return {heard_.begin(), heard_.end()};
    }
    /// Packets that are none of those that the motor control may send.
    int strange() const { return strange_; }

private:
    // The length of a request by the published table, 0 where the motor control has no business.
    static int lengthOf(quint8 command) {
        switch (command) {
        case 14:
            return 5;
        case 28:
        case 29:
            return 20;
        case 40:
            return 16;
        case 15:
        case 21:
        case 24:
        case 25:
        case 49:
        case 55:
        case 56:
        case 78:
        case 82:
        case 90:
            return 2;
        }
        return 0;
    }
    static qint32 number(const std::deque<quint8> &bytes, std::size_t at) {
        quint32 value = 0;
        for (std::size_t i = 0; i < 4; ++i)
            value = value << 8 | bytes[at + i];
        return qint32(value);
    }
    void overhear(quint8 byte, double time) {
        packet_.push_back(byte);
        if (packet_.size() < 2)
            return;
        const int length = lengthOf(packet_[1]);
        strange_ += length == 0;
        if (length == 0)
            return packet_.clear();
        if (int(packet_.size()) < length)
            return;
        if (packet_[1] == 40)
            heard_.push_back(
                {time, packet_[0], quint32(number(packet_, 2)), number(packet_, 6), number(packet_, 10)});
        if (heard_.size() > 20000)
            heard_.pop_front();
        packet_.clear();
    }
    void receive() {
        quint8 bytes[256];
        const auto size = ::read(far_, bytes, sizeof(bytes));
        for (int i = 0; i < size; ++i) {
            overhear(bytes[i], now());
            for (Emulator &emulator : emulators_) {
                if (const auto answer = emulator.receive(bytes[i], now()))
                    late_.push_back({now() + answer->delay, answer->bytes});
            }
        }
    }
    void run() {
        // A controller keeps its time however busy the machine is; without the privilege it is an ordinary
        // thread.
        sched_param realtime{};
        realtime.sched_priority = 30;
        ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &realtime);
        double before = now();
        while (!ends_) {
            pollfd line{-1, POLLIN, 0};
            {
                const std::lock_guard lock(mutex_);
                line.fd = far_;
            }
            ::poll(&line, 1, 1);
            const std::lock_guard lock(mutex_);
            if (far_ >= 0) {
                ::ioctl(near_, TIOCNXCL); // the claim of a program that was killed
                receive();
            }
            const double time = now();
            while (!late_.empty() && late_.front().due <= time) {
                if (far_ >= 0 && ::write(far_, late_.front().bytes.data(), late_.front().bytes.size()) < 0)
                    ++strange_;
                late_.pop_front();
            }
            for (Emulator &emulator : emulators_) {
                emulator.advance(time - before, voltage_);
                for (int motor : {0, 1}) {
                    if (std::abs(emulator.channel(motor).speed()) > standing)
                        lastMoved_ = time;
                    if (emulator.channel(motor).isDriven())
                        lastDriven_ = time;
                }
            }
            before = time;
        }
    }

    struct Late {
        double due;
        hermes::roboclaw::Bytes bytes;
    };

    const std::string link_;
    std::vector<Emulator> emulators_;
    std::mutex mutex_;
    int far_ = -1, near_ = -1; // near is held open, so that the far end can be read before a program comes
    std::atomic<double> voltage_{25};
    std::atomic<double> lastMoved_{0}, lastDriven_{0};
    std::deque<quint8> packet_;
    std::deque<SetPoint> heard_;
    std::deque<Late> late_;
    std::atomic<int> strange_{0};
    std::atomic<bool> ends_{false};
    std::thread thread_;
};
