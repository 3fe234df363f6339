#pragma once

#include "RoboClawRig.h"
#include "daemons/motorcontrol/MotorControl.h"
#include "tests/support/DaemonClient.h"

/// A motor control in this process, two emulated controllers on one line, and a client.
class MotorFixture : protected DaemonClient {
protected:
    static constexpr double countsPerTurn = 38000, radius = 0.1; // m

    static hermes::simulator::RoboClawEmulator::Options controllerAt(int address) {
        hermes::simulator::RoboClawEmulator::Options options;
        options.address = std::uint8_t(address);
        return options;
    }
    /// m/s at the rim, or m
    static double atRim(double counts) { return counts / countsPerTurn * 2 * std::acos(-1.0) * radius; }

    QString url() const { return rig_ ? rig_->url() : url("line"); }
    QString url(const QString &link) const { return "serial://" + folder_->filePath(link); }
    QString address() const { return daemon_->server().addresses().value(0); }
    QJsonObject state() { return call("motor.state"); }

    void setUp() {
        folder_ = std::make_unique<QTemporaryDir>();
        plug({controllerAt(0x80), controllerAt(0x81)});
    }
    void plug(const std::vector<hermes::simulator::RoboClawEmulator::Options> &controllers) {
        rig_.reset();
        rig_ = std::make_unique<RoboClawRig>(folder_->filePath("line"), controllers);
    }
    /// The same controllers behind a serial server instead: their bytes need no kernel thread that waits.
    void plugServer() {
        rig_.reset();
        rig_ = std::make_unique<RoboClawRig>(QString(), std::vector{controllerAt(0x80), controllerAt(0x81)});
    }
    void tearDown() {
        client_.reset();
        if (daemon_)
            daemon_->shutDown();
        daemon_.reset();
        rig_.reset();
    }

    /// The client may be silent for 1 s, as it is when the machine stalls.
    void launch(const QStringList &settings = {}) {
        daemon_ = std::make_unique<hermes::motorcontrol::MotorControl>();
        ::launch(*daemon_, QStringList{"controllers.1.url=" + url(), "controllers.2.url=" + url(),
                                       "safety.command_timeout_s=1"} +
                               settings);
        connectTo(*daemon_);
    }

    void launchReady(const QStringList &settings = {}) {
        launch(settings);
        QTRY_VERIFY(state()["ready"].toBool());
    }
    /// The client has the control.
    void launchHeld(const QStringList &settings = {}) {
        launchReady(settings);
        call("control.acquire");
    }

    QJsonObject call(const QString &method, const QJsonObject &params = {}) {
        return DaemonClient::call(method, params).toObject();
    }

    /// Waits until the drive loop went round so many times more: what was asked has then had its effect.
    void passCycles(int count) {
        const auto cycles = [this] { return state()["cycle"].toObject()["cycles"].toInt(); };
        const int end = cycles() + count;
        QTRY_VERIFY(cycles() >= end);
    }

    /// Sends drive commands at 20 Hz for so long.
    void drive(const QJsonObject &twist, double seconds) {
        const double end = RoboClawRig::now() + seconds;
        while (RoboClawRig::now() < end) {
            const QJsonObject reply = call("motor.drive", twist);
            QVERIFY2(!reply.contains("failed"), qPrintable(reply["failed"].toString()));
            QTest::qWait(50); // the pace of a client
        }
    }
    /// The same until it is so, for 10 s at most.
    template <typename Condition>
    void driveUntil(const QJsonObject &twist, Condition isSo) {
        const double end = RoboClawRig::now() + 10;
        while (!isSo()) {
            QVERIFY(RoboClawRig::now() < end);
            drive(twist, 0.05);
        }
    }
    /// Until the wheels turn.
    void driveOff(const QJsonObject &twist) {
        driveUntil(twist, [this] { return rig_->fastest() > 1000; });
    }

    std::unique_ptr<QTemporaryDir> folder_;
    std::unique_ptr<RoboClawRig> rig_;
    std::unique_ptr<hermes::motorcontrol::MotorControl> daemon_;
};
