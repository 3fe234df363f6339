// How fast hermes-motorcontrol stops the wheels, as processes: a client or the daemon itself is killed or
// frozen. $HERMES_TRIALS trials of each, 3 where it is not set; the times are printed.
#include "RoboClawRig.h"
#include "common/client/Client.h"

#include <QProcess>
#include <QRegularExpression>
#include <QTemporaryDir>
#include <QtTest>

#include <csignal>

using namespace hermes;

namespace {

// Drives at 20 Hz and prints when it sent each command, in seconds of the monotonic clock.
const char *const driver = R"(
import json, socket, sys, time
line = socket.create_connection(("127.0.0.1", int(sys.argv[1])))
line.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
answers = line.makefile()
def call(method, **params):
    line.sendall(json.dumps({"jsonrpc": "2.0", "id": 1, "method": method, "params": params}).encode() + b"\n")
    answer = json.loads(answers.readline())
    if "error" in answer:
        sys.exit(answer["error"]["message"])
call("control.acquire", timeout_s=10)
while True:
    print(time.monotonic(), flush=True)
    call("motor.drive", vx=0.5, stamp=time.time())
    time.sleep(0.05)
)";

// The share of the values that are below the limit must be at least share; prints their distribution.
void report(const char *what, std::vector<double> seconds, double limit, double share) {
    std::sort(seconds.begin(), seconds.end());
    const auto at = [&](double part) {
        return 1000 * seconds[std::size_t(part * double(seconds.size() - 1))];
    };
    const auto below = std::count_if(seconds.begin(), seconds.end(), [&](double s) { return s < limit; });
    const QString text = QString("%1: %2 of %3 below %4 ms; median %5, 99 % %6, worst %7 ms")
                             .arg(what)
                             .arg(below)
                             .arg(seconds.size())
                             .arg(1000 * limit)
                             .arg(at(0.5), 0, 'f', 1)
                             .arg(at(0.99), 0, 'f', 1)
                             .arg(at(1), 0, 'f', 1);
    qInfo("%s", qPrintable(text));
    QVERIFY2(double(below) >= share * double(seconds.size()), qPrintable(text));
}

} // namespace

class TestMotorStops : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void initTestCase();
    void init();
    void cleanup();
    void emergencyStopReachesTheWire();
    void signalToTheClient_data();
    void signalToTheClient();
    void signalToTheDaemon_data();
    void signalToTheDaemon();

private:
    void startDaemon();
    void startDriver();
    double lastCommand();
    /// The wheels turn at nearly the speed that was asked for.
    bool isDriving() { return rig_->fastest() > 20000; }

    int trials_ = 3;
    std::unique_ptr<QTemporaryDir> folder_;
    std::unique_ptr<RoboClawRig> rig_;
    std::unique_ptr<QProcess> daemon_, driver_;
    QString port_;
};

void TestMotorStops::initTestCase() {
    if (qEnvironmentVariableIsSet("HERMES_TRIALS"))
        trials_ = std::max(1, qEnvironmentVariableIntValue("HERMES_TRIALS"));
}

void TestMotorStops::init() {
    folder_ = std::make_unique<QTemporaryDir>();
    RoboClawEmulator::Options first, second;
    second.address = 0x81;
    rig_ = std::make_unique<RoboClawRig>(folder_->filePath("line"), std::vector{first, second});
    startDaemon();
}

void TestMotorStops::cleanup() {
    for (QProcess *process : {driver_.get(), daemon_.get()}) {
        if (!process || process->state() == QProcess::NotRunning)
            continue;
        process->kill();
        process->waitForFinished();
    }
    driver_.reset();
    daemon_.reset();
    rig_.reset();
}

void TestMotorStops::startDaemon() {
    const QString url = "serial://" + folder_->filePath("line");
    daemon_ = std::make_unique<QProcess>();
    daemon_->setProcessChannelMode(QProcess::MergedChannels);
    daemon_->start(qEnvironmentVariable("HERMES_BIN") + "/hermes-motorcontrol",
                   {"--listen", "tcp://127.0.0.1:0", "--set", "controllers.1.url=" + url, "--set",
                    "controllers.2.url=" + url});
    QVERIFY(daemon_->waitForStarted());
    QString log;
    QTRY_VERIFY((log += daemon_->readAll()).contains(QRegularExpression("127.0.0.1:\\d+,")));
    port_ = QRegularExpression("127.0.0.1:(\\d+),").match(log).captured(1);
    QTRY_VERIFY(rig_->zeroSince() < RoboClawRig::now()); // it sends set-points
}

