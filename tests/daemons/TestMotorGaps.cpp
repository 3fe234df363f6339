// hermes-motorcontrol is stopped as a process and goes on later, while a client drives without stamps and
// without reading answers: what it sent meanwhile moves nothing. $HERMES_GAPS: seconds of the stops, "1 3"
// where it is not set.
#include "StopTrials.h"

using namespace hermes;
using namespace hermes::simulator;

// Commands at 20 Hz; "pause" and "go" on its input are answered when obeyed.
static const char *const blind = R"(
import json, select, socket, sys, time
line = socket.create_connection((sys.argv[1], int(sys.argv[2])), 5)
line.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
def send(method, **params):
    line.sendall(json.dumps({"jsonrpc": "2.0", "method": method, "params": params}).encode() + b"\n")
goes = True
while True:
    if goes:
        send("control.acquire", timeout_s=int(sys.argv[3]))
        send("motor.drive", vx=0.5)
    if select.select([sys.stdin], [], [], 0.05)[0]:
        goes = sys.stdin.readline().strip() == "go"
        print("done", flush=True)
)";

class TestMotorGaps : public QObject, StopTrials {
    Q_OBJECT
private Q_SLOTS:
    void init() { setUp(); }
    void cleanup() { tearDown(); }

    void whatWasSentMeanwhileIsVoid_data() {
        const Rows<double, int, int> row("seconds", "lease_s", "times");
        const QString gaps = qEnvironmentVariable("HERMES_GAPS", "1 3");
        int lease_s = 60;
        for (const QString &seconds : gaps.split(' ')) {
            QTest::addRow("%s s, lease of %d s", qPrintable(seconds), lease_s)
                << seconds.toDouble() << lease_s << 1;
            lease_s = 70 - lease_s; // 10 and 60 in turn
        }
        row("three in a row", 0.6, 60, 3);
    }

    void whatWasSentMeanwhileIsVoid() {
        FETCH(double, seconds, int, lease_s, int, times);
        startClient(lease_s);
        for (int trial = 0; trial < trials(); ++trial) {
            if (QTest::currentTestFailed())
                return;
            QVERIFY2(QTest::qWaitFor([this] { return isDriving(); }, 5000), toldState().constData());
            double first = 0, lastResumed = 0;
            for (int i = 0; i < times; ++i) {
                freeze(seconds);
                if (i == times - 1)
                    tell("pause");
                lastResumed = RoboClawRig::now();
                first = first > 0 ? first : lastResumed;
                QCOMPARE(::kill(pid_t(daemon_->processId()), SIGCONT), 0);
                if (i < times - 1)
                    QTest::qWait(3 * trial); // it has not read all yet
            }
            QTest::qWait(1000); // all that it received has been read
            // One may have been on its way into the line when the process was stopped; stops follow it at
            // once.
            QVERIFY(moving(first, RoboClawRig::now()) <= times);
            QCOMPARE(moving(lastResumed + 0.05, RoboClawRig::now()), 0);
            QVERIFY(rig_->zeroSince() < RoboClawRig::now()); // it sends set-points
            tell("go");
        }
        QTRY_VERIFY_WITH_TIMEOUT(isDriving(), 5000);
    }

    // What comes a quarter of a second later was sent after the gap.
    void whoGoesOnMovesAfterAWhile() {
        startClient(10);
        freeze(1);
        const double goesOn = RoboClawRig::now();
        QCOMPARE(::kill(pid_t(daemon_->processId()), SIGCONT), 0);
        QTRY_VERIFY_WITH_TIMEOUT(moving(goesOn, RoboClawRig::now()) > 0, 5000);
        QCOMPARE(moving(goesOn, goesOn + 0.25), 0);
    }

    void shortGapDoesNotDisturb() {
        startClient(10);
        for (int attempt = 0;; ++attempt) {
            QTRY_VERIFY_WITH_TIMEOUT(isDriving(), 5000);
            beginTrial();
            freeze(0.2);
            const double goesOn = RoboClawRig::now();
            QCOMPARE(::kill(pid_t(daemon_->processId()), SIGCONT), 0);
            QTRY_VERIFY_WITH_TIMEOUT(moving(goesOn, RoboClawRig::now()) > 0, 5000);
            if (moving(goesOn, goesOn + 0.15) > 0)
                return;
            QVERIFY(attempt < 3 && !endTrial()); // only where the machine stood still longer
        }
    }

private:
    void startClient(int lease_s) {
        driver_ = std::make_unique<QProcess>();
        driver_->start("python3", {"-c", blind, host_, port_, QString::number(lease_s)});
        QTRY_VERIFY_WITH_TIMEOUT(isDriving(), 20000);
    }

    void tell(const char *what) {
        driver_->write(QByteArray(what) + '\n');
        QByteArray answer;
        QTRY_VERIFY((answer += driver_->readAllStandardOutput()).contains("done"));
    }

    void freeze(double seconds) {
        QCOMPARE(::kill(pid_t(daemon_->processId()), SIGSTOP), 0);
        QTest::qWait(int(1000 * seconds)); // how long it is stopped is the matter
    }

    // Set-points other than zero.
    int moving(double since, double until) {
        int count = 0;
        for (const RoboClawRig::SetPoint &s : rig_->heard())
            count += s.time > since && s.time < until && !s.isZero();
        return count;
    }

    QByteArray toldState() const {
        QProcess asks;
        asks.start(qEnvironmentVariable("HERMES_BIN") + "/hermesctl", {host_ + ':' + port_, "motor.state"});
        asks.waitForFinished();
        return asks.readAllStandardOutput() + asks.readAllStandardError();
    }
};
