// The scan matcher with two scanners on the robot: one looks ahead, one back.
#include "MatcherFixture.h"

using namespace hermes;
using vectorlib::Pose2D;

class TestMatcherScanners : public QObject, MatcherFixture {
    Q_OBJECT
private Q_SLOTS:
    void init() {
        setUp();
        second = std::make_unique<ScanSource>();
        launch(*second, {"limits.topic_bytes=100000000"}, "tcp://127.0.0.1:0");
        set("sensor", {{"x_m", 0.2}});
        set("sensor2", {{"x_m", -0.2}, {"theta_rad", vectorlib::pi}});
        set("source2", {{"address", second->server().addresses().value(0)}});
        QTRY_VERIFY(second->hasSubscribers("scan2d"));
        sent = sent2 = 0;
        late_s = 0.04;
        isMirrored = isReplayed = hasWrongTimes = false;
    }
    void cleanup() {
        tearDown();
        second->shutDown();
        second.reset();
    }

    void bothAreTaken_data() { falseAndTrue("upsideDown", "upright", "upside down"); }
    void bothAreTaken() {
        QFETCH(bool, upsideDown);
        set("sensor", {{"upside_down", upsideDown}});
        set("sensor2", {{"upside_down", upsideDown}});
        isMirrored = upsideDown;
        run(1);
        QVERIFY(health().contains("not used yet"));
        QCOMPARE(healthItem("source2")["level"].toString(), QString("warn"));
        run(29);
        QCOMPARE(state()["use"].toString(), QString("taken"));
        QVERIFY2(health().contains("of its scans were taken"), qPrintable(health()));
        QCOMPARE(healthItem("source2")["level"].toString(), QString("ok"));
        QCOMPARE(state()["paired"].toInt(), 30);
        QCOMPARE(call("matcher.state")["matched"].toInt(), 30);
        QCOMPARE(call("map.get")["edges"].toArray().size(), 6);
        QCOMPARE(call("matcher.state")["sources"].toArray()[0].toObject()["scans"].toInt(), 30);
    }

    void silentOneIsTold() {
        run(20);
        QCOMPARE(state()["use"].toString(), QString("taken"));
        QElapsedTimer since;
        since.start();
        while (healthItem("source2")["level"].toString() == "ok" && since.elapsed() < 5000) {
            publish(*source, {0.2, 0, 0}); // as its cable is pulled
            ++sent;
            QTRY_COMPARE(call("matcher.state")["scans"].toInt(), sent);
        }
        QVERIFY2(since.elapsed() < 2000, qPrintable(QString::number(since.elapsed())));
        QVERIFY2(health().contains("no scan from") && health().contains("the first scanner is matched alone"),
                 qPrintable(health()));
        QVERIFY(state()["age_s"].toDouble() > 0.9);
        QCOMPARE(call("matcher.state")["matched"].toInt(), sent);
        const int paired = state()["paired"].toInt();
        sent2 = state()["scans"].toInt();
        run(3);
        QCOMPARE(healthItem("source2")["level"].toString(), QString("ok"));
        QCOMPARE(state()["paired"].toInt(), paired + 3);
    }

    void secondGoesOnAlone_data() {
        falseAndTrue("replayed", "live", "not in a replay, which may be paused");
    }
    void secondGoesOnAlone() {
        QFETCH(bool, replayed);
        isReplayed = replayed;
        run(20);
        const auto silence_s = [this] {
            return call("matcher.state")["sources"].toArray()[0].toObject()["age_s"].toDouble();
        };
        QTRY_VERIFY(silence_s() > 0.5); // of the first
        for (int i = 0; i < 5; ++i) {
            publish(*second, {-0.2, 0, vectorlib::pi});
            sent += !replayed;
            QTRY_COMPARE(state()["scans"].toInt(), sent2 + i + 1);
            QTRY_COMPARE(call("matcher.state")["scans"].toInt(), sent);
        }
        QCOMPARE(call("matcher.state")["matched"].toInt(), sent);
        sent2 = state()["scans"].toInt();
        publish(*source, {0.2, 0, 0});
        ++sent;
        QTRY_COMPARE(call("matcher.state")["scans"].toInt(), sent);
        run(3);
        QCOMPARE(call("matcher.state")["matched"].toInt(), sent);
        QCOMPARE(call("matcher.state")["place"].toString(), QString("known"));
    }

