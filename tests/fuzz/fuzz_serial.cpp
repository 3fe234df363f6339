#include "protocol/serial/Cobs.h"
#include "protocol/serial/Crc32c.h"
#include "protocol/serial/SerialLink.h"
#include "tests/fuzz/FuzzInput.h"

#include <QtEndian>

#include <random>
#include <set>

using namespace hermes;

namespace {

constexpr int limit = 4096;

/// Two ends, and a wire that damages, loses, repeats and exchanges what is on it. Where it does so is of the
/// input, to what it damages is not: else an input could be found that forges a CRC.
class HostileWire {
public:
    explicit HostileWire(FuzzInput &input)
        : in_(input)
        , random_(in_.take<std::uint32_t>()) {
        for (SerialLink &link : ends_)
            link.setLimit(limit);
    }

    void run() {
        while (in_.left() > 0)
            act(in_.take<std::uint8_t>());
        calmDown();
    }

private:
    void act(int what) {
        const std::size_t side = what & 1;
        switch (what / 2 % 8) {
        case 0:
        case 1:
            return send(side);
        case 2:
        case 3:
        case 4:
            return write(side, in_.take<std::uint8_t>() % 32, true);
        case 5:
            return deliver(side, in_.take<std::uint8_t>());
        case 6: // nothing is on its way for longer than its sender remembers it
            deliver(0, 1 << 30);
            deliver(1, 1 << 30);
            return advance(in_.take<std::uint8_t>() * 0.02);
        default:
            if (in_.take<std::uint8_t>() % 8 == 0)
                beginAnew(side);
        }
    }

    void send(std::size_t side) {
        const int size = in_.take<std::uint16_t>() % 1200;
        const auto rank = SerialLink::Rank(in_.take<std::uint8_t>() % 4);
        QByteArray message(1, char(0x80 + count_ % 64));
        message += QByteArray::number(++count_) + ' ';
        while (message.size() < size)
            message += char(random_() % 3 * 127);
        FUZZ_REQUIRE(ends_[side].send(message, rank) > 0);
        sent_[side].insert(message);
        mustArrive_[side] += message.size() > SerialLink::largestFrame || rank >= SerialLink::Rank::Topic;
    }

    void write(std::size_t side, int frames, bool isHostile) {
        for (; frames > 0; --frames) {
            QByteArray frame = ends_[side].next();
            if (frame.isEmpty())
                return;
            const int harm = isHostile ? in_.take<std::uint8_t>() % 16 : 255;
            const bool isPiece = !frame.startsWith('\0');
            const int at = int(random_() % unsigned(frame.size()));
            if (harm == 1)
                frame[at] = char(frame[at] ^ (1 + random_() % 255));
            else if (harm == 2)
                frame.remove(at, int(random_() % unsigned(frame.size())));
            else if (harm == 3)
                frame.insert(at, char(random_() % 4));
            else if (harm == 4)
                continue;
            else if (harm == 5 && isPiece) // a whole message may come twice: its reader knows by its id
                wires_[side].push_back(frame);
            wires_[side].push_back(frame);
            if (harm == 6 && wires_[side].size() > 1)
                std::swap(wires_[side].back(), wires_[side][wires_[side].size() - 2]);
        }
    }

    void deliver(std::size_t side, int frames) {
        for (; frames > 0 && !wires_[side].empty(); --frames) {
            for (const auto &one : ends_[1 - side].receive(wires_[side].front()))
                take(side, one);
            wires_[side].pop_front();
        }
    }

    void take(std::size_t side, const SerialLink::Arrival &one) {
        FUZZ_REQUIRE(!one.tooLarge);
        FUZZ_REQUIRE(sent_[side].count(one.message) == 1);
        FUZZ_REQUIRE(arrived_[side].insert(one.message).second);
        piecesArrived_[side] += one.inPieces;
    }

    void advance(double seconds) {
        now_ += seconds;
        for (SerialLink &link : ends_)
            link.setTime(now_);
    }

    // Another program: what came to this one may come to that one, too.
    void beginAnew(std::size_t side) {
        ends_[side].reset();
        arrived_[1 - side].clear();
        hasBegunAnew_ = true;
    }

    // Undamaged from now on: all goes its way, or was counted as given up.
    void calmDown() {
        for (int i = 0; i < 4000; ++i) {
            for (std::size_t side = 0; side < 2; ++side) {
                write(side, 4, false);
                deliver(side, 1 << 30);
            }
            advance(0.05);
            const bool isIdle = !ends_[0].hasNext() && !ends_[1].hasNext();
            if (isIdle && ends_[0].bytesWaiting() + ends_[1].bytesWaiting() == 0)
                break;
        }
        for (std::size_t side = 0; side < 2; ++side) {
            FUZZ_REQUIRE(ends_[side].bytesWaiting() == 0);
            FUZZ_REQUIRE(!ends_[side].hasNext());
            const quint64 given = ends_[side].counters().abandoned + ends_[1 - side].counters().abandoned;
            FUZZ_REQUIRE(hasBegunAnew_ || piecesArrived_[side] + given >= mustArrive_[side]);
        }
    }

    FuzzInput &in_;
    std::minstd_rand random_;
    std::array<SerialLink, 2> ends_{SerialLink(7), SerialLink(0xfffd)};
    std::array<std::deque<QByteArray>, 2> wires_;
    std::array<std::set<QByteArray>, 2> sent_, arrived_;
    std::array<quint64, 2> mustArrive_{}, piecesArrived_{};
    bool hasBegunAnew_ = false;
    int count_ = 0;
    double now_ = 1;
};

/// Frames with any content, to an end that has something on its way itself.
void feedForgedFrames(FuzzInput &in) {
    SerialLink link(7);
    link.setLimit(limit);
    for (int i = 0; i < 4; ++i)
        link.send(QByteArray(100 + 900 * i, char(0x80)), SerialLink::Rank(i));
    double now = 1;
    while (in.left() > 0) {
        const auto what = in.take<std::uint8_t>();
        QByteArray content = QByteArray::fromStdString(in.bytes(in.take<std::uint8_t>()));
        if (what & 1) {
            char crc[4];
            qToLittleEndian(crc32c(content.constData(), std::size_t(content.size())), crc);
            content = cobsEncoded(content.append(crc, 4)) + '\0';
        }
        link.receive(content);
        FUZZ_REQUIRE(link.bytesHeld() <= 5 * limit);
        FUZZ_REQUIRE(link.bytesWaiting() >= 0);
        for (int i = what >> 4; i > 0; --i)
            link.next();
        if (what & 2)
            link.setTime(now += 0.1);
    }
    for (int i = 0; i < 100000 && !link.next().isEmpty(); ++i)
        FUZZ_REQUIRE(i < 99999);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    FuzzInput in(data, size);
    if (in.take<std::uint8_t>() % 4 == 0)
        feedForgedFrames(in);
    else
        HostileWire(in).run();
    return 0;
}
