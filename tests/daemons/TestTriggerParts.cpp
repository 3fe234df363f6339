// The parts of the software trigger that have no daemon around them.
#include "common/Time.h"
#include "daemons/softwaretrigger/FiringLog.h"
#include "daemons/softwaretrigger/Schedule.h"
#include "daemons/softwaretrigger/Watch.h"

#include <QTimeZone>

using namespace hermes;
using namespace hermes::softwaretrigger;

using vectorlib::pi;

static WireValue odometry(double x, double y, double theta, double mono, double vx = 1, double omega = 1) {
    return QJsonValue(QJsonObject{{"pose", QJsonObject{{"x", x}, {"y", y}, {"theta", theta}}},
                                  {"twist", QJsonObject{{"vx", vx}, {"vy", 0}, {"omega", omega}}},
                                  {"mono", mono}});
}

static double utc(const QString &text) {
    return double(QDateTime::fromString(text, Qt::ISODate).toMSecsSinceEpoch()) / 1000;
}

class TestTriggerParts : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void conditionFiresWhenItBecomesTrue() {
        Condition below("battery.v", "<", 11);
        const auto reading = [](double v) { return QJsonObject{{"battery", QJsonObject{{"v", v}}}}; };
        QCOMPARE(below.becomesTrue(reading(10)), std::optional(true)); // the first message
        QCOMPARE(below.becomesTrue(reading(9)), std::optional(false));
        QCOMPARE(below.becomesTrue(QJsonObject{}), std::nullopt);
        QCOMPARE(below.becomesTrue(reading(9)), std::optional(false)); // was true before what said nothing
        QCOMPARE(below.becomesTrue(reading(11)), std::optional(false));
        QCOMPARE(below.becomesTrue(reading(10.5)), std::optional(true));
        QCOMPARE(below.becomesTrue(QJsonObject{{"battery", "low"}}), std::nullopt);

