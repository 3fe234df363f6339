#pragma once

#include "protocol/serial/SerialLink.h"
#include <array>
#include <deque>
#include <functional>
#include <vector>

namespace hermes {

/// Two links with a wire between them that takes its time, in a time of its own.
class LinkPair {
public:
    using Damage = std::function<void(QByteArray &frame)>;

    explicit LinkPair(double bytesPerSecond)
        : byte_s_(1 / bytesPerSecond) {
        for (SerialLink &link : ends)
            link.setBytesPerSecond(bytesPerSecond);
    }

    /// What happens to each frame on its way; an empty one is lost.
    Damage damage;
    std::array<SerialLink, 2> ends{SerialLink(1000), SerialLink(0xfffe)};
    std::array<std::vector<SerialLink::Arrival>, 2> arrived;
    double now = 1;

    /// A step of a millisecond: each end writes what the wire has room for, and gets what is through.
    void step() {
        now += 0.001;
        for (std::size_t i = 0; i < 2; ++i) {
            ends[i].setTime(now);
            while (freeAt_[i] < now + 0.005) {
                QByteArray frame = ends[i].next();
                if (frame.isEmpty())
                    break;
                freeAt_[i] = std::max(freeAt_[i], now) + frame.size() * byte_s_;
                if (damage)
                    damage(frame);
                wires_[i].push_back({freeAt_[i], frame});
            }
        }
        for (std::size_t i = 0; i < 2; ++i)
            for (; !wires_[i].empty() && wires_[i].front().at <= now; wires_[i].pop_front())
                for (auto &one : ends[1 - i].receive(wires_[i].front().bytes))
                    arrived[1 - i].push_back(one);
    }
    /// Until it holds, or for so many seconds of theirs.
    bool run(const std::function<bool()> &condition, double most_s) {
        for (const double end = now + most_s; now < end && !condition();)
            step();
        return condition();
    }

private:
    struct OnItsWay {
        double at;
        QByteArray bytes;
    };

    const double byte_s_;
    std::array<double, 2> freeAt_{};
    std::array<std::deque<OnItsWay>, 2> wires_;
};

} // namespace hermes