    void scansOfAnotherTimeAreLeftOut() {
        late_s = 1;
        run(5);
        QCOMPARE(state()["apart"].toInt(), 5);
        QCOMPARE(state()["paired"].toInt(), 0);
        QVERIFY2(health().contains("1.00 s older"), qPrintable(health()));
        QCOMPARE(call("matcher.state")["matched"].toInt(), 5);
        late_s = 0.04;
        run(20);
        QCOMPARE(state()["use"].toString(), QString("taken"));
    }

    // What is wrong now goes before what was.
    void oneThatWasRefusedHidesNothing() {
        second->publish("scan2d", QJsonObject{{"stamp", "now"}}, 1);
        late_s = 1;
        run(5);
        QVERIFY2(health().contains("1.00 s older"), qPrintable(health()));
        late_s = 0.04;
        run(20);
        QVERIFY2(health().contains("refused 1 scans") && health().contains("were taken"),
                 qPrintable(health()));
    }

    void wrongMountIsTold() {
        set("sensor2", {{"theta_rad", vectorlib::pi - 0.17}});
        run(20);
        QCOMPARE(state()["use"].toString(), QString("contradicted"));
        QCOMPARE(healthItem("source2")["level"].toString(), QString("warn"));
        QVERIFY2(health().contains("they contradict the map") &&
                     health().contains("fits x -0.20 m, y 0.00 m, theta"),
                 qPrintable(health()));
        QCOMPARE(call("map.get")["edges"].toArray().size(), 5); // not what is behind
        set("sensor2", {{"theta_rad", vectorlib::pi}});
        run(15);
        QCOMPARE(state()["use"].toString(), QString("taken"));
        QCOMPARE(call("map.get")["edges"].toArray().size(), 6);
    }

    void timesOutOfOrderAreTold() {
        hasWrongTimes = true;
        run(20);
        QCOMPARE(state()["use"].toString(), QString("contradicted"));
        QVERIFY2(health().contains("its stamps or t are wrong"), qPrintable(health()));
        QCOMPARE(call("matcher.state")["matched"].toInt(), 20);
        QCOMPARE(call("map.get")["edges"].toArray().size(), 5); // not what is behind
    }

private:
    void set(const QString &group, const QJsonObject &values) {
        call("settings.set", {{"values", QJsonObject{{group, values}}}});
    }
    QJsonObject state() { return call("matcher.state")["sources"].toArray()[1].toObject(); }
    QString health() { return healthItem("source2")["message"].toString(); }
    // What the scanner at that mount sees ahead and a bit to the sides, when the robot is where its next scan
    // is due.
    void publish(ScanSource &to, const Pose2D &mount, double late = 0) {
        const double stamp = 1 + 0.1 * sent - late;
        QJsonObject scan = roomScan(robotAt(stamp) * mount, stamp);
        QJsonArray x, y, t;
        for (int i = 0; i < 1000; ++i)
            if (std::cos(2 * vectorlib::pi * i / 1000) > -0.4) {
                x.append(scan["x"].toArray()[i]);
                t.append(0.08 * (i % 2));
                y.append((isMirrored ? -1 : 1) * scan["y"].toArray()[i].toDouble());
            }
        scan["x"] = x;
        scan["y"] = y;
        if (hasWrongTimes && &to == second.get())
            scan["t"] = t;
        scan["rays"] = 1000;
        scan["replayed"] = isReplayed;
        to.publish("scan2d", scan, stamp);
    }
    static Pose2D robotAt(double stamp) {
        const double i = 10 * (stamp - 1);
        return {-1.5 + 0.05 * i, -0.5 + 0.02 * i, 0.03 * i};
    }
    void run(int scans) {
        for (int end = sent + scans; sent < end;) {
            publish(*second, {-0.2, 0, vectorlib::pi}, late_s);
            ++sent2;
            QTRY_COMPARE(state()["scans"].toInt(), sent2);
            publish(*source, {0.2, 0, 0});
            ++sent;
            QTRY_COMPARE(call("matcher.state")["scans"].toInt(), sent);
        }
    }

    std::unique_ptr<ScanSource> second;
    int sent = 0, sent2 = 0;
    double late_s = 0.04;
    bool isMirrored = false, isReplayed = false, hasWrongTimes = false;
};
