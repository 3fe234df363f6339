#include "gui/desktop/panels/LogPanel.h"
#include "gui/desktop/panels/MapPanel.h"
#include "tests/gui/desktop/FakeDaemon.h"
#include "tests/gui/desktop/OpenWindow.h"
#include "tests/support/ThreadTime.h"

using namespace hermes;

/// The topic graph in parts, along a spiral; corrected: turned a little.
static std::vector<QByteArray> longDrive(int revision, int keyScans, double turn) {
    constexpr int part = 1000;
    std::vector<QByteArray> messages;
    for (int first = 0; first < keyScans; first += part) {
        QByteArray poses, trust, loops;
        for (int i = first; i < first + part; ++i) {
            const char *const comma = i > first ? "," : "";
            const double angle = 0.02 * i + turn, radius = 5 + 45.0 * i / keyScans;
            poses += saying("%1[%2,%3,%4]", comma, radius * std::cos(angle), radius * std::sin(angle),
                            std::remainder(angle, 2 * M_PI));
            trust += comma + QByteArray::number(1 - double(i) / keyScans);
            if (i % 10 == 0 && i > 1000)
                loops += saying("%1{\"from\":%2,\"to\":%3,\"weight\":%4}", loops.isEmpty() ? "" : ",",
                                i - 314, i, i % 100 == 0 ? 0.1 : 0.9);
        }
        messages.push_back(saying("{\"revision\":%1,\"cleared\":%2,\"first\":%3,\"size\":%4,\"poses\":[",
                                  revision, first == 0 ? "true" : "false", first, keyScans) +
                           poses + "],\"trust\":[" + trust + "],\"loops\":[" + loops + "]}");
    }
    return messages;
}

/// Short walls among them.
static std::vector<QByteArray> manyWalls(int revision, int edges) {
    constexpr int part = 1000;
    std::vector<QByteArray> messages;
    for (int first = 0; first < edges; first += part) {
        QByteArray list;
        for (int i = first; i < first + part; ++i) {
            const double x = std::fmod(i * 61.803398875, 100) - 50, y = std::fmod(i * 7.548776662, 100) - 50;
            list += saying("%1{\"id\":%2,\"x1\":%3,\"y1\":%4,\"x2\":%5,\"y2\":%6}", i > first ? "," : "", i,
                           x, y, x + std::cos(i), y + std::sin(i));
        }
        messages.push_back(saying("{\"revision\":%1,\"cleared\":%2,\"removed\":[],\"size\":%3,\"edges\":[",
                                  revision, first == 0 ? "true" : "false", edges) +
                           list + "]}");
    }
    return messages;
}

