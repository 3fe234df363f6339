// The link of the framing serial: what arrives is what was sent, whatever befalls it; what is urgent comes
// first; memory stays bounded whatever comes.
#include "protocol/serial/Cobs.h"
#include "protocol/serial/Crc32c.h"
#include "tests/support/LinkPair.h"

using namespace hermes;

using Rank = SerialLink::Rank;

/// A message, by its number, of so many bytes.
static QByteArray message(int number, int size) {
    QByteArray bytes(1, char(0xbf));
    bytes += QByteArray::number(number) + ' ';
    while (bytes.size() < size)
        bytes += char(bytes.size() * 7 + number);
    return bytes;
}

static QByteArray framed(QByteArray content) {
    QByteArray crc(4, 0);
    qToLittleEndian(crc32c(content.constData(), size_t(content.size())), crc.data());
    return cobsEncoded(content + crc) + '\0';
}

static QByteArray piece(quint16 number, int index, const QByteArray &content, bool toReport = false) {
    return framed(Piece{toReport, number, quint16(index), quint32(content.size()),
                        content.mid(index * pieceBytes, pieceBytes)}
                      .toFrame());
}

static QByteArray sealed(const QByteArray &item) {
    QByteArray crc(4, 0);
    qToLittleEndian(crc32c(item.constData(), size_t(item.size())), crc.data());
    return item + crc;
}

static std::vector<QByteArray> messagesOf(const std::vector<SerialLink::Arrival> &arrivals) {
    std::vector<QByteArray> all;
    for (const auto &one : arrivals)
        all.push_back(one.message);
    return all;
}

