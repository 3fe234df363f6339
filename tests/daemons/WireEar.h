#pragma once

#include <QtGlobal>

#include <deque>

/// Reads along what a motor control sends to its controllers, by the published packet format.
class WireEar {
public:
    /// A set-point as it came over the wire: command 40, or 34 with no duty.
    struct SetPoint {
        double time; ///< monotonic
        int address;
        quint32 acceleration;
        qint32 m1, m2;
        double rimSpeed; ///< of the fastest wheel at that time; m/s

        bool isZero() const { return m1 == 0 && m2 == 0; }
    };

    void hear(quint8 byte, double time, double rimSpeed) {
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
            heard_.push_back({time, packet_[0], quint32(number(2)), number(6), number(10), rimSpeed});
        if (packet_[1] == 34 && number(2) == 0) // no duty
            heard_.push_back({time, packet_[0], 0, 0, 0, rimSpeed});
        if (heard_.size() > 20000)
            heard_.pop_front();
        packet_.clear();
    }

    const std::deque<SetPoint> &heard() const { return heard_; }
    /// Packets that are none of those that the motor control may send.
    int strange() const { return strange_; }
    /// The first of the zeros that nothing else has followed; its time is infinite when there is none.
    SetPoint zeroOf(int address) const {
        SetPoint zero{std::numeric_limits<double>::infinity(), address, 0, 0, 0, 0};
        for (auto s = heard_.rbegin(); s != heard_.rend(); ++s) {
            if (s->address != address)
                continue;
            if (!s->isZero())
                break;
            zero = *s;
        }
        return zero;
    }
    /// One of the last set-points of this controller had these speeds.
    bool wasAsked(int address, double m1, double m2) const {
        int left = 8;
        for (auto s = heard_.rbegin(); s != heard_.rend() && left > 0; ++s) {
            if (s->address != address)
                continue;
            if (s->m1 == m1 && s->m2 == m2)
                return true;
            --left;
        }
        return false;
    }

private:
    // The length of a request by the published table, 0 where the motor control has no business.
    static int lengthOf(quint8 command) {
        switch (command) {
        case 14:
            return 5;
        case 28:
        case 29:
            return 20;
        case 34:
            return 8;
        case 40:
            return 16;
        case 15:
        case 21:
        case 24:
        case 25:
        case 48:
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
    qint32 number(std::size_t at) const {
        quint32 value = 0;
        for (std::size_t i = 0; i < 4; ++i)
            value = value << 8 | packet_[at + i];
        return qint32(value);
    }

    std::deque<quint8> packet_;
    std::deque<SetPoint> heard_;
    int strange_ = 0;
};