void TestMotorStops::startDriver() {
    driver_ = std::make_unique<QProcess>();
    QVERIFY(rig_->zeroSince() < RoboClawRig::now());
    for (int attempt = 0; attempt < 20 && !isDriving(); ++attempt) {
        driver_->start("python3", {"-c", driver, port_});
        // Until the controllers are set up it is refused and ends.
        QTRY_VERIFY_WITH_TIMEOUT(isDriving() || driver_->state() == QProcess::NotRunning, 5000);
    }
    QVERIFY2(isDriving(), driver_->readAllStandardError().constData());
}

double TestMotorStops::lastCommand() {
    driver_->waitForReadyRead(0);
    const QList<QByteArray> lines = driver_->readAllStandardOutput().split('\n');
    return lines.size() < 2 ? 0 : lines.at(lines.size() - 2).toDouble();
}

// From before the client writes the request to the last byte of the stop of both controllers.
void TestMotorStops::emergencyStopReachesTheWire() {
    Client client;
    QVERIFY(client.connectTo("127.0.0.1:" + port_).ok());
    QVERIFY(client.waitConnected().ok());
    std::vector<double> times;
    for (int trial = 0; trial < trials_; ++trial) {
        QTRY_VERIFY(client.callAndWait("control.acquire", QJsonObject()).ok());
        // Not in step with the cycle of the daemon.
        const double until = RoboClawRig::now() + 0.3 + 0.00137 * trial;
        while (RoboClawRig::now() < until || !isDriving()) {
            QVERIFY(client.callAndWait("motor.drive", QJsonObject{{"vx", 0.5}}).ok());
            QTest::qWait(5);
        }
        const double asked = RoboClawRig::now();
        QVERIFY(client.callAndWait("motor.estop", QJsonObject()).ok());
        QTRY_VERIFY(rig_->zeroSince() < RoboClawRig::now());
        times.push_back(rig_->zeroSince() - asked);
        QTRY_VERIFY(rig_->fastest() < 10);
        QVERIFY(client.callAndWait("motor.reset_estop", QJsonObject()).ok());
    }
    report("motor.estop to stop bytes", times, 0.020, 0.99);
}

void TestMotorStops::signalToTheClient_data() {
    QTest::addColumn<int>("signal");
    QTest::newRow("killed") << SIGKILL;
    QTest::newRow("frozen") << SIGSTOP;
}

void TestMotorStops::signalToTheClient() {
    QFETCH(int, signal);
    std::vector<double> times, standing;
    for (int trial = 0; trial < trials_; ++trial) {
        startDriver();
        QTest::qWait(trial * 7 % 50); // not in step with its commands
        QCOMPARE(::kill(pid_t(driver_->processId()), signal), 0);
        QTRY_VERIFY_WITH_TIMEOUT(rig_->zeroSince() < RoboClawRig::now(), 2000);
        QTRY_VERIFY_WITH_TIMEOUT(rig_->fastest() < RoboClawRig::standing, 2000);
        standing.push_back(rig_->lastMoved() - rig_->zeroSince());
        const double last = lastCommand();
        QVERIFY(last > 0);
        times.push_back(rig_->zeroSince() - last);
        driver_->kill();
        QVERIFY(driver_->state() == QProcess::NotRunning || driver_->waitForFinished());
    }
    report(QTest::currentDataTag(), times, 0.35, 1);
    report("from there to a stand", standing, 0.3,
           1); // 0.125 s, and what motor and PID lag behind
}

void TestMotorStops::signalToTheDaemon_data() {
    signalToTheClient_data();
}

// The controllers' own time-out of 0.2 s stops the wheels.
void TestMotorStops::signalToTheDaemon() {
    QFETCH(int, signal);
    std::vector<double> times;
    for (int trial = 0; trial < trials_; ++trial) {
        startDriver();
        const double sent = RoboClawRig::now();
        QCOMPARE(::kill(pid_t(daemon_->processId()), signal), 0);
        QTRY_VERIFY_WITH_TIMEOUT(rig_->fastest() < RoboClawRig::standing, 2000);
        times.push_back(rig_->lastDriven() - sent);
        cleanup();
        init();
    }
    report(QTest::currentDataTag(), times, 0.3, 1);
}

QTEST_GUILESS_MAIN(TestMotorStops)
#include "TestMotorStops.moc"