/// How fast the window is: bounds that hold on a busy machine; each figure is a line "figure NAME VALUE
/// UNIT".
class TestSpeed : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void framesOfALargeMap() {
        RobotProcesses robot;
        robot.start("mapsource");
        OpenWindow open(robot);
        QVERIFY(open.show());
        MapView &view = open.window.findChild<MapPanel *>()->view();
        const MapModel &model = open.window.findChild<MapPanel *>()->model();
        QTRY_COMPARE_WITH_TIMEOUT(model.edges().size(), 20000, 10000);
        QTRY_COMPARE(model.scan().size(), 2000);
        view.fit(); // all of it is in sight
        QElapsedTimer whole, one;
        std::vector<double> frames_ms;
        int painted = 0;
        for (whole.start(); whole.elapsed() < 3000; ++painted) {
            one.start();
            view.repaint();
            frames_ms.push_back(double(one.nsecsElapsed()) * 1e-6);
            QCoreApplication::processEvents(); // and what arrives meanwhile
        }
        const double rate = painted / (double(whole.elapsed()) / 1000);
        figure("frames, 20,000 edges and 2,000 points at 10 Hz", rate, "a second");
        figure("a frame of it, median", median(frames_ms), "ms");
        QVERIFY2(rate > 15.0 / slowness, saying(rate));
    }

    void framesOfALongDrive() {
        // Before the link stands: it would be lost while nobody answers.
        const auto walls = manyWalls(1, 20000), drive = longDrive(1, 50000, 0);
        const int edges = Glide::maxEdges, keyScans = Glide::maxKeyScans;
        const auto fewer = manyWalls(2, edges), same = manyWalls(3, edges);
        const auto bent = longDrive(2, keyScans, 0), corrected = longDrive(3, keyScans, 0.05);
        FakeDaemon daemon{Mischief{}};
        Fleet fleet;
        MapPanel panel(fleet);
        panel.resize(1280, 720);
        panel.show();
        fleet.add(daemon.address());
        for (const char *const topic : {"map", "graph", "pose"})
            QTRY_VERIFY(daemon.subscriptions(topic) > 0);
        const auto sayAll = [&](const std::vector<QByteArray> &map, const std::vector<QByteArray> &graph,
                                const QByteArray &pose) {
            for (const QByteArray &message : map)
                daemon.say("map", message);
            for (const QByteArray &message : graph)
                daemon.say("graph", message);
            daemon.say("pose", pose);
        };
        sayAll(walls, drive, R"({"x":50,"y":0,"theta":0,"covariance":null,"outcome":"matched","trust":1})");
        const MapModel &model = panel.model();
        QTRY_COMPARE_WITH_TIMEOUT(model.graph().size(), 50000, 20000);
        QTRY_VERIFY(model.edges().size() == 20000 && model.pose());
        MapView &view = panel.view();
        view.fit();
        const auto frame_ms = [&] {
            std::vector<double> times;
            for (int i = 0; i < 20; ++i) {
                const double before = threadTime_ms();
                view.repaint();
                times.push_back(threadTime_ms() - before);
            }
            return median(times);
        };
        view.layers().loops = false;
        figure("a frame, 20,000 edges", frame_ms(), "ms of the processor");
        view.layers().loops = view.layers().graph = view.layers().trust = true;
        const double all = frame_ms();
        figure("a frame, 20,000 edges, 50,000 key scans, graph, loops and trust", all, "ms of the processor");
        QVERIFY2(all < 200 * slowness, saying(all));

        // The largest map that moves.
        sayAll(fewer, bent, R"({"x":50,"y":0,"theta":0,"covariance":null,"outcome":"matched","trust":1})");
        QTRY_VERIFY_WITH_TIMEOUT(model.graph().size() == keyScans && model.edges().size() == edges, 20000);
        QTRY_VERIFY(!model.isGliding());
        int pictures = 0;
        connect(&model, &MapModel::changed, &view,
                [&] { pictures += model.shownPose()->y > 0.01 && model.isGliding(); });
        sayAll(
            same, corrected,
            R"({"x":50,"y":2,"theta":0,"covariance":null,"outcome":"matched","trust":1,"corrected":true})");
        LoopWatch watch;
        QTRY_VERIFY_WITH_TIMEOUT(model.correction_m() && !model.isGliding(), 20000);
        figure("a corrected map, 10,000 edges and 20,000 key scans, moves in", pictures, "pictures");
        figure("event loop busy at most, it arrives and moves", watch.longestCpu_ms(), "ms of the processor");
        QVERIFY2(watch.longestCpu_ms() < 200 * slowness, saying(watch.longestCpu_ms()));
    }

    void largeMapArrivesWhole() {
        RobotProcesses robot;
        robot.start("mapsource", {"edges=100000", "rate_hz=50"});
        OpenWindow open(robot);
        QVERIFY(open.show());
        LoopWatch watch;
        const MapModel &model = open.window.findChild<MapPanel *>()->model();
        QTRY_COMPARE_WITH_TIMEOUT(model.edges().size(), 100000, 20000);
        QVERIFY(model.isWhole());
        figure("event loop busy at most, a map of 100,000 edges arrives", watch.longestCpu_ms(),
               "ms of the processor");
        MapView &view = open.window.map().view();
        view.fit(); // all of it is in sight
        std::vector<double> frames_ms;
        for (int i = 0; i < 20; ++i) {
            const double before = threadTime_ms();
            view.repaint();
            frames_ms.push_back(threadTime_ms() - before);
        }
        figure("a frame, 100,000 edges, median", median(frames_ms), "ms of the processor");
        QVERIFY2(median(frames_ms) < 120 * slowness, saying(median(frames_ms)));
    }

    void daemonThatDoesNotAnswer() {
        RobotProcesses robot;
        robot.start("mapsource");
        const quint16 silent = robot.start("scanmatcher");
        OpenWindow open(robot);
        QVERIFY(open.show());
        QVERIFY(open.choose(open.fleet.robot()->withName("scanmatcher")));
        QTest::qWait(500);                    // until what it shows has settled
        robot.signal("scanmatcher", SIGSTOP); // its connection stays open
        LoopWatch watch;
        open.window.findChild<QPushButton *>("save")->click();
        for (auto *const dock : open.window.findChildren<QDockWidget *>()) {
            dock->raise();
            QTest::qWait(300);
        }
        QVERIFY(open.fleet.add(QString("127.0.0.1:%1").arg(silent)).ok());
        figure("event loop busy at most, a daemon does not answer", watch.longestCpu_ms(),
               "ms of the processor");
        figure("the same on the clock", watch.longest_ms(), "ms");
        robot.signal("scanmatcher", SIGCONT);
        QVERIFY2(watch.longestCpu_ms() < 50 * slowness, saying(watch.longestCpu_ms()));
        QVERIFY2(watch.longest_ms() < 1000 * slowness, saying(watch.longest_ms()));
    }

    void daemonThatFloods() {
        RobotProcesses robot;
        robot.start("mapsource", {"edges=200", "rate_hz=1000", "records=10"}); // as fast as it can
        OpenWindow open(robot);
        QVERIFY(open.show());
        auto *const records = open.panel<LogPanel>("log")->findChild<QPlainTextEdit *>("records");
        QTRY_VERIFY(records->toPlainText().contains("record"));
        LoopWatch watch;
        QTest::qWait(3000);
        figure("event loop busy at most, a daemon floods log, map and poses", watch.longestCpu_ms(),
               "ms of the processor");
        figure("the same on the clock", watch.longest_ms(), "ms");
        QVERIFY2(watch.longestCpu_ms() < 50 * slowness, saying(watch.longestCpu_ms()));
    }

    // Usable: the event loop runs, which is when the first request goes out; the window was shown before.
    void start() {
        std::vector<double> times_s;
        for (int i = 0; i < 5; ++i) {
            QTcpServer daemon;
            QVERIFY(daemon.listen(QHostAddress::LocalHost));
            ChildProcess program;
            QTemporaryDir folder;
            auto time = runningTimer();
            program.start(qEnvironmentVariable("HERMES_BIN") + "/hermes-gui",
                          {"--connect", QString("127.0.0.1:%1").arg(daemon.serverPort()), "--layout",
                           folder.filePath("gui.json")});
            QVERIFY(daemon.waitForNewConnection(10000));
            QTcpSocket *const client = daemon.nextPendingConnection();
            QVERIFY(client->waitForReadyRead(10000));
            times_s.push_back(double(time.elapsed()) / 1000);
            program.terminate();
            QVERIFY(program.waitForFinished());
        }
        figure("start to usable window", median(times_s), "s");
        const double least = *std::min_element(times_s.begin(), times_s.end());
        QVERIFY2(least < slowness, saying(least));
    }

    // As many poses and changes of the map as in an hour at 10 Hz, as fast as they come.
    void memoryOfAnHour() {
        RobotProcesses robot;
        const int messages = qEnvironmentVariableIntValue("HERMES_HOUR") ? 36000 : 3600;
        const quint16 port = robot.start("mapsource", {"rate_hz=1000", "points=100"});
        ChildProcess program;
        program.start(qEnvironmentVariable("HERMES_BIN") + "/hermes-gui",
                      {"--connect", QString("127.0.0.1:%1").arg(port), "--layout", robot.path("gui.json")});
        QVERIFY(program.waitForStarted());
        ConnectedClient client(QString("127.0.0.1:%1").arg(port));
        quint64 seen = 0;
        client.subscribe("pose", {{"max_rate_hz", 10}},
                         [&seen](const TopicUpdate &update) { seen = update.seq; });
        QTRY_VERIFY_WITH_TIMEOUT(seen > quint64(messages), 300000);
        double resident_mb = 0;
        for (const QByteArray &line :
             contentOf(QString("/proc/%1/status").arg(program.processId())).split('\n'))
            if (line.startsWith("VmHWM:"))
                resident_mb = line.mid(6).trimmed().split(' ')[0].toDouble() * 1024 / 1e6;
        figure(messages == 36000 ? "memory at most, an hour of a map at 10 Hz"
                                 : "memory at most, six minutes",
               resident_mb, "MB");
        QVERIFY2(resident_mb > 10 && resident_mb < 150 * slowness, saying(resident_mb));
        program.terminate();
        QVERIFY(program.waitForFinished());
    }

private:
    static void figure(const char *name, double value, const char *unit) {
        qInfo("figure %s: %.3g %s", name, value, unit);
    }
    static double median(std::vector<double> values) {
        std::sort(values.begin(), values.end());
        return values[values.size() / 2];
    }
};
