#pragma once

#include "tests/daemons/FarNetwork.h"

#include <deque>
#include <linux/if_tun.h>
#include <net/if.h>
#include <poll.h>
#include <sched.h>
#include <sys/ioctl.h>

/// A second way to the far computer, which holds up packets and loses some, as netem would, which not every
/// kernel has: a TUN device at either end and a thread that carries the packets between them.
class SlowLink {
public:
    static constexpr const char *nearHost = "192.168.78.1";
    static constexpr const char *farHost = "192.168.78.2";

    ~SlowLink() {
        ends_ = true;
        if (thread_.joinable())
            thread_.join();
        for (const End *end : {&near_, &far_})
            if (end->device >= 0)
                ::close(end->device);
    }

    /// Empty, or why there is none.
    QString make(const FarNetwork &network) {
        near_.device = openTun("slow");
        const int space =
            ::open(("/proc/" + network.enter()[2] + "/ns/net").toLatin1(), O_RDONLY | O_CLOEXEC);
        std::thread opener([this, space] { // only this thread goes there
            if (::setns(space, CLONE_NEWNET) == 0)
                far_.device = openTun("slow");
        });
        opener.join();
        ::close(space);
        if (near_.device < 0 || far_.device < 0)
            return "no TUN device (needs root rights and /dev/net/tun)";
        for (const QString &enter : {QString(), network.enter().join(' ') + ' '}) {
            const bool isNear = enter.isEmpty();
            for (const QString &command : {QString("ip addr add %1 peer %2 dev slow")
                                               .arg(isNear ? nearHost : farHost, isNear ? farHost : nearHost),
                                           QString("ip link set slow up")})
                if (const QString wrong = run(enter + command); !wrong.isEmpty())
                    return wrong;
        }
        thread_ = std::thread([this] { carry(); });
        return {};
    }
    /// From now on: seconds that packets take to the far computer and back from it, and the share that is
    /// lost either way.
    void set(double there_s, double back_s, double loss) {
        near_.delay_s = there_s;
        far_.delay_s = back_s;
        loss_ = loss;
    }
    int lost() const { return lost_; }
    int carried() const { return carried_; }

private:
    using Clock = std::chrono::steady_clock;
    struct Packet {
        Clock::time_point due;
        std::vector<char> bytes;
    };
    /// What comes in at this end is due at the other one later.
    struct End {
        int device = -1;
        std::atomic<double> delay_s{0};
        std::deque<Packet> onTheirWay;
    };

    static int openTun(const char *name) {
        const int device = ::open("/dev/net/tun", O_RDWR | O_NONBLOCK | O_CLOEXEC);
        ifreq request{};
        request.ifr_flags = IFF_TUN | IFF_NO_PI;
        qstrncpy(request.ifr_name, name, IFNAMSIZ);
        return device >= 0 && ::ioctl(device, TUNSETIFF, &request) == 0 ? device : -1;
    }
    static QString run(const QString &command) {
        QStringList words = command.split(' ');
        QProcess process;
        process.start(words.takeFirst(), words);
        if (process.waitForFinished() && process.exitCode() == 0)
            return {};
        return command + ": " + process.errorString() + ' ' + process.readAllStandardError();
    }
    void carry() {
        std::mt19937 random(1);
        while (!ends_) {
            pollfd devices[2] = {{near_.device, POLLIN, 0}, {far_.device, POLLIN, 0}};
            ::poll(devices, 2, 1);
            take(near_, random);
            take(far_, random);
            give(near_, far_.device);
            give(far_, near_.device);
        }
    }
    void take(End &end, std::mt19937 &random) {
        char bytes[2048];
        for (ssize_t size; (size = ::read(end.device, bytes, sizeof(bytes))) > 0;) {
            ++carried_;
            if (std::uniform_real_distribution<>()(random) < loss_) {
                ++lost_;
                continue;
            }
            const auto delay =
                std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(end.delay_s));
            end.onTheirWay.push_back({Clock::now() + delay, {bytes, bytes + size}});
        }
    }
    static void give(End &from, int device) {
        for (; !from.onTheirWay.empty() && from.onTheirWay.front().due <= Clock::now();
             from.onTheirWay.pop_front()) {
            const std::vector<char> &bytes = from.onTheirWay.front().bytes;
            if (::write(device, bytes.data(), bytes.size()) < 0)
                continue; // lost, as on any wire
        }
    }

    End near_, far_;
    std::atomic<double> loss_{0};
    std::atomic<int> lost_{0}, carried_{0};
    std::atomic<bool> ends_{false};
    std::thread thread_;
};
