#pragma once

#include "MachineStalls.h"
#include "RoboClawRig.h"

/// Trials of how fast hermes-motorcontrol stops: the daemon and a driving client as processes, emulated
/// controllers with wheels and body in this one. Times are taken at the far end of the line, that of a serial
/// server.
class StopTrials {
protected:
    static constexpr double deceleration = 4; // m/s^2, the default of safety.deceleration

    /// $HERMES_TRIALS, 3 where it is not set.
    static int trials() {
        return qEnvironmentVariableIsSet("HERMES_TRIALS")
                   ? std::max(1, qEnvironmentVariableIntValue("HERMES_TRIALS"))
                   : 3;
    }

    /// The programs of the trials go before others, where that is permitted: what a busy machine does to them
    /// is another test.
    void setUp() {
        ::setpriority(PRIO_PROCESS, 0, -15);
        hermes::simulator::RoboClawEmulator::Options first, second;
        second.address = 0x81;
        rig_ = std::make_unique<RoboClawRig>(QString(), std::vector{first, second});
        startDaemon();
    }
    void tearDown() {
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

    void startDaemon() {
        const QString url = rig_->url();
        daemon_ = std::make_unique<QProcess>();
        daemon_->setProcessChannelMode(QProcess::MergedChannels);
        // Should this program be ended, the daemon must not go on and find the line of another test.
        daemon_->start("setpriv",
                       {"--pdeathsig", "KILL", qEnvironmentVariable("HERMES_BIN") + "/hermes-motorcontrol",
                        "--listen", "tcp://" + host_ + ":0", "--set", "insecure=true", "--set",
                        "controllers.1.url=" + url, "--set", "controllers.2.url=" + url});
        QVERIFY(daemon_->waitForStarted());
        const QRegularExpression where(QRegularExpression::escape(host_) + ":(\\d+),");
        QString log;
        QTRY_VERIFY2((log += daemon_->readAll()).contains(where), qPrintable(log));
        port_ = where.match(log).captured(1);
        QTRY_VERIFY(rig_->zeroSince() < RoboClawRig::now()); // it sends set-points
    }

    /// Returns when the robot goes at full speed. command: what the client runs under.
    void startDriver(const QStringList &command = {}) {
        driver_ = std::make_unique<QProcess>();
        QVERIFY(rig_->zeroSince() < RoboClawRig::now());
        QStringList words = command + QStringList{"python3", "-c", driver, host_, port_};
        const QString program = words.takeFirst();
        for (int attempt = 0; attempt < 50 && !isDriving(); ++attempt) {
            driver_->start(program, words);
            // Until the controllers are set up, and the control is free, it is refused and ends.
            QTRY_VERIFY_WITH_TIMEOUT(isDriving() || driver_->state() == QProcess::NotRunning, 20000);
        }
        QVERIFY2(isDriving(), driver_->readAllStandardError().constData());
    }
    bool isDriving() { return rig_->rimSpeed() > 0.49; }

    /// When the client sent its last command, not later than this; monotonic, 0 when there is none.
    double lastCommand(double latest) {
        driver_->waitForReadyRead(0);
        double last = 0;
        for (const QByteArray &line : driver_->readAllStandardOutput().split('\n')) {
            const double time = line.toDouble();
            if (time <= latest)
                last = std::max(last, time);
        }
        return last;
    }

    /// Every trial begins with it.
    void beginTrial() { stalls_.takeLongest(); }
    /// Whether the trial counts: one during which the machine stood still is made again, as long as those are
    /// not too many.
    bool endTrial() {
        if (stalls_.takeLongest() < 0.02 || repeated_ >= trials())
            return true;
        ++repeated_;
        if (!beyond_.empty())
            beyond_.pop_back();
        return false;
    }

    /// Waits until the controllers were told to stop and the robot stands.
    void awaitStop() {
        QTRY_VERIFY_WITH_TIMEOUT(rig_->zeroSince() < RoboClawRig::now(), 2000);
        QTRY_VERIFY_WITH_TIMEOUT(RoboClawRig::now() - rig_->lastMoved() > 0.1, 2000);
        const RoboClawRig::SetPoint zero = rig_->zero();
        beyond_.push_back(rig_->lastMoved() - zero.time - zero.rimSpeed / deceleration);
    }
    void reportRepeated() {
        if (const int repeated = std::exchange(repeated_, 0))
            qInfo("%d trials were made again: the machine stood still", repeated);
    }
    /// The stops of which awaitStop() has seen the end: robot and wheels stand 50 ms after the time that the
    /// deceleration implies.
    void reportStand() {
        reportRepeated();
        report("stand after the time of braking from the speed at the zero", std::exchange(beyond_, {}), 0.05,
               1);
    }

    /// The share of the values that are below the limit must be at least share; prints their distribution.
    static void report(const char *what, std::vector<double> seconds, double limit, double share) {
        limit *= slowness;
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

    QString host_ = "127.0.0.1"; // where the daemon listens
    std::unique_ptr<RoboClawRig> rig_;
    std::unique_ptr<QProcess> daemon_, driver_;
    QString port_;

private:
    // Drives at 20 Hz and prints when each command was made, in seconds of the monotonic clock.
    static constexpr const char *driver = R"(
import json, socket, sys, time
line = socket.create_connection((sys.argv[1], int(sys.argv[2])), 5)
line.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
answers = line.makefile()
def call(method, **params):
    line.sendall(json.dumps({"jsonrpc": "2.0", "id": 1, "method": method, "params": params}).encode() + b"\n")
    answer = json.loads(answers.readline())
    if "error" in answer:
        sys.exit(answer["error"]["message"])
call("control.acquire", timeout_s=1)
while True:
    made, stamp = time.monotonic(), time.time()
    print(made, flush=True)
    call("motor.drive", vx=0.5, stamp=stamp)
    time.sleep(0.05)
)";

    MachineStalls stalls_;
    int repeated_ = 0;
    std::vector<double> beyond_; // seconds from the end of braking to the stand
};