class TestSerialLink : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void aSmallMessageIsOneFrame() {
        SerialLink link(1), peer(1);
        QVERIFY(link.send(message(1, 40), Rank::Usual));
        QVERIFY(link.hasNext());
        const QByteArray frame = link.next();
        QCOMPARE(frame, '\0' + framed(message(1, 40)));
        QVERIFY(link.next().isEmpty() && !link.hasNext());
        QCOMPARE(link.bytesWaiting(), 0);
        std::vector<SerialLink::Arrival> got;
        for (const char byte : frame) // split anywhere
            for (const auto &one : peer.receive(QByteArray(1, byte)))
                got.push_back(one);
        QCOMPARE(messagesOf(got), std::vector<QByteArray>{message(1, 40)});
        QVERIFY(!peer.isMidFrame());
        QVERIFY(!peer.hasNext()); // nothing is to be said
        // As docs/protocol.md shows it.
        const QByteArray item =
            QByteArray::fromHex("a3676a736f6e72706363322e3062696401666d6574686f646b6461656d6f6e2e696e666f");
        link.send(item, Rank::Usual);
        QCOMPARE(link.next().toHex(), "0029" + item.toHex() + "4c5bf6ef00");
    }

    void garbageBetweenTwoFrames() {
        SerialLink link(1);
        const QByteArray a = framed(message(1, 40)), b = framed(message(2, 40));
        QByteArray damaged = framed(message(3, 40));
        damaged[10] = char(damaged[10] ^ 1);
        QByteArray garbage = QByteArray("what is this") + '\0', unknown = framed("\x20what?"),
                   tiny = framed({});
        const auto got = link.receive(a + garbage + QByteArray(5, '\0') + damaged + unknown + tiny + b);
        QCOMPARE(messagesOf(got), (std::vector<QByteArray>{message(1, 40), message(2, 40)}));
        QCOMPARE(link.counters().damaged, 4u);
        QCOMPARE(messagesOf(link.receive("garbage" + a)).size(), size_t(0)); // one damaged frame
        QCOMPARE(messagesOf(link.receive("garbage" + ('\0' + a))).size(), size_t(1));
    }

    void aMessageOverTheLimitIsTold() {
        SerialLink link(1), peer(1);
        link.setLimit(1000);
        QCOMPARE(messagesOf(link.receive(framed(message(1, 1000)))).size(), size_t(1));
        const auto got = link.receive(framed(message(1, 5000)) + framed(message(2, 50)));
        QCOMPARE(got.size(), size_t(2));
        QVERIFY(got[0].tooLarge);
        QCOMPARE(got[1].message, message(2, 50));
        QCOMPARE(link.receive(QByteArray(100000, 'x')).size(), size_t(1));
        QVERIFY(link.bytesHeld() <= 2000);
        link.receive(QByteArray(1, '\0'));
        QCOMPARE(link.counters().oversized, 2u);
        // In pieces: told once, and the sender that it is not wanted.
        peer.send(message(3, 2000), Rank::Usual);
        int told = 0;
        for (QByteArray frame = peer.next(); !frame.isEmpty(); frame = peer.next())
            for (const auto &one : link.receive(frame))
                told += one.tooLarge;
        QCOMPARE(told, 1);
        QCOMPARE(link.bytesHeld(), 0);
        peer.receive(link.next());
        peer.setTime(1);
        QVERIFY(!peer.hasNext());
        QCOMPARE(peer.bytesWaiting(), 0);
        QCOMPARE(SerialLink(1).send(QByteArray(7 << 20, char(0xbf)), Rank::Usual), 0u);
    }

    void urgentGoesFirst() {
        LinkPair pair(11520);
        pair.ends[0].send(message(1, 100000), Rank::Usual);
        pair.ends[0].send(message(2, 8000), Rank::Topic);
        QVERIFY(!pair.run([] { return false; }, 1));
        for (int i = 0; i < 5; ++i)
            pair.ends[0].send(message(10 + i, 100), Rank::Usual);
        pair.ends[0].send(message(3, 50), Rank::Urgent);
        QVERIFY(pair.run([&] { return !pair.arrived[1].empty(); }, 0.05));
        QCOMPARE(pair.arrived[1][0].message, message(3, 50));
        QVERIFY(pair.run([&] { return pair.arrived[1].size() >= 6; }, 0.2));
        QCOMPARE(pair.arrived[1][5].message, message(14, 100));
        QVERIFY(pair.run([&] { return pair.arrived[1].size() >= 7; }, 2)); // in turns with the large one
        QCOMPARE(pair.arrived[1][6].message, message(2, 8000));
    }

    void allArriveOnce_data() {
        const Rows<int> row("oneIn");
        row("undamaged", 0);
        row("one byte in 1000", 1000);
        row("one byte in 200", 200);
        row("one byte in 150", 150);
    }

    void allArriveOnce() {
        QFETCH(int, oneIn);
        std::mt19937 random(newSeed());
        LinkPair pair(11520);
        pair.damage = [&](QByteArray &frame) {
            if (oneIn == 0)
                return;
            for (char &byte : frame)
                if (random() % unsigned(oneIn) == 0)
                    byte = char(random());
            if (random() % unsigned(oneIn) == 0)
                frame.chop(int(random() % unsigned(frame.size())) + 1);
        };
        std::array<std::set<QByteArray>, 2> sent;
        for (int i = 0; i < 60; ++i) {
            const QByteArray one = message(i, 20 + int(random() % 3000));
            QVERIFY(pair.ends[size_t(i % 2)].send(one, i % 3 ? Rank::Assured : Rank::Topic));
            sent[size_t(i % 2)].insert(one);
        }
        const auto isDone = [&] { return pair.arrived[0].size() + pair.arrived[1].size() == 60; };
        const bool allCame = pair.run(isDone, 500);
        qInfo("%zu came, %llu and %llu were abandoned", pair.arrived[0].size() + pair.arrived[1].size(),
              pair.ends[0].counters().abandoned, pair.ends[1].counters().abandoned);
        QVERIFY(allCame);
        const double took = pair.now;
        QVERIFY(pair.run([&] { return pair.ends[0].bytesWaiting() + pair.ends[1].bytesWaiting() == 0; }, 20));
        pair.run([] { return false; }, 1);
        QVERIFY(isDone());
        for (size_t i = 0; i < 2; ++i) {
            const auto got = messagesOf(pair.arrived[1 - i]);
            QCOMPARE(std::set<QByteArray>(got.begin(), got.end()), sent[i]);
            QCOMPARE(pair.ends[i].counters().abandoned, 0u);
        }
        qInfo("%.1f s; repeated pieces: %llu", took, pair.ends[0].counters().repeatedPieces);
    }

    void piecesComeInAnyOrder() {
        const QByteArray content = sealed(message(1, 3000));
        std::vector<int> order(32);
        for (size_t i = 0; i < order.size(); ++i)
            order[i] = int(i);
        std::mt19937 random(7);
        for (int round = 0; round < 50; ++round) {
            std::shuffle(order.begin(), order.end(), random);
            SerialLink link(1);
            for (size_t i = 0; i < order.size(); ++i) {
                const auto got = link.receive(piece(5, order[i], content));
                QCOMPARE(got.size(), size_t(i + 1 == order.size()));
                if (!got.empty())
                    QCOMPARE(got[0].message, message(1, 3000));
            }
            QVERIFY(!link.isMidFrame());
            QVERIFY(link.hasNext()); // it has all
        }
    }

    void twoMessagesInterleaved() {
        const QByteArray a = sealed(message(1, 1000)), b = sealed(message(2, 1500));
        SerialLink link(1);
        std::vector<SerialLink::Arrival> got;
        for (int i = 0; i < 16; ++i)
            for (const auto &one :
                 link.receive((i < 11 ? piece(5, i, a) : QByteArray()) + piece(6, 15 - i, b)))
                got.push_back(one);
        QCOMPARE(messagesOf(got), (std::vector<QByteArray>{message(1, 1000), message(2, 1500)}));
    }

    void aPieceMoreThanOnce() {
        const QByteArray content = sealed(message(1, 500));
        SerialLink link(1);
        int got = 0;
        for (int round = 0; round < 3; ++round)
            for (int i = 0; i < 6; ++i)
                for (int times = 0; times < 3; ++times)
                    got += int(link.receive(piece(5, i, content, true)).size());
        QCOMPARE(got, 1);
        QVERIFY(!link.isMidFrame());
        while (link.hasNext())
            QVERIFY(!link.next().isEmpty());
    }

    void announcedBytesTakeNoMemory() {
        SerialLink link(1);
        link.setLimit(100000);
        std::mt19937 random(3);
        qint64 most = 0;
        double now = 0;
        for (int i = 0; i < 50000; ++i) {
            Piece one;
            one.number = quint16(random() % 40);
            one.total = i % 2 ? 90000 : quint32(1 + random() % 0xffffff);
            one.index = quint16(random() % 3 ? random() % 64 : random());
            one.toReport = random() % 2;
            const int size = int(std::min<qint64>(pieceBytes, qint64(one.total) - one.index * pieceBytes));
            one.bytes = QByteArray(size > 0 ? size : int(random() % 200), 'x');
            link.setTime(now += 0.001);
            link.receive(framed(one.toFrame()));
            most = std::max(most, link.bytesHeld());
            if (random() % 3 == 0)
                link.next();
        }
        QVERIFY2(most <= 8 * 64 * pieceBytes, saying(most));
    }

    void begunMessagesAreForgotten() {
        SerialLink link(1);
        const QByteArray content = sealed(message(1, 500));
        link.setTime(1);
        link.receive(piece(5, 0, content));
        QVERIFY(link.isMidFrame());
        QVERIFY(link.bytesHeld() > 0);
        link.setTime(32);
        QVERIFY(!link.isMidFrame());
        QCOMPARE(link.bytesHeld(), 0);
        QCOMPARE(link.counters().abandoned, 1u);
    }

    void aDeadLineEndsAMessage() {
        LinkPair pair(11520);
        pair.damage = [](QByteArray &frame) { frame.clear(); };
        const quint64 ticket = pair.ends[0].send(message(1, 5000), Rank::Topic);
        QVERIFY(pair.ends[0].hasTopicUnderWay());
        QVERIFY(pair.ends[0].isUnderWay(ticket));
        int frames = 0;
        pair.damage = [&frames](QByteArray &frame) {
            ++frames;
            frame.clear();
        };
        QVERIFY(pair.run([&] { return !pair.ends[0].isUnderWay(ticket); }, 25));
        QVERIFY2(frames < 150, saying(frames)); // it does not shout
        QCOMPARE(pair.ends[0].counters().abandoned, 1u);
        QCOMPARE(pair.ends[0].bytesWaiting(), 0);
        QVERIFY(!pair.ends[0].hasTopicUnderWay());
    }

    void whoBeginsAnewIsTold() {
        LinkPair pair(11520);
        const quint64 ticket = pair.ends[0].send(message(1, 50000), Rank::Usual);
        pair.run([] { return false; }, 1.5);
        pair.ends[1].reset(); // the other end is another program now
        QVERIFY(pair.run([&] { return !pair.ends[0].isUnderWay(ticket); }, 0.5));
        QCOMPARE(pair.ends[0].counters().abandoned, 1u);
        pair.ends[0].send(message(2, 5000), Rank::Usual);
        QVERIFY(pair.run([&] { return pair.arrived[1].size() == 1; }, 2));
        QCOMPARE(pair.arrived[1][0].message, message(2, 5000));
        // This end begins anew: what it had begun is forgotten there in time.
        pair.ends[0].send(message(3, 50000), Rank::Usual);
        pair.run([] { return false; }, 1);
        pair.ends[0].reset();
        QVERIFY(pair.ends[1].isMidFrame());
        QVERIFY(pair.run([&] { return !pair.ends[1].isMidFrame(); }, 40));
    }

    void equalNumbersOfTwoSendersDoNotMix() {
        const QByteArray a = sealed(message(1, 500)), b = sealed(message(2, 500)),
                         c = sealed(message(3, 700));
        SerialLink link(1);
        link.receive(piece(5, 0, a) + piece(5, 1, a));
        std::vector<SerialLink::Arrival> got;
        for (int i = 0; i < 6; ++i) // of the same number and size: not seen before the end
            for (const auto &one : link.receive(piece(5, i, b)))
                got.push_back(one);
        QCOMPARE(got.size(), size_t(0));
        QCOMPARE(link.counters().damaged, 1u);
        link.receive(piece(6, 0, a));
        for (int i = 0; i < 8; ++i) // of another size: the first is given up at once
            for (const auto &one : link.receive(piece(6, i, c)))
                got.push_back(one);
        QCOMPARE(messagesOf(got), std::vector<QByteArray>{message(3, 700)});
    }

    // The receiver remembers only so many that it has had.
    void lostReportsBringNothingTwice() {
        LinkPair pair(11520);
        bool isLost = true;
        pair.damage = [&isLost](QByteArray &frame) {
            const auto content = cobsDecoded(frame.constData(), frame.size() - 1);
            const auto report = content && content->startsWith('\x12')
                                    ? PieceReport::fromFrame(content->chopped(4))
                                    : std::nullopt;
            if (isLost && report && report->number == 1000) // of the first message
                frame.clear();
        };
        for (int i = 0; i < 200; ++i)
            pair.ends[0].send(message(i, 100), Rank::Assured);
        pair.run([] { return false; }, 15);
        const std::size_t before = pair.arrived[1].size();
        QVERIFY2(before > 25 && before < 40, saying(before)); // the others wait for the first
        isLost = false;
        QVERIFY(pair.run([&] { return pair.arrived[1].size() == 200; }, 30));
        pair.run([] { return false; }, 5);
        const auto got = messagesOf(pair.arrived[1]);
        QCOMPARE(got.size(), size_t(200));
        QCOMPARE(std::set<QByteArray>(got.begin(), got.end()).size(), size_t(200));
        QCOMPARE(pair.ends[0].counters().abandoned, 0u);
    }

    void damagedLineIsUsedWell() {
        for (const auto &[oneIn, least] : {std::pair<int, double>{0, 0.8}, {1000, 0.6}, {200, 0.35}}) {
            std::mt19937 random(5);
            LinkPair pair(11520);
            pair.damage = [&random, most = unsigned(oneIn)](QByteArray &frame) {
                for (char &byte : frame)
                    if (most > 0 && random() % most == 0)
                        byte = char(byte ^ (1 + random() % 255));
            };
            const double start = pair.now;
            pair.ends[0].send(message(1, 100000), Rank::Usual);
            QVERIFY(pair.run([&] { return !pair.arrived[1].empty(); }, 200));
            const double part = 100000 / 11520.0 / (pair.now - start);
            qInfo(
                "one byte in %d damaged: 100,000 bytes in %.1f s, %.0f %% of the line; %llu pieces repeated",
                oneIn, pair.now - start, part * 100, pair.ends[0].counters().repeatedPieces);
            QVERIFY(part > least);
        }
    }

    void largeMessageTakesNoTime() {
        LinkPair pair(1e9);
        pair.ends[1].setLimit(6 << 20);
        auto time = runningTimer();
        pair.ends[0].send(message(1, 1 << 20), Rank::Usual);
        const bool arrived = pair.run([&] { return !pair.arrived[1].empty(); }, 100);
        const qint64 once = time.restart();
        pair.arrived[1].clear();
        QVERIFY(arrived);
        pair.ends[0].send(message(2, 4 << 20), Rank::Usual);
        QVERIFY(pair.run([&] { return !pair.arrived[1].empty(); }, 100));
        qInfo("1 MiB took %lld ms, 4 MiB %lld ms", once, time.elapsed());
        QVERIFY(time.elapsed() < 10 * std::max<qint64>(once, 5)); // four times as much
    }
};
