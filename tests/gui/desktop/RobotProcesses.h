#pragma once

#include "gui/desktop/model/Fleet.h"
#include "tests/support/ChildProcess.h"
#include "tests/support/FreePort.h"

#include <QJsonArray>
#include <QJsonDocument>
#include <QProcessEnvironment>
#include <QTemporaryDir>
#include <QtTest>
#include <csignal>
#include <map>

namespace hermes {

using namespace desktop;

/// Daemons as processes of their own on free ports, for the operator's program to connect to. They end with
/// this object.
class RobotProcesses {
public:
    ~RobotProcesses() {
        for (auto &[name, daemon] : daemons_)
            if (daemon.process)
                daemon.process->terminate();
        for (auto &[name, daemon] : daemons_)
            if (daemon.process && !daemon.process->waitForFinished(5000))
                daemon.process->kill();
    }

    /// Starts hermes-NAME with settings as `path=value`; gives its port.
    quint16 start(const QString &name, const QStringList &settings = {}, const QStringList &options = {}) {
        Daemon &daemon = daemons_[name];
        if (daemon.port == 0)
            daemon.port = reservePort();
        QStringList arguments{"--listen", QString("tcp://127.0.0.1:%1?protocol=json").arg(daemon.port)};
        arguments << options;
        for (const QString &setting : settings)
            arguments << "--set" << setting;
        daemon.process = std::make_unique<ChildProcess>();
        QProcessEnvironment environment = QProcessEnvironment::systemEnvironment();
        environment.insert("XDG_STATE_HOME", folder_.path());
        daemon.process->setProcessEnvironment(environment);
        daemon.process->setStandardOutputFile(QProcess::nullDevice());
        daemon.process->setStandardErrorFile(folder_.filePath(name + ".log"), QIODevice::Append);
        const QString beside = QCoreApplication::applicationDirPath() + "/hermes-" + name; // one of the tests
        daemon.process->start(QFile::exists(beside) ? beside
                                                    : qEnvironmentVariable("HERMES_BIN") + "/hermes-" + name,
                              arguments);
        return daemon.port;
    }
    /// Simulator, motor control, lidar logger and scan matcher in a world of deploy/worlds, wired as on a
    /// robot. simulator: more settings of it.
    void startAll(const QStringList &simulator = {}) {
        const quint16 lidar = reservePort();
        const quint16 logger = start("velodynelogger", {QString("source.port=%1").arg(lidar),
                                                        "record.folder=" + folder_.filePath("recordings")});
        start("scanmatcher",
              {QString("source.address=127.0.0.1:%1").arg(logger), "map.folder=" + folder_.filePath("maps")});
        startMotors(QStringList{QString("lidar.port=%1").arg(lidar)} + simulator);
    }
    /// The same with a serial logger that receives the simulated satellites.
    void startAllWithGps() {
        startAll({"gps.link=" + path("gps")});
        start("seriallogger",
              {"record.folder=" + path("recordings"),
               QString(R"(ports=[{"name":"gps","url":"serial://%1?baud=9600","view":"nmea"}])")
                   .arg(path("gps"))});
    }
    /// Simulator and motor control.
    void startMotors(const QStringList &simulator = {}) {
        const QString world = qEnvironmentVariable("HERMES_SOURCE") + "/deploy/worlds/pillars.json";
        start("simulator", QStringList{"world=" + world, "motors.link=" + motorLink()} + simulator);
        daemons_.at("simulator").process->goBeforeOthers(); // else its controllers may answer too late
        startMotorControl();
    }
    /// Its client may be silent for 1 s, as it is when the machine stalls.
    void startMotorControl() {
        const QString url = "serial://" + motorLink() + "?baud=115200";
        start("motorcontrol",
              {"controllers.1.url=" + url, "controllers.2.url=" + url, "safety.command_timeout_s=1"});
        daemons_.at("motorcontrol").process->goBeforeOthers();
    }
    /// A recorder of all that were started so far.
    void startRecorder() {
        QJsonArray all;
        for (const auto &[name, daemon] : daemons_)
            all.append(QString("127.0.0.1:%1").arg(daemon.port));
        const QByteArray named = QJsonDocument(all).toJson(QJsonDocument::Compact);
        start("recorder", {"record.folder=" + path("recordings"), "daemons=" + QString::fromUtf8(named)});
    }
    /// One that this object does not start.
    void add(const QString &name, quint16 port) { daemons_[name].port = port; }
    /// A supervisor that names all daemons that were started so far, as those of one robot.
    quint16 supervise(const QString &robot, const QStringList &settings = {}) {
        QJsonArray processes;
        for (const auto &[name, daemon] : daemons_)
            if (name != "supervisor")
                processes.append(QJsonObject{{"name", name}, {"port", daemon.port}});
        const QByteArray named = QJsonDocument(processes).toJson(QJsonDocument::Compact);
        return start("supervisor",
                     QStringList{"robot=" + robot, "processes=" + QString::fromUtf8(named)} + settings);
    }
    /// Such a supervisor that finds what the simulator offers at these ports and keeps settings in the folder
    /// "etc".
    void startSupervisor(const QJsonArray &lines, int lidarPort, const QStringList &settings = {}) {
        QVERIFY(QDir().mkpath(path("etc")));
        const QByteArray ports = QJsonDocument(lines).toJson(QJsonDocument::Compact);
        supervise("robot",
                  QStringList{"setup.folder=" + path("etc"), "setup.ports=" + QString::fromUtf8(ports),
                              "setup.samples=" + qEnvironmentVariable("HERMES_SOURCE") + "/deploy/settings",
                              QString("setup.lidar_port=%1").arg(lidarPort),
                              QString("setup.position_port=%1").arg(reservePort())} +
                      settings);
    }
    void signal(const QString &name, int number) {
        const qint64 process = daemons_.at(name).process->processId();
        QVERIFY2(process > 0, qPrintable(name)); // 0 would be all processes of the test
        ::kill(pid_t(process), number);
    }
    /// As SIGKILL does.
    void kill(const QString &name) {
        daemons_.at(name).process->kill();
        daemons_.at(name).process->waitForFinished();
    }

    /// Adds all of them to the fleet and waits until each can be spoken to as one of the chosen robot.
    void connectTo(Fleet &fleet) {
        for (const auto &[name, daemon] : daemons_)
            QVERIFY(fleet.add(QString("127.0.0.1:%1").arg(daemon.port)).ok());
        QTRY_VERIFY_WITH_TIMEOUT(fleet.robot() && areAllReady(*fleet.robot()), 20000);
    }
    quint16 port(const QString &name) const { return daemons_.at(name).port; }
    QString path(const QString &name) const { return folder_.filePath(name); }

private:
    struct Daemon {
        quint16 port = 0;
        std::unique_ptr<ChildProcess> process;
    };

    QString motorLink() const { return folder_.filePath("motors"); }
    bool areAllReady(const Robot &robot) const {
        for (const auto &[name, daemon] : daemons_)
            if (!robot.withName(name) || !robot.withName(name)->hasTopic("status"))
                return false;
        return true;
    }

    QTemporaryDir folder_{QDir::tempPath() + "/XXXXXX"}; // short, as it is seen in pictures
    std::map<QString, Daemon> daemons_;
};

} // namespace hermes
