#include "tests/daemons/NmeaStream.h"

using namespace hermes;
using namespace hermes::seriallogger;

constexpr double day_s = 1893456000; // 2030-01-01

/// What is wanted of a fix; -1 for unknown.
struct Wanted {
    double time;
    bool valid = true;
    double latitude = 48.5;
    double speed = -1;
    double altitude = -1;
};

/// The sentences of 2030-01-01, at 48.5 degrees north, 11.25 degrees east.
struct Receiver {
    static QByteArray rmc(const QByteArray &time, const char *talker = "GP", const char *date = "010130",
                          const char *latitude = "4830.000") {
        return sentence(talker + QByteArray("RMC,") + time + ",A," + latitude +
                        ",N,01115.000,E,010.0,084.4," + date + ",999.9,,A");
    }
    static QByteArray gga(const QByteArray &time, const char *talker = "GP", int quality = 1) {
        return sentence(talker + QByteArray("GGA,") + time +
                        (quality > 0 ? ",4830.000,N,01115.000,E," : ",,,,,") + QByteArray::number(quality) +
                        (quality > 0 ? ",08,0.9,520.5,M,46.9,M,," : ",00,99.9,,M,,M,,"));
    }
    static QByteArray gns(const QByteArray &time, const char *mode = "AA") {
        return sentence("GNGNS," + time + ",4830.000,N,01115.000,E," + mode + ",14,0.7,520.5,46.9,,,V");
    }
    static QByteArray gll(const QByteArray &time) {
        return sentence("GPGLL,4830.000,N,01115.000,E," + time + ",A,A");
    }
    static QByteArray vtg(const char *talker = "GP") {
        return sentence(talker + QByteArray("VTG,084.4,T,081.2,M,010.0,N,018.5,K,A"));
    }
    static QByteArray zda(const QByteArray &time) { return sentence("GPZDA," + time + ",01,01,2030,00,00"); }
};
using R = Receiver;

Q_DECLARE_METATYPE(Wanted)

