#include "daemons/seriallogger/FixTracker.h"
#include "daemons/seriallogger/LineSplitter.h"
#include "daemons/seriallogger/SerialMessages.h"
#include "protocol/wire/Fields.h"

using namespace hermes;
using namespace hermes::seriallogger;

class TestSerialViews : public QObject {
    Q_OBJECT

    struct Sentence {
        static QByteArray of(const QByteArray &body) {
            const auto sum = nmea::checksum({body.constData(), std::size_t(body.size())});
            return '$' + body + '*' + QByteArray::number(sum, 16).rightJustified(2, '0') + "\r\n";
        }
        static QByteArray rmc(int second, const char *talker = "GP") {
            return of(talker + QByteArray("RMC,1200") + QByteArray::number(second).rightJustified(2, '0') +
                      ",A,4807.038,N,01131.000,E,010.0,084.4,230326");
        }
        static QByteArray gga(int second) {
            return of("GPGGA,1200" + QByteArray::number(second).rightJustified(2, '0') +
                      ",4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,");
        }
    };

    static Moment at(int ms) { return {std::int64_t(ms) * 1000000, std::int64_t(ms) * 1000000}; }

    static std::string_view viewOf(const QByteArray &bytes) {
        return {bytes.constData(), std::size_t(bytes.size())};
    }

    /// Each line as "OFFSET@MS text", with " ..." when it is cut.
    static QStringList split(const QList<QByteArray> &chunks) {
        LineSplitter splitter;
        QStringList lines;
        const auto sink = [&](const LineSplitter::Line &line) {
            lines << QString("%1@%2 %3%4")
                         .arg(line.offset)
                         .arg(line.arrival.mono_ns / 1000000)
                         .arg(QString::fromStdString(escaped(line.bytes)), line.cut ? " ..." : "");
        };
        int ms = 0;
        for (const QByteArray &chunk : chunks)
            splitter.feed(viewOf(chunk), at(ms++), sink);
        splitter.finish(sink);
        return lines;
    }

private Q_SLOTS:
    void linesAreSplit_data() {
        const Rows<QList<QByteArray>, QStringList> row("chunks", "lines");
        row("LF", {"one\ntwo\n"}, {"0@0 one", "4@0 two"});
        row("CR LF", {"one\r\ntwo\r\n"}, {"0@0 one", "5@0 two"});
        row("CR", {"one\rtwo\r"}, {"0@0 one", "4@0 two"});
        row("parts have the time of the first", {"o", "n", "e\nt", "wo\n"}, {"0@0 one", "4@2 two"});
        row("between CR and LF", {"one\r", "\ntwo\n"}, {"0@0 one", "5@1 two"});
        row("no end", {"one"}, {"0@0 one"});
        row("empty", {"\n\r\n", "", "\n"}, QStringList());
        row("not ASCII", {QByteArray("\0\xff\t\\\n", 5)}, {"0@0 \\x00\\xFF\t\\\\"});
    }

    void linesAreSplit() {
        FETCH(QList<QByteArray>, chunks, QStringList, lines);
        QCOMPARE(split(chunks), lines);
    }

    void endlessLinesComeInPieces() {
        const auto longest = int(LineSplitter::longest);
        const QStringList lines = split({QByteArray(2 * longest + 5, 'x'), "\nshort\n"});
        QCOMPARE(lines.size(), 4);
        QCOMPARE(lines[0], "0@0 " + QString(longest, 'x') + " ...");
        QCOMPARE(lines[1], QString("%1@0 ").arg(longest) + QString(longest, 'x') + " ...");
        QCOMPARE(lines[2], QString("%1@0 xxxxx").arg(2 * longest));
        QCOMPARE(lines[3], QString("%1@1 short").arg(2 * longest + 6));
    }

    void missingBytesCutTheLine() {
        LineSplitter splitter;
        QStringList lines;
        const auto sink = [&](const LineSplitter::Line &line) {
            lines << QString(
                saying("%1 %2 %3", line.offset, QString::fromStdString(escaped(line.bytes)), line.cut));
        };
        splitter.feed("first ha", at(0), sink);
        splitter.skip(100, sink);
        splitter.feed("rest\n", at(1), sink);
        QCOMPARE(lines, (QStringList{"0 first ha 1", "108 rest 0"}));
    }

    void textKeepsEveryByte() {
        QSet<QString> texts;
        for (int byte = 0; byte < 256; ++byte) {
            const char character = char(byte);
            const QString text = QString::fromStdString(escaped({&character, 1}));
            for (const QChar c : text)
                QVERIFY((c >= ' ' && c <= '~') || c == '\t');
            texts.insert(text);
        }
        QCOMPARE(texts.size(), 256);
    }

