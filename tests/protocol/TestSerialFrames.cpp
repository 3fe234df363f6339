// What the frames of the framing serial are made of: the checksum, the byte stuffing, pieces and reports.
#include "protocol/serial/Cobs.h"
#include "protocol/serial/Crc32c.h"
#include "protocol/serial/Piece.h"

using namespace hermes;

class TestSerialFrames : public QObject {
    Q_OBJECT

    static QByteArray hex(const char *digits) { return QByteArray::fromHex(digits); }

    static QByteArray counting(int from, int to) {
        QByteArray bytes;
        for (int i = from; i <= to; ++i)
            bytes.append(char(i));
        return bytes;
    }

    static std::optional<QByteArray> decoded(const QByteArray &bytes) {
        return cobsDecoded(bytes.constData(), bytes.size());
    }

private Q_SLOTS:
    void checksums_data() {
        const Rows<QByteArray, quint32> row("bytes", "crc");
        // RFC 3720, B.4; as numbers, it prints the lowest byte first.
        row("zeros", QByteArray(32, 0), 0x8a9136aau);
        row("ones", QByteArray(32, char(0xff)), 0x62a8ab43u);
        row("counting", counting(0, 31), 0x46dd794eu);
        QByteArray down = counting(0, 31);
        std::reverse(down.begin(), down.end());
        row("counting down", down, 0x113fdb5cu);
        row("an iSCSI command",
            hex("01c00000000000000000000000000000140000000000040000000014000000182800"
                "00000000000002000000"
                "00000000"),
            0xd9963a56u);
        row("digits", "123456789", 0xe3069283u);
        row("nothing", QByteArray(), 0u);
    }

    void checksums() {
        FETCH(QByteArray, bytes, quint32, crc);
        QCOMPARE(crc32c(bytes.constData(), size_t(bytes.size())), crc);
    }

    void stuffing_data() {
        const Rows<QByteArray, QByteArray> row("bytes", "stuffed");
        row("nothing", {}, hex("01"));
        // As the encyclopaedias have them.
        row("a zero", hex("00"), hex("0101"));
        row("two zeros", hex("0000"), hex("010101"));
        row("a zero, a byte, a zero", hex("001100"), hex("01021101"));
        row("a zero within", hex("11220033"), hex("0311220233"));
        row("no zero", hex("11223344"), hex("0511223344"));
        row("zeros at the end", hex("11000000"), hex("0211010101"));
        row("254 bytes", counting(1, 254), hex("ff") + counting(1, 254));
        row("a zero and 254", QByteArray(1, 0) + counting(1, 254), hex("01ff") + counting(1, 254));
        row("255 bytes", counting(1, 255), hex("ff") + counting(1, 254) + hex("02ff"));
        row("254 and a zero", counting(2, 255) + QByteArray(1, 0),
            hex("ff") + counting(2, 255) + hex("0101"));
        row("253 and a zero and one", counting(3, 255) + hex("0001"),
            hex("fe") + counting(3, 255) + hex("0201"));
        // Cheshire and Baker, 1999, figure 2.
        row("of the paper", hex("4500002c4c79000040064f37"), hex("024501042c4c79010540064f37"));
    }

    void stuffing() {
        FETCH(QByteArray, bytes, QByteArray, stuffed);
        QCOMPARE(cobsEncoded(bytes).toHex(), stuffed.toHex());
        QCOMPARE(decoded(stuffed)->toHex(), bytes.toHex());
    }

    void whateverIsStuffedComesBack() {
        std::mt19937 random(newSeed());
        for (int round = 0; round < 3000; ++round) {
            QByteArray bytes(int(random() % 1200), 0);
            const unsigned int zeros = 1 + random() % 300; // one in so many
            for (char &byte : bytes)
                byte = random() % zeros == 0 ? '\0' : char(random());
            const QByteArray stuffed = cobsEncoded(bytes);
            QVERIFY(!stuffed.contains('\0'));
            QVERIFY(stuffed.size() <= bytes.size() + bytes.size() / 254 + 1);
            QCOMPARE(*decoded(stuffed), bytes);
        }
    }

    void whatIsNotStuffedIsRefused() {
        for (const char *wrong : {"", "00", "02", "0311", "0511223344ff", "031100", "ff11"})
            QVERIFY2(!decoded(hex(wrong)), wrong);
    }

    void damageNeverCrashes() {
        std::mt19937 random(1);
        for (int round = 0; round < 20000; ++round) {
            QByteArray bytes(int(random() % 300), 0);
            for (char &byte : bytes)
                byte = char(random());
            if (const auto content = decoded(bytes)) {
                QVERIFY(content->size() < bytes.size());
                Piece::fromFrame(*content);
                PieceReport::fromFrame(*content);
            }
        }
    }

    void piecesAndReportsComeBack() {
        const Piece piece{true, 0x1234, 2, 200, QByteArray(8, 'x')};
        QCOMPARE(piece.toFrame().toHex(), QByteArray("1134120200c80000") + QByteArray(8, 'x').toHex());
        const auto back = Piece::fromFrame(piece.toFrame());
        QVERIFY(back && back->toReport);
        QCOMPARE(back->number, piece.number);
        QCOMPARE(back->index, piece.index);
        QCOMPARE(back->total, piece.total);
        QCOMPARE(back->bytes, piece.bytes);
        const PieceReport report{0x1234, 7, 0x0106};
        QCOMPARE(report.toFrame().toHex(), QByteArray("12341207000601"));
        const auto same = PieceReport::fromFrame(report.toFrame());
        QCOMPARE(same->number, report.number);
        QCOMPARE(same->base, report.base);
        QCOMPARE(same->later, report.later);
        QVERIFY(!PieceReport::fromFrame(hex("12341207")));
        QVERIFY(!PieceReport::fromFrame(hex("1234120700") + QByteArray(9, 1)));
    }

    void impossiblePiecesAreRefused_data() {
        QTest::addColumn<QByteArray>("frame");
        const auto row = [](const char *name, int index, quint32 total, int size) {
            QTest::newRow(name) << Piece{false, 1, quint16(index), total, QByteArray(size, 'x')}.toFrame();
        };
        row("no pieces", 0, 0, 0);
        row("a piece of nothing", 0, 0, 96);
        row("behind the last", 3, 200, 8);
        row("far behind it", 0xffff, 200, 8);
        row("too short", 0, 200, 95);
        row("too long", 0, 200, 97);
        row("the last too long", 2, 200, 96);
        row("more than can be counted", 0, 0xffffff, 96);
        QTest::newRow("no header") << hex("10010000");
    }

    void impossiblePiecesAreRefused() {
        QFETCH(QByteArray, frame);
        QVERIFY(!Piece::fromFrame(frame));
    }
};
