// Whatever is asked of the scan matcher while it closes loops: each command is answered, all that it tells of
// map and drive is of one piece, and a map that is begun anew is as good as one that nobody disturbed.
#include "RingDrive.h"

using namespace hermes;

class TestLiveCommands : public QObject, RingDrive {
    Q_OBJECT
private Q_SLOTS:
    void init() {
        begin();
        listenToMap();
        asked = answered = graphGaps = mapGaps = 0;
    }

    void cleanup() { tearDown(); }

    void anyCommandAtAnyTime_data() {
        const Rows<unsigned> row("seed");
        unsigned seed = newSeed();
        const int trials = std::max(1, qEnvironmentVariableIntValue("HERMES_TRIALS"));
        for (int trial = 0; trial < trials; ++trial, ++seed)
            row(qPrintable(QString("HERMES_SEED=%1").arg(seed)), seed);
    }

    void anyCommandAtAnyTime() {
        QFETCH(unsigned, seed);
        drawn.seed(seed);
        const std::size_t last = 60; // scans that nobody disturbs
        const int rarely = 3 + draw(60);
        for (std::size_t i = 0; i < way.size() - last; ++i) {
            tell(i);
            QDeadlineTimer timeout(draw(4) == 0 ? 0 : 10 * slowness);
            while (poses.count(int(i)) == 0 && !timeout.hasExpired())
                QCoreApplication::processEvents();
            for (int more = draw(rarely) == 0 ? 1 + draw(3) : 0; more > 0; --more)
                askAny(i);
        }
        QTRY_COMPARE_WITH_TIMEOUT(answered, asked, 60000);

        set("matcher", "close_loops", true);
        set("matcher", "remember_mb", 300);
        set("matcher", "sigma_m", 0.02);
        set("source", "queue", 50);
        set("odometry", "address", QString("127.0.0.1:%1").arg(sourcePort));
        ask("matcher.start", {{"mode", "mapping"}});
        QTRY_COMPARE_WITH_TIMEOUT(answered, asked, 60000);
        QTRY_VERIFY(source->hasSubscribers("odometry"));
        waitForCorrector();
        const QJsonObject state = call("matcher.state");
        const QJsonObject map = call("map.get");
        qInfo("%d commands, %d scans since the last map began, %d corrections, %d key scans, %d walls", asked,
              state["scans"].toInt(), state["corrections"].toInt(), state["key_scans"].toInt(),
              state["map_segments"].toInt());
        QCOMPARE(map["size"].toInt(), state["map_segments"].toInt());
        QCOMPARE(mapGaps, 0);
        QTRY_COMPARE(int(edges.size()), map["size"].toInt());
        for (const QJsonValue &edge : map["edges"].toArray())
            QCOMPARE(edges[edge["id"].toInt()], edge);
        QCOMPARE(graphGaps, 0);
        QTRY_COMPARE(graphPoses.size(), state["key_scans"].toInt());

        const std::size_t first = way.size() - last;
        call("map.clear");
        call("pose.set", {{"x", way[first].x}, {"y", way[first].y}, {"theta", way[first].theta}});
        drive(first, way.size());
        const double end = distance(poseOf(poses.rbegin()->second), way.back());
        qInfo("end %.3f m off", end);
        QVERIFY2(end < 0.30, saying(end));
        waitForCorrector();
        const QJsonObject after = call("matcher.state");
        QCOMPARE(call("map.get")["size"].toInt(), after["map_segments"].toInt());
        QTRY_COMPARE(graphPoses.size(), after["key_scans"].toInt());
        QVERIFY(after["key_scans"].toInt() > 0);
    }

private:
    void listenToMap() {
        edges.clear();
        revision = 0;
        client_->subscribe("map", {{"queue", 10000}}, [this](const TopicUpdate &update) {
            const QJsonObject change = update.json().toObject();
            if (change["cleared"].toBool())
                edges.clear();
            else
                mapGaps += change["revision"].toInt() > revision + 1;
            revision = change["revision"].toInt();
            for (const QJsonValue &id : change["removed"].toArray())
                edges.erase(id.toInt());
            for (const QJsonValue &edge : change["edges"].toArray())
                edges[edge["id"].toInt()] = edge;
        });
        client_->subscribe("graph", {{"queue", 10000}}, [this](const TopicUpdate &update) {
            graphGaps += update.json()["first"].toInt() > graphPoses.size(); // listen() took it before
        });
    }

    void ask(const QString &method, const QJsonObject &params = {}) {
        ++asked;
        client_->call(
            method, params,
            [this, method](const Result<QJsonValue> &result) {
                ++answered;
                if (result.ok())
                    return;
                qInfo("%s: %s", qPrintable(method), qPrintable(result.error().message));
                QVERIFY(result.error().code != int(ErrorCode::InternalError));
            },
            std::chrono::seconds(30) * slowness);
    }

    void set(const QString &group, const QString &name, const QJsonValue &value) {
        ask("settings.set", {{"values", QJsonObject{{group, QJsonObject{{name, value}}}}}});
    }

    void askAny(std::size_t i) {
        switch (draw(5)) {
        case 0:
            return ask("matcher.stop");
        case 1:
        case 2:
            return ask("matcher.start", {{"mode", draw(3) == 0 ? "localization" : "mapping"}});
        case 3:
            return askForSetting();
        default:
            return askForMap(i);
        }
    }

    void askForMap(std::size_t i) {
        switch (draw(8)) {
        case 0:
            return ask("map.clear");
        case 1:
            return ask("map.save", {{"path", "some.csv"}, {"force", true}});
        case 2:
            return ask("map.load", {{"path", "some.csv"}});
        case 3:
            return ask("map.load", {{"path", "drive.journal"}}); // into which it writes
        case 4:
            return ask("map.export", {{"path", "some.svg"}, {"format", "svg"}, {"force", true}});
        case 5: {
            const double off = draw(3) == 0 ? 20 : 0.1;
            return ask("pose.set", {{"x", way[i].x + off}, {"y", way[i].y - off}, {"theta", way[i].theta}});
        }
        case 6:
            return ask("pose.relocalize", {{"apply", draw(2) == 0}});
        default:
            return ask("map.get");
        }
    }

    void askForSetting() {
        switch (draw(6)) {
        case 0:
            return set("matcher", "close_loops", draw(2) == 0);
        case 1:
            return set("matcher", "remember_mb", draw(2) == 0 ? 0.3 : 300);
        case 2:
            return set("source", "queue", draw(2) == 0 ? 1 : 50);
        case 3:
            return set("odometry", "address",
                       draw(2) == 0 ? QString() : QString("127.0.0.1:%1").arg(sourcePort));
        case 4:
            return set("matcher", "sigma_m", 0.01 * (1 + draw(3)));
        default:
            return set("matcher", "relocalize_after", draw(3));
        }
    }

    int draw(int count) { return int(drawn() % unsigned(count)); }

    std::mt19937 drawn;
    int asked = 0, answered = 0, graphGaps = 0, mapGaps = 0;
    std::map<qint64, QJsonValue> edges; // of the topic map
    qint64 revision = 0;
};