/// What receivers of many kinds say becomes one fix for each moment.
class TestSerialFixes : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void oneFixForEachMoment_data() {
        Rows<QByteArrayList, QList<Wanted>>("bursts", "wanted"); // bursts: one a second
        constexpr double speed = 5.14444, noon = day_s + 43200;
        const auto row = [](const char *name, auto burst, const QList<Wanted> &wanted) {
            QByteArrayList bursts;
            for (const char *time : {"120000", "120001.00", "120002.0"})
                bursts << burst(QByteArray(time));
            QTest::newRow(name) << bursts << wanted;
        };
        const auto three = [](const Wanted &first) {
            Wanted second = first, third = first;
            second.time += first.time < 0 ? 0 : 1;
            third.time += first.time < 0 ? 0 : 2;
            return QList<Wanted>{first, second, third};
        };
        row(
            "RMC, GGA", [](auto t) { return R::rmc(t) + R::gga(t); },
            three({noon, true, 48.5, speed, 520.5}));
        row(
            "two constellations, then RMC",
            [](auto t) { return R::gga(t) + R::gga(t, "GL") + R::rmc(t, "GN"); },
            three({noon, true, 48.5, speed, 520.5}));
        row(
            "RMC first", [](auto t) { return R::rmc(t, "GN") + R::gga(t) + R::gga(t, "GL") + R::vtg(); },
            three({noon, true, 48.5, speed, 520.5}));
        row(
            "RMC in between",
            [](auto t) { return R::gga(t, "GA") + R::rmc(t, "GN") + R::gga(t, "GB") + R::gll(t); },
            three({noon, true, 48.5, speed, 520.5}));
        row(
            "one of two constellations has no fix",
            [](auto t) { return R::gga(t, "GP", 0) + R::rmc(t, "GN") + R::gga(t, "GL"); },
            three({noon, true, 48.5, speed, 520.5}));
        row(
            "the other one", [](auto t) { return R::rmc(t, "GN") + R::gga(t) + R::gga(t, "GL", 0); },
            three({noon, true, 48.5, speed, 520.5}));
        row(
            "GNS, RMC", [](auto t) { return R::gns(t) + R::rmc(t, "GN"); },
            three({noon, true, 48.5, speed, 520.5}));
        row(
            "GNS of all and of each",
            [](auto t) {
                return R::gns(t) + sentence("GPGNS," + t + ",,,,,,7,,,,5.2,23") +
                       sentence("GLGNS," + t + ",,,,,,7,,,,3.0,23") + R::zda(t);
            },
            three({noon, true, 48.5, -1, 520.5}));
        row(
            "GNS, VTG, ZDA", [](auto t) { return R::gns(t) + R::vtg("GN") + R::zda(t); },
            three({noon, true, 48.5, speed, 520.5}));
        row(
            "ZDA first", [](auto t) { return R::zda(t) + R::vtg() + R::gga(t); },
            three({noon, true, 48.5, speed, 520.5}));
        row(
            "only RMC", [](auto t) { return R::rmc(t); }, three({noon, true, 48.5, speed}));
        row(
            "only GLL", [](auto t) { return R::gll(t); }, three({-1}));
        row(
            "only GGA", [](auto t) { return R::gga(t); }, three({-1, true, 48.5, -1, 520.5}));
        row(
            "only GNS", [](auto t) { return R::gns(t); }, three({-1, true, 48.5, -1, 520.5}));
        row(
            "GLL and ZDA", [](auto t) { return R::gll(t) + R::zda(t); }, three({noon}));
        row(
            "each twice", [](auto t) { return R::gga(t) + R::gga(t) + R::rmc(t) + R::rmc(t); },
            three({noon, true, 48.5, speed, 520.5}));
        row(
            "the burst twice", [](auto t) { return (R::gga(t) + R::vtg() + R::rmc(t)).repeated(2); },
            three({noon, true, 48.5, speed, 520.5}));
        row(
            "warning",
            [](auto t) { return sentence("GPRMC," + t + ",V,,,,,,,010130,,,N") + R::gga(t, "GP", 0); },
            three({noon, false, -1}));
        row(
            "warning of RMC alone",
            [](auto t) {
                return sentence("GPRMC," + t + ",V,4830.0,N,01115.0,E,,,010130,,,E") + R::gga(t, "GP", 6);
            },
            three({noon, false, 48.5, -1, 520.5}));
        row(
            "no fix of GNS", [](auto t) { return R::gns(t, "NN") + R::zda(t); },
            three({noon, false, 48.5, -1, 520.5}));
        row(
            "nothing known",
            [](auto) { return sentence("GPRMC,,V,,,,,,,,,,N") + sentence("GPGGA,,,,,,0,,,,M,,M,,"); },
            three({-1, false, -1}));
        row(
            "nothing known, some of it thrice",
            [](auto) {
                return sentence("GPGGA,,,,,,0,,,,,,,,") + sentence("GNGNS,,,,,,NN,,,,,,").repeated(3) +
                       sentence("GPRMC,,V,,,,,,,,,,N");
            },
            three({-1, false, -1}));
        row(
            "three decimals, and two of them rounded",
            [](const QByteArray &t) { return R::gga(t.left(6) + ".30") + R::rmc(t.left(6) + ".295"); },
            three({noon + 0.3, true, 48.5, speed, 520.5}));
        row(
            "three decimals, and two of them cut",
            [](const QByteArray &t) { return R::gga(t.left(6) + ".299") + R::rmc(t.left(6) + ".29"); },
            three({noon + 0.299, true, 48.5, speed, 520.5}));
        row("neither fix", [](auto t) { return R::zda(t) + R::vtg() + sentence("GPGSV,1,1,00"); }, {});
    }

    void oneFixForEachMoment() {
        FETCH(QByteArrayList, bursts, QList<Wanted>, wanted);
        for (const bool live : {false, true}) {
            NmeaStream stream;
            stream.live = live;
            for (int i = 0; i < bursts.size(); ++i)
                stream.feed(i * 1000, bursts[i]);
            stream.finish();
            QCOMPARE(stream.fixes.size(), wanted.size());
            for (int i = 0; i < wanted.size(); ++i) {
                const QJsonObject &fix = stream.fixes[i];
                QCOMPARE(fix.value("time").toDouble(-1), wanted[i].time);
                QCOMPARE(fix.value("valid").toBool(), wanted[i].valid);
                QCOMPARE(fix.value("lat_deg").toDouble(-1), wanted[i].latitude);
                QVERIFY(std::abs(fix.value("speed").toDouble(-1) - wanted[i].speed) < 1e-5);
                QCOMPARE(fix.value("alt").toDouble(-1), wanted[i].altitude);
                QCOMPARE(fix.value("mono").toDouble(), i * 1.0);
            }
            QCOMPARE(stream.tracker.counts().badFields, quint64(0));
            QCOMPARE(stream.tracker.counts().late, quint64(0));
        }
    }

    void completeOnesAreGivenAtOnce_data() {
        const Rows<QByteArrayList, int> row(
            "sentences", "complete"); // sentences: with TIME in them; complete: at which of them
        const QByteArray rmc = R::rmc("TIME"), gga = R::gga("TIME"), gl = R::gga("TIME", "GL"),
                         gll = R::gll("TIME"), gns = R::gns("TIME"), zda = R::zda("TIME");
        row("RMC", {rmc}, 0);
        row("RMC, GGA", {rmc, gga}, 1);
        row("GGA, RMC", {gga, rmc}, 1);
        row("GLL tells nothing more", {rmc, gga, gll}, 1);
        row("two constellations", {gga, gl, gll, rmc}, 3);
        row("VTG behind", {gga, gll, R::vtg()}, 2);
        row("VTG, RMC", {gns, R::vtg(), rmc}, 1); // its date is known
        row("ZDA behind", {gll, zda}, 0);         // for the same reason
    }

    void completeOnesAreGivenAtOnce() {
        FETCH(QByteArrayList, sentences, int, complete);
        NmeaStream stream;
        stream.live = true;
        for (int second = 0; second < 5; ++second) {
            for (int i = 0; i < sentences.size(); ++i) {
                QByteArray body = sentences[i].mid(1);
                body.truncate(body.indexOf('*'));
                body.replace("TIME", "12000" + QByteArray::number(second));
                stream.feed(second * 1000 + i * 80, sentence(body));
            }
        }
        stream.finish();
        QCOMPARE(stream.fixes.size(), 5);
        for (int second = 1; second < 5; ++second) // of the first nobody can know
            QCOMPARE(stream.givenAt_ms[second], second * 1000 + complete * 80);
    }

    void whatIsMissingIsNotWaitedForLong() {
        for (const int rate_hz : {1, 2, 5, 10, 20}) {
            NmeaStream stream;
            stream.live = true;
            const int period_ms = 1000 / rate_hz;
            for (int i = 0; i < 20; ++i) {
                const QByteArray time =
                    "1200" + QByteArray::number(i * period_ms * 1e-3, 'f', 2).rightJustified(5, '0');
                stream.feed(i * period_ms, R::gga(time) + (i % 3 == 2 ? QByteArray() : R::rmc(time)));
            }
            stream.pauseUntil(100000);
            QCOMPARE(stream.fixes.size(), 20);
            for (int i = 1; i < 20; ++i) {
                const int late_ms = stream.givenAt_ms[i] - i * period_ms;
                QVERIFY(std::abs(late_ms - (i % 3 == 2 ? std::max(50, period_ms / 2) : 0)) <= 1);
            }
        }
    }

    void dateOfTheDay_data() {
        const Rows<QByteArrayList, QList<double>> row(
            "bursts", "times"); // times: since the beginning of the day; -1: unknown
        row("known from RMC", {R::rmc("120000"), R::gga("120001"), R::gll("120002")}, {43200, 43201, 43202});
        row("known from ZDA", {R::gga("120000"), R::gga("120001") + R::zda("120001"), R::gga("120002")},
            {-1, -1, 43202}); // it was given already
        row("midnight",
            {R::gga("235958") + R::rmc("235958"), R::gga("235959"), R::gga("000000"), R::gga("000001"),
             R::rmc("000002", "GP", "020130")},
            {86398, 86399, 86400, 86401, 86402});
        row("midnight between GGA and RMC",
            {R::rmc("235958") + R::gga("235958"), R::gga("235959.00"),
             R::rmc("000000", "GP", "020130") + R::gga("000000"), R::gga("000001")},
            {86398, 86399, 86400, 86401});
        row("leap second", {R::rmc("235959"), R::gga("235960"), R::gga("000000")}, {86399, 86400, 86400});
        row("back over midnight", {R::rmc("000000", "GP", "020130"), R::gga("235959"), R::gga("000000")},
            {86400, 86399, 86400});
        row("an impossible date", {R::rmc("120000", "GP", "310230"), R::gga("120001")}, {-1, -1});
    }

    void dateOfTheDay() {
        FETCH(QByteArrayList, bursts, QList<double>, times);
        NmeaStream stream;
        for (int i = 0; i < bursts.size(); ++i)
            stream.feed(i * 1000, bursts[i]);
        stream.finish();
        QList<double> found;
        for (const QJsonObject &fix : stream.fixes)
            found << (fix.value("time").isNull() ? -1 : fix.value("time").toDouble() - day_s);
        QCOMPARE(found, times);
    }

    void theClockOfTheReceiver_data() {
        const Rows<QByteArrayList, bool> row("seconds", "pauses"); // seconds: of 12:00
        row("goes on", {"00", "01", "02", "03"}, true);
        row("goes on, all at once", {"00", "01", "02", "03"}, false);
        row("leaves out", {"00", "02", "05", "59"}, false);
        row("steps back by one", {"10", "11", "10", "11", "12"}, true);
        row("steps back by more", {"15", "16", "17", "03", "04"}, false);
        row("stands", {"10", "10", "10"}, true);
    }

    void theClockOfTheReceiver() {
        FETCH(QByteArrayList, seconds, bool, pauses);
        for (const bool rmcFirst : {true, false}) {
            NmeaStream stream;
            for (int i = 0; i < seconds.size(); ++i) {
                const QByteArray time = "1200" + seconds[i], a = R::rmc(time), b = R::gga(time);
                stream.feed(pauses ? i * 1000 : 0, rmcFirst ? a + b : b + a);
            }
            stream.finish();
            QCOMPARE(stream.fixes.size(), seconds.size());
            for (int i = 0; i < seconds.size(); ++i) {
                QCOMPARE(stream.fixes[i].value("time").toDouble(), day_s + 43200 + seconds[i].toInt());
                QVERIFY(stream.fixes[i].value("speed").isDouble() && stream.fixes[i].value("alt").isDouble());
            }
        }
    }

    /// VTG belongs to the sentences that it came with.
    void speedWithoutTime() {
        for (const bool first : {true, false}) {
            NmeaStream stream;
            for (int i = 0; i < 8; ++i) {
                const QByteArray time = "12000" + QByteArray::number(i);
                const QByteArray vtg =
                    i == 4 ? QByteArray() : sentence("GPVTG,,T,,M,,N," + QByteArray::number(i * 3.6) + ",K");
                stream.feed(i * 1000, first ? vtg + R::gll(time) : R::gll(time) + vtg);
            }
            stream.finish();
            QCOMPARE(stream.fixes.size(), 8);
            for (int i = 0; i < 8; ++i)
                QVERIFY(std::abs(stream.fixes[i].value("speed").toDouble(-1) - (i == 4 ? -1 : i)) < 1e-9);
        }
    }

    void lateSentencesAreCounted() {
        NmeaStream stream, recorded;
        stream.live = true;
        for (NmeaStream *each : {&stream, &recorded}) {
            for (int i = 0; i < 3; ++i) {
                const QByteArray time = "12000" + QByteArray::number(i);
                each->feed(i * 1000, R::gga(time));
                each->feed(i * 1000 + (i == 2 ? 700 : 0), R::rmc(time)); // held up somewhere
            }
            each->feed(3000, R::gga("120003") + R::gga("120002") + R::rmc("120003")); // and out of order
            each->finish();
            QCOMPARE(each->fixes.size(), 4);
            QVERIFY(each->fixes[3].value("speed").isDouble());
            QCOMPARE(each->tracker.counts().repeated, quint64(1));
        }
        QVERIFY(stream.fixes[2].value("speed").isNull() && stream.fixes[2].value("valid").toBool());
        QCOMPARE(stream.tracker.counts().late, quint64(1));
        QVERIFY(recorded.fixes[2].value("speed").isDouble()); // nobody waits for it
        QCOMPARE(recorded.tracker.counts().late, quint64(0));
    }

    void wrongSentencesAreNotMissed() {
        NmeaStream stream;
        for (int i = 0; i < 4; ++i) {
            const QByteArray time = "12000" + QByteArray::number(i);
            QByteArray damaged = R::gga(time);
            damaged[20] = char(damaged[20] ^ 1);
            stream.feed(i * 1000, (i == 1 ? damaged : R::gga(time)) +
                                      R::rmc(time, "GP", "010130", i == 2 ? "9930.000" : "4830.000"));
        }
        stream.finish();
        QCOMPARE(stream.fixes.size(), 4);
        QVERIFY(stream.fixes[1].value("alt").isNull() && stream.fixes[1].value("speed").isDouble());
        QVERIFY(stream.fixes[2].value("alt").isDouble() && stream.fixes[2].value("speed").isNull());
        for (int i = 0; i < 4; ++i) {
            QCOMPARE(stream.fixes[i].value("lat_deg").toDouble(), 48.5);
            QCOMPARE(stream.fixes[i].value("time").toDouble(), day_s + 43200 + i);
        }
        QCOMPARE(stream.tracker.sentences().badChecksum, quint64(1));
        QCOMPARE(stream.tracker.counts().badFields, quint64(1));
    }
};