        struct Case {
            const char *op;
            QJsonValue limit, value;
            std::optional<bool> expected;
        };
        const Case cases[] = {{"<=", 2, 2, true},
                              {">", 2, 2, false},
                              {">=", 2, 2, true},
                              {"==", "run", "run", true},
                              {"==", "run", 1, false},
                              {"!=", true, false, true},
                              {"==", QJsonValue(), 0, false},
                              {">", 2, "three", std::nullopt}};
        for (const Case &one : cases)
            QCOMPARE(Condition("", one.op, one.limit).becomesTrue(one.value), one.expected);
    }

    void pathsLeadThroughObjectsAndArrays() {
        const QJsonObject data{{"a", QJsonArray{1, QJsonObject{{"b", "deep"}}}}, {"7", 8}};
        QCOMPARE(lookUp(data, "a.1.b"), QJsonValue("deep"));
        QCOMPARE(lookUp(data, "7"), QJsonValue(8));
        QCOMPARE(lookUp(data, ""), QJsonValue(data));
        for (const char *path : {"a.2", "a.-1", "a.b", "a.1.b.c", "x"})
            QVERIFY2(lookUp(data, path).isUndefined(), path);
    }

    // A circle of 1 m radius at 1 m/s, 50 messages a second: each 0.5 m within one message.
    void wayIsCountedAlongTheCurve() {
        Travel travel(Travel::Kind::Distance, 0.5);
        quint64 expected = 1;
        for (int i = 0; i <= 1000; ++i) {
            const double way = 0.02 * i;
            const auto passed = travel.add(odometry(std::cos(way), std::sin(way), 0, way));
            QVERIFY(passed.ok());
            if (!*passed)
                continue;
            QCOMPARE((*passed)->n, expected);
            QCOMPARE((*passed)->missed, 0ull);
            // Chords are shorter than the arc by 1 part in 60000.
            QVERIFY2(way >= 0.5 * double(expected) && way <= 0.5 * double(expected) + 0.0201 + 2e-5 * way,
                     qPrintable(QString::number(way, 'g', 10)));
            ++expected;
        }
        QVERIFY(expected >= 39);
        QVERIFY(std::abs(travel.total() - 20) < 0.001);
    }

    void angleIsCountedInBothDirections() {
        Travel travel(Travel::Kind::Angle, pi / 2);
        int fired = 0;
        double theta = 3, mono = 0; // passes the seam at pi
        for (const double direction : {1.0, -1.0}) {
            for (int i = 0; i < 200; ++i) {
                theta += direction * 0.02;
                mono += 0.02;
                fired += (*travel.add(odometry(0, 0, std::remainder(theta, 2 * pi), mono))).has_value();
            }
        }
        QCOMPARE(fired, 5); // 8 rad without the first message and the turn of direction
        QVERIFY(std::abs(travel.total() - 7.98) < 0.01);
    }

    void posesThatWereSetAreNoWay() {
        Travel travel(Travel::Kind::Distance, 1);
        travel.add(odometry(0, 0, 0, 1));
        travel.add(odometry(0.02, 0, 0, 1.02));
        QVERIFY(!(*travel.add(odometry(50, 0, 0, 1.04))).has_value()); // odometry.reset
        QCOMPARE(travel.jumps(), 1ull);
        travel.add(odometry(50.02, 0, 0, 1.06));
        QVERIFY(!(*travel.add(odometry(0, 0, 0, 0.5))).has_value()); // its clock began anew
        QCOMPARE(travel.jumps(), 2ull);
        QVERIFY(std::abs(travel.total() - 0.04) < 1e-9);
        travel.interrupt(); // another daemon of that name
        QVERIFY(!(*travel.add(odometry(0.3, 0, 0, 0.6))).has_value());
        QCOMPARE(travel.jumps(), 2ull);
        QVERIFY(std::abs(travel.total() - 0.04) < 1e-9);
        // Messages that were thinned out are way all the same.
        QVERIFY((*travel.add(odometry(1.3, 0, 0, 1.6))).has_value());
    }

    void noiseAtRestIsNoWay() {
        Travel travel(Travel::Kind::Distance, 0.01);
        for (int i = 0; i < 100000; ++i)
            QVERIFY(!(*travel.add(odometry(i % 2 * 2e-4, 0, 0, 0.02 * i, 0))).has_value());
    }

    void severalStepsInOneMessageFireOnce() {
        Travel travel(Travel::Kind::Distance, 0.1);
        travel.add(odometry(0, 0, 0, 1));
        const auto passed = *travel.add(odometry(0.55, 0, 0, 1.5));
        QVERIFY(passed.has_value());
        QCOMPARE(passed->n, 5ull);
        QCOMPARE(passed->missed, 4ull);
    }

    void whatIsNoOdometryIsRefused() {
        Travel travel(Travel::Kind::Distance, 1);
        QJsonObject text = odometry(0, 0, 0, 1).toJson().toObject(), without = text;
        text["pose"] = QJsonObject{{"x", "far"}, {"y", 0}, {"theta", 0}};
        without.remove("mono");
        const QJsonValue bad[] = {QJsonValue(), 1, QJsonArray(), QJsonObject(), text, without};
        for (const QJsonValue &message : bad)
            QVERIFY(!travel.add(WireValue(message)).ok());
    }

    void timeOfDayFiresOnceADay() {
        DayTime noon(QTime(12, 0), true, utc("2026-05-01T11:00:00Z"));
        QCOMPARE(noon.next(), utc("2026-05-01T12:00:00Z"));
        QVERIFY(!noon.judge(noon.next() - 0.001).fires); // awake too early
        const double today = noon.next();
        const auto verdict = noon.judge(today + 0.01);
        QVERIFY(verdict.fires);
        QCOMPARE(verdict.due, today);
        QCOMPARE(noon.next(), today + 86400);
        QVERIFY(!noon.judge(today + 0.02).fires);
        // Exactly at its time it is the next one's turn.
        QCOMPARE(DayTime(QTime(12, 0), true, today).next(), today + 86400);
    }

    void timeOfDayAfterStepsOfTheClock() {
        const double noon = utc("2026-05-01T12:00:00Z");
        DayTime time(QTime(12, 0), true, noon - 100);
        QVERIFY(time.judge(noon + 500).missed); // forward over it
        QCOMPARE(time.next(), noon + 86400);
        QVERIFY(!time.judge(noon - 50).fires); // back before it: it comes after all
        QCOMPARE(time.next(), noon);
        QVERIFY(time.judge(noon).fires);
        QVERIFY(!time.judge(noon - 3600).fires); // back over it, as at the end of summer time: not twice
        QCOMPARE(time.next(), noon + 86400);
        time.judge(noon - 30 * 86400.0); // another month: the clock was wrong before
        QCOMPARE(time.next(), noon - 29 * 86400.0);
    }

    void timeOfDayInLocalTime() {
        const QByteArray zone = qgetenv("TZ");
        qputenv("TZ", "Europe/Berlin");
        tzset();
        if (QTimeZone::isTimeZoneIdAvailable("Europe/Berlin")) {
            // Clocks go forward at 2026-03-29 2:00: the day has 23 hours.
            DayTime six(QTime(6, 0), false, utc("2026-03-28T00:00:00Z"));
            QCOMPARE(six.next(), utc("2026-03-28T05:00:00Z"));
            QVERIFY(six.judge(six.next()).fires);
            QCOMPARE(six.next(), utc("2026-03-29T04:00:00Z"));
            // A time that this day has not: the hour after it.
            DayTime halfPastTwo(QTime(2, 30), false, utc("2026-03-28T12:00:00Z"));
            QVERIFY(std::abs(halfPastTwo.next() - utc("2026-03-29T01:30:00Z")) <= 3600);
            QVERIFY(halfPastTwo.judge(halfPastTwo.next()).fires);
            QCOMPARE(halfPastTwo.next(), utc("2026-03-30T00:30:00Z"));
        }
        zone.isNull() ? qunsetenv("TZ") : qputenv("TZ", zone);
        tzset();
    }

    void scheduleStaysOnItsGrid() {
        Schedule schedule;
        const auto start = Schedule::Clock::now();
        std::vector<Schedule::Due> calls;
        quint64 missed = 0;
        schedule.add(std::chrono::milliseconds(10), [&](const Schedule::Due &due) {
            calls.push_back(due);
            missed += due.missed;
            QVERIFY(Schedule::Clock::now() >= due.time);
        });
        QTRY_VERIFY(calls.size() >= 50);
        for (const Schedule::Due &due : calls) {
            const auto t0 = due.time - std::chrono::milliseconds(10) * qint64(due.n);
            QVERIFY(t0 == calls[0].time - std::chrono::milliseconds(10) * qint64(calls[0].n));
            QVERIFY(t0 >= start);
        }
        QCOMPARE(calls.back().n, calls.size() + missed); // none is lost silently
    }

    void scheduleCountsWhatItMissed() {
        Schedule schedule;
        std::vector<Schedule::Due> calls;
        schedule.add(std::chrono::milliseconds(10), [&](const Schedule::Due &due) { calls.push_back(due); });
        QTRY_VERIFY(calls.size() >= 2);
        const quint64 before = calls.back().n;
        const size_t count = calls.size();
        std::this_thread::sleep_for(std::chrono::milliseconds(205)); // the main thread is busy
        QCoreApplication::processEvents();
        QVERIFY(calls.size() > count);
        QVERIFY(calls.size() <= count + 2); // no burst
        QVERIFY(calls[count].missed >= 18);
        QCOMPARE(calls[count].n, before + calls[count].missed + 1);
    }

    void scheduleCanBeChangedFromItsFunctions() {
        Schedule schedule;
        int once = 0, other = 0;
        quint64 key = 0;
        key = schedule.add(std::chrono::milliseconds(5), [&](const Schedule::Due &) {
            ++once;
            schedule.remove(key);
            schedule.add(std::chrono::milliseconds(5), [&](const Schedule::Due &) { ++other; });
        });
        QTRY_VERIFY(other >= 3);
        QCOMPARE(once, 1);
    }

    void logNeverOverwrites() {
        QTemporaryDir folder;
        for (int i = 0; i < 20; ++i) {
            FiringLog log(folder.filePath("made/here"), 1e6, "head\n");
            log.append("row " + QByteArray::number(i) + "\n");
        }
        QByteArray all;
        const QDir made(folder.filePath("made/here"));
        const QStringList files = made.entryList(QDir::Files);
        QCOMPARE(files.size(), 20);
        for (const QString &name : files) {
            const QByteArray content = contentOf(made.filePath(name));
            QVERIFY2(content.startsWith("head\nrow ") && content.count('\n') == 2, content.constData());
            all += content;
        }
        for (int i = 0; i < 20; ++i)
            QVERIFY(all.contains("row " + QByteArray::number(i) + "\n"));
        QCOMPARE(csvField("a,\"b\""), QByteArray("\"a,\"\"b\"\"\""));
        QCOMPARE(csvField("plain"), QByteArray("plain"));
    }

    void logGoesOnInNewFiles() {
        QTemporaryDir folder;
        FiringLog log(folder.path(), 100, "head\n");
        for (int i = 0; i < 40; ++i)
            log.append("0123456789012345678\n"); // 20 bytes: 4 beside the header
        log.flush();
        QCOMPARE(log.state().rows, quint64(40));
        const QFileInfoList files = QDir(folder.path()).entryInfoList(QDir::Files);
        QCOMPARE(files.size(), 10);
        for (const QFileInfo &file : files)
            QCOMPARE(file.size(), 85);
    }

    void logThatIsRemovedBeginsAnew() {
        QTemporaryDir folder;
        FiringLog log(folder.filePath("log"), 1e6, "head\n");
        log.append("row 1\n");
        log.flush();
        QVERIFY(QDir(folder.filePath("log")).removeRecursively());
        log.append("row 2\n");
        log.flush();
        QCOMPARE(log.state().rows, quint64(2));
        QCOMPARE(contentOf(log.state().path), QByteArray("head\nrow 2\n"));
    }

    void logCountsWhatTheDiskRefuses() {
        QTemporaryDir folder;
        QFile(folder.filePath("file")).open(QIODevice::WriteOnly);
        FiringLog log(folder.filePath("file"), 1e6, "head\n"); // a file where the folder should be
        log.append("row\n");
        log.append("row\n");
        log.flush();
        QCOMPARE(log.state().lost, quint64(2));
        QVERIFY(log.state().error.contains(folder.path()));
        QVERIFY(QFile::remove(folder.filePath("file")));
        log.append("row\n");
        log.flush();
        QCOMPARE(log.state().rows, quint64(1));
        QCOMPARE(log.state().error, QString());
    }

    void jitterOfTheLastThousand() {
        JitterWindow window;
        QVERIFY(window.summary().count == 0 && !window.summary().mean_s);
        for (int i = 0; i < 500; ++i)
            window.add(100); // leaves the window
        for (int i = 1; i <= 1000; ++i)
            window.add(i);
        const Jitter jitter = window.summary();
        QVERIFY(jitter.count == 1000 && *jitter.mean_s == 500.5 && *jitter.p99_s == 990 &&
                *jitter.worst_s == 1000);
    }
};
