#pragma once

#include "WireEar.h"
#include "common/PriorityMutex.h"
#include "daemons/simulator/RoboClawEmulator.h"
#include "daemons/simulator/RobotBody.h"

#include <QString>

#include <deque>
#include <mutex>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <pthread.h>
#include <pty.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <termios.h>

/// A robot for tests of the motor control: emulated controllers on a pseudo-terminal or behind a serial
/// server, in a thread of their own that runs in real time, and an ear on the wire. The bytes of a
/// pseudo-terminal pass through an ordinary kernel thread, which on a busy machine holds them up for tenths
/// of a second; those of the serial server do not.
class RoboClawRig {
public:
    using Emulator = hermes::simulator::RoboClawEmulator;

    static constexpr double standing = 0.005; ///< m/s below which rims and body stand
    static constexpr double countsPerTurn = 38000;

    using SetPoint = WireEar::SetPoint;

    /// link: where programs find the line; empty: a serial server, see url().
    RoboClawRig(const QString &link, const std::vector<Emulator::Options> &controllers)
        : link_(link.toStdString()) {
        for (const Emulator::Options &options : controllers)
            emulators_.emplace_back(options);
        link_.empty() ? listen() : plugIn();
        thread_ = std::thread([this] { run(); });
    }
    ~RoboClawRig() {
        ends_ = true;
        thread_.join();
        pull();
        if (server_ >= 0)
            ::close(server_);
    }