    void sentencesOfOneMomentAreJoined() {
        for (const bool rmcFirst : {true, false}) {
            FixTracker tracker(nmea::ChecksumRule::Strict);
            QList<Fix> fixes;
            QList<int> givenAt;
            for (int second = 0; second < 5; ++second) {
                const QByteArray a = rmcFirst ? Sentence::rmc(second) : Sentence::gga(second);
                const QByteArray b = rmcFirst ? Sentence::gga(second) : Sentence::rmc(second);
                for (const QByteArray &bytes :
                     {a.left(20), a.mid(20) + Sentence::of("GPGSV,,T") + b.left(1), b.mid(1)})
                    tracker.feed(viewOf(bytes), at(second * 1000 + fixes.size()), [&](const Fix &fix) {
                        fixes << fix;
                        givenAt << second;
                    });
            }
            QCOMPARE(fixes.size(), 5);
            for (int second = 0; second < 5; ++second) {
                QCOMPARE(givenAt[second], second); // with its second sentence, not with the next fix
                QCOMPARE(fixes[second].time.value(), 1774267200.0 + second);
                QVERIFY(fixes[second].speed && fixes[second].altitude && fixes[second].valid);
                QCOMPARE(fixes[second].arrival.mono_ns, at(second * 1000 + second).mono_ns);
            }
        }
    }

    void oneKindOfSentenceIsEnough() {
        FixTracker tracker(nmea::ChecksumRule::Strict);
        QList<double> times;
        const auto sink = [&](const Fix &fix) { times << fix.time.value_or(-1); };
        tracker.feed(viewOf(Sentence::rmc(1)), at(0), sink);
        QCOMPARE(times.size(), 0); // another may follow
        tracker.feed(viewOf(Sentence::rmc(2)), at(0), sink);
        QCOMPARE(times.size(), 2); // none did
        tracker.feed(viewOf(Sentence::rmc(3)), at(0), sink);
        QCOMPARE(times.size(), 3);
        tracker.feed(viewOf(Sentence::rmc(3)), at(0), sink); // once more
        tracker.feed(viewOf(Sentence::gga(4)), at(0), sink);
        QCOMPARE(times.size(), 3); // an RMC may follow
        tracker.pause(sink);
        QCOMPARE(times, (QList<double>{1774267201, 1774267202, 1774267203, 1774267204}));
        QCOMPARE(tracker.counts().repeated, quint64(1));
    }

    void withoutATimeEverySentenceCounts() {
        FixTracker tracker(nmea::ChecksumRule::Strict);
        QList<Fix> fixes;
        for (int i = 0; i < 10; ++i)
            tracker.feed(viewOf(Sentence::of("GPRMC,,V,,,,,,,") + Sentence::of("GPGGA,,,,,,0,,,,M,,M,,")),
                         at(i), [&](const Fix &fix) { fixes << fix; });
        QCOMPARE(fixes.size(), 10);
        QVERIFY(!fixes[9].valid && !fixes[9].time && !fixes[9].position);
    }

    void damagedSentencesAreCounted() {
        FixTracker tracker(nmea::ChecksumRule::Strict);
        int fixes = 0;
        const auto count = [&](const Fix &) { ++fixes; };
        const QByteArray good = Sentence::rmc(1);
        QByteArray damaged = good;
        damaged[20] = char(damaged[20] ^ 1);
        const QByteArray foreign = "\xfe\x80 no GPS " + good.left(30) + "\xc3\xa4" + good.mid(30);
        tracker.feed(viewOf(damaged + foreign + "$GPTXT," + QByteArray(5000, 'y') +
                            Sentence::of("GPRMC,990000,A,,,,,,,010203")),
                     at(0), count);
        tracker.pause(count);
        QCOMPARE(fixes, 0);
        QCOMPARE(tracker.sentences().badChecksum, quint64(1));
        QCOMPARE(tracker.sentences().badByte, quint64(1));
        QCOMPARE(tracker.sentences().tooLong, quint64(1));
        QCOMPARE(tracker.counts().badFields, quint64(1));
        QCOMPARE(tracker.lastFault().field, 1);
        tracker.feed(viewOf(good), at(0), count);
        tracker.pause(count);
        QCOMPARE(fixes, 1);
    }

    void fixesAsJson() {
        FixTracker tracker(nmea::ChecksumRule::Strict);
        QJsonObject json;
        const auto sink = [&](const Fix &fix) { json = asJson(valuesOf(fix)).toObject(); };
        tracker.feed(viewOf(Sentence::rmc(7) + Sentence::gga(7)), at(2500), sink);
        QCOMPARE(json.value("stamp").toDouble(), 2.5);
        QCOMPARE(json.value("time").toDouble(), 1774267207.0);
        QCOMPARE(json.value("lat_deg").toDouble(), 48 + 7.038 / 60);
        QCOMPARE(json.value("lon_deg").toDouble(), 11 + 31.0 / 60);
        QCOMPARE(json.value("alt").toDouble(), 545.4);
        QCOMPARE(json.value("quality").toInt(), 1);
        QCOMPARE(json.value("satellites").toInt(), 8);
        QCOMPARE(json.value("hdop").toDouble(), 0.9);
        QVERIFY(std::abs(json.value("speed").toDouble() - 5.14444) < 1e-5);
        QCOMPARE(json.value("course_deg").toDouble(), 84.4);
        QVERIFY(json.value("valid").toBool());
        tracker.feed(viewOf(Sentence::of("GPRMC,120008,V,,,,,,,230326") + Sentence::rmc(9)), at(3000),
                     [&](const Fix &fix) {
                         if (!fix.valid)
                             json = asJson(valuesOf(fix)).toObject();
                     });
        for (const char *unknown :
             {"lat_deg", "lon_deg", "alt", "quality", "satellites", "hdop", "speed", "course_deg"})
            QVERIFY(json.value(unknown).isNull());
        QCOMPARE(json.value("time").toDouble(), 1774267208.0);
    }
};
