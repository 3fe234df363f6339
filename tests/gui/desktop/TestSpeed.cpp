#include "gui/desktop/panels/LogPanel.h"
#include "gui/desktop/panels/MapPanel.h"
#include "tests/gui/desktop/OpenWindow.h"
#include "tests/support/LoopWatch.h"
#include "tests/support/Patience.h"

#include <QPlainTextEdit>
#include <QTcpServer>
#include <QTcpSocket>
#include <csignal>

using namespace hermes;
using namespace hermes::desktop;

/// How fast the window is: bounds that hold on a busy machine; each figure is a line "figure NAME VALUE
/// UNIT".
class TestSpeed : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void framesOfALargeMap();
    void largeMapArrivesWhole();
    void daemonThatDoesNotAnswer();
    void daemonThatFloods();
    void start();
    void memoryOfAnHour();

private:
    static void figure(const char *name, double value, const char *unit) {
        qInfo("figure %s: %.3g %s", name, value, unit);
    }
    static double median(std::vector<double> values) {
        std::sort(values.begin(), values.end());
        return values[values.size() / 2];
    }
};

void TestSpeed::framesOfALargeMap() {
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
    QVERIFY2(rate > 15, qPrintable(QString::number(rate)));
}

void TestSpeed::largeMapArrivesWhole() {
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
}

void TestSpeed::daemonThatDoesNotAnswer() {
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
    figure("event loop busy at most, a daemon does not answer", watch.longestCpu_ms(), "ms of the processor");
    figure("the same on the clock", watch.longest_ms(), "ms");
    robot.signal("scanmatcher", SIGCONT);
    QVERIFY2(watch.longestCpu_ms() < 50, qPrintable(QString::number(watch.longestCpu_ms())));
    QVERIFY2(watch.longest_ms() < 1000, qPrintable(QString::number(watch.longest_ms())));
}

void TestSpeed::daemonThatFloods() {
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
    QVERIFY2(watch.longestCpu_ms() < 50, qPrintable(QString::number(watch.longestCpu_ms())));
}

// Usable: the event loop runs, which is when the first request goes out; the window was shown before.
void TestSpeed::start() {
    std::vector<double> times_s;
    for (int i = 0; i < 5; ++i) {
        QTcpServer daemon;
        QVERIFY(daemon.listen(QHostAddress::LocalHost));
        ChildProcess program;
        QTemporaryDir folder;
        QElapsedTimer time;
        time.start();
        program.start(qEnvironmentVariable("HERMES_BIN") + "/hermes-gui",
                      {"--connect", QString("127.0.0.1:%1").arg(daemon.serverPort()), "--layout",
                       folder.filePath("gui.ini")});
        QVERIFY(daemon.waitForNewConnection(10000));
        QTcpSocket *const client = daemon.nextPendingConnection();
        QVERIFY(client->waitForReadyRead(10000));
        times_s.push_back(double(time.elapsed()) / 1000);
        program.terminate();
        QVERIFY(program.waitForFinished());
    }
    figure("start to usable window", median(times_s), "s");
    const double least = *std::min_element(times_s.begin(), times_s.end());
    QVERIFY2(least < 1, qPrintable(QString::number(least)));
}

// As many poses and changes of the map as in an hour at 10 Hz, as fast as they come.
void TestSpeed::memoryOfAnHour() {
    RobotProcesses robot;
    const int messages = qEnvironmentVariableIntValue("HERMES_HOUR") ? 36000 : 3600;
    const quint16 port = robot.start("mapsource", {"rate_hz=1000", "points=100"});
    ChildProcess program;
    program.start(qEnvironmentVariable("HERMES_BIN") + "/hermes-gui",
                  {"--connect", QString("127.0.0.1:%1").arg(port), "--layout", robot.path("gui.ini")});
    QVERIFY(program.waitForStarted());
    Client client;
    client.connectTo(QString("127.0.0.1:%1").arg(port));
    QVERIFY(client.waitConnected().ok());
    quint64 seen = 0;
    client.subscribe("pose", {{"max_rate_hz", 10}},
                     [&seen](const TopicUpdate &update) { seen = update.seq; });
    QTRY_VERIFY_WITH_TIMEOUT(seen > quint64(messages), 300000);
    QFile status(QString("/proc/%1/status").arg(program.processId()));
    QVERIFY(status.open(QIODevice::ReadOnly));
    double resident_mb = 0;
    for (const QByteArray &line : status.readAll().split('\n'))
        if (line.startsWith("VmHWM:"))
            resident_mb = line.mid(6).trimmed().split(' ')[0].toDouble() * 1024 / 1e6;
    figure(messages == 36000 ? "memory at most, an hour of a map at 10 Hz" : "memory at most, six minutes",
           resident_mb, "MB");
    QVERIFY2(resident_mb > 10 && resident_mb < 150 * slowness, qPrintable(QString::number(resident_mb)));
    program.terminate();
    QVERIFY(program.waitForFinished());
}

QTEST_MAIN(TestSpeed)
#include "TestSpeed.moc"