    /// The line for settings.
    QString url() const {
        return link_.empty() ? QString("tcp://127.0.0.1:%1").arg(port_)
                             : "serial://" + QString::fromStdString(link_);
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
    /// The fastest rim; m/s.
    double rimSpeed() {
        const std::lock_guard lock(mutex_);
        return rimSpeed_;
    }
    /// Where the body has come to; it began at zero.
    vectorlib::Pose2D pose() {
        const std::lock_guard lock(mutex_);
        return pose_;
    }
    /// When the body or a wheel moved last, and when a controller last meant one to turn.
    double lastMoved() const { return lastMoved_; }
    double lastDriven() const { return lastDriven_; }
    void setVoltage(double volts) { voltage_ = volts; }

    /// The set-point of zero that stopped the last controller; infinite in time when one of them was told to
    /// turn last.
    SetPoint zero() {
        const std::lock_guard lock(mutex_);
        SetPoint latest{};
        for (std::size_t i = 0; i < emulators_.size(); ++i) {
            const SetPoint zero = ear_.zeroOf(0x80 + int(i));
            if (zero.time > latest.time)
                latest = zero;
        }
        return latest;
    }
    double zeroSince() { return zero().time; }
    std::vector<SetPoint> heard() {
        const std::lock_guard lock(mutex_);
        return {ear_.heard().begin(), ear_.heard().end()};
    }
    /// Packets that are none of those that the motor control may send.
    int strange() {
        const std::lock_guard lock(mutex_);
        return ear_.strange();
    }

    /// What a noisy line did: see setFlips().
    struct Noise {
        quint64 bytes = 0, flipped = 0;
        int foreign = 0;         ///< executed commands after which a motor turned as nobody had asked
        double longestPause = 0; ///< between two set-points that one controller executed; seconds
    };
    /// From now on this share of the bytes has one bit flipped, both ways. Begins to count anew.
    void setFlips(double share) {
        const std::lock_guard lock(mutex_);
        flips_ = share;
        noise_ = {};
        executed_.fill(now());
    }
    Noise noise() {
        const std::lock_guard lock(mutex_);
        return noise_;
    }

private:
    void listen() {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof(address);
        auto *generic = reinterpret_cast<sockaddr *>(&address);
        server_ = ::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
        if (::bind(server_, generic, size) != 0 || ::listen(server_, 1) != 0 ||
            ::getsockname(server_, generic, &size) != 0)
            std::abort();
        port_ = ntohs(address.sin_port);
    }
    void acceptHost() {
        far_ = ::accept4(server_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
        const int on = 1;
        if (far_ >= 0)
            ::setsockopt(far_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
    }
    void answer(const hermes::roboclaw::Bytes &bytes) {
        // Lost when the host was killed or does not read, as on any line.
        [[maybe_unused]] const auto size = server_ >= 0
                                               ? ::send(far_, bytes.data(), bytes.size(), MSG_NOSIGNAL)
                                               : ::write(far_, bytes.data(), bytes.size());
    }
    quint8 noisy(quint8 byte) {
        ++noise_.bytes;
        if (std::uniform_real_distribution<double>()(random_) >= flips_)
            return byte;
        ++noise_.flipped;
        return quint8(byte ^ 1 << random_() % 8);
    }
    void receive() {
        quint8 bytes[256];
        const auto size = ::read(far_, bytes, sizeof(bytes));
        if (size == 0 && server_ >= 0) { // the host has hung up
            ::close(far_);
            far_ = -1;
        }
        for (int i = 0; i < size; ++i) {
            ear_.hear(bytes[i], now(), rimSpeed_);
            const quint8 byte = noisy(bytes[i]);
            for (std::size_t e = 0; e < emulators_.size(); ++e)
                hand(e, byte, now());
        }
    }
    void hand(std::size_t number, quint8 byte, double time) {
        Emulator &emulator = emulators_[number];
        const auto before = emulator.counts().requests;
        const auto answers = emulator.receive(byte, time);
        if (emulator.counts().requests != before)
            judge(number, !answers.empty() && answers.back().bytes.size() == 1, time);
        for (const Emulator::Answer &answer : answers) {
            hermes::roboclaw::Bytes bytes;
            for (std::size_t i = 0; i < answer.bytes.size(); ++i)
                bytes.push(noisy(answer.bytes[i]));
            late_.push_back({time + answer.delay, bytes});
        }
    }
    // After a command that was executed the motors are told what the host has sent, or stopped by themselves.
    void judge(std::size_t number, bool acknowledged, double time) {
        const double m1 = emulators_[number].channel(0).target(), m2 = emulators_[number].channel(1).target();
        noise_.foreign += (m1 != 0 || m2 != 0) && !ear_.wasAsked(0x80 + int(number), m1, m2);
        if (!acknowledged)
            return;
        noise_.longestPause = std::max(noise_.longestPause, time - executed_[number % 2]);
        executed_[number % 2] = time;
    }
    // The body goes where its wheels drive it.
    void moveBody(double seconds, double time) {
        std::array<double, 4> wheels{};
        rimSpeed_ = 0;
        for (std::size_t i = 0; i < std::min<std::size_t>(4, 2 * emulators_.size()); ++i) {
            const double speed = emulators_[i / 2].channel(int(i % 2)).speed();
            wheels[i] = speed / countsPerTurn * 2 * std::acos(-1.0);
            rimSpeed_ = std::max(rimSpeed_, std::abs(wheels[i]) * base_.radius);
        }
        const auto before = pose_;
        pose_ = body_.move(pose_, base_.twistOf(wheels), seconds);
        const double way = std::hypot(pose_.x - before.x, pose_.y - before.y);
        if (rimSpeed_ > standing || way > standing * seconds)
            lastMoved_ = time;
    }
    // The thread may have waited: motions end when they end, not when it goes on.
    void advance(double seconds, double time) {
        for (Emulator &emulator : emulators_) {
            emulator.advance(seconds, voltage_);
            if (emulator.channel(0).isDriven() || emulator.channel(1).isDriven())
                lastDriven_ = time;
        }
        moveBody(seconds, time);
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
                line.fd = far_ >= 0 ? far_ : server_;
            }
            ::poll(&line, 1, 1);
            const std::lock_guard lock(mutex_);
            const double time = now();
            for (double at = before; at < time; at += step)
                advance(std::min(step, time - at), std::min(at + step, time));
            if (far_ < 0 && server_ >= 0)
                acceptHost();
            if (far_ >= 0) {
                ::ioctl(near_, TIOCNXCL); // the claim of a program that was killed
                receive();
            }
            while (!late_.empty() && late_.front().due <= now()) {
                if (far_ >= 0)
                    answer(late_.front().bytes);
                late_.pop_front();
            }
            before = time;
        }
    }

    static constexpr double step = 0.001; // seconds

    struct Late {
        double due;
        hermes::roboclaw::Bytes bytes;
    };

    const std::string link_;
    std::vector<Emulator> emulators_;
    hermes::PriorityMutex mutex_;
    int server_ = -1, port_ = 0;
    int far_ = -1, near_ = -1; // near is held open, so that the far end can be read before a program comes
    std::atomic<double> voltage_{25};
    std::atomic<double> lastMoved_{0}, lastDriven_{0};
    const hermes::simulator::WheelBase base_;
    hermes::simulator::RobotBody body_; // no walls
    vectorlib::Pose2D pose_;
    double rimSpeed_ = 0; // m/s
    WireEar ear_;
    double flips_ = 0;
    std::mt19937 random_{7};
    Noise noise_;
    std::array<double, 2> executed_{}; // the last set-point of each controller
    std::deque<Late> late_;
    std::atomic<bool> ends_{false};
    std::thread thread_;
};
