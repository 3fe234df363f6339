// hermesctl simulate: a whole simulated robot on this computer, until Ctrl-C.
#include "common/Project.h"
#include "common/daemon/SignalWatcher.h"
#include "gui/hermesctl/Commands.h"
#include "gui/hermesctl/Waiting.h"
#include "protocol/drive/ArduinoDevice.h"
#include "protocol/drive/OpenCrDevice.h"
#include "protocol/drive/RoboteqDevice.h"
#include "protocol/drive/VescDevice.h"
#include "protocol/messages/Setup.h"

#include <QDir>
#include <QEventLoop>
#include <QFile>
#include <QJsonDocument>
#include <QProcess>
#include <QTemporaryDir>

#include <algorithm>

namespace hermes::ctl {
namespace {

constexpr int sickPort = 2112;

/// What drives such a robot in place of two RoboClaws: two motors.
struct SimulatedBase {
    const char *kind;
    int baud, countsPerTurn;
    double timeout_s; ///< its own
};
constexpr SimulatedBase simulatedBases[] = {
    {"arduino", drive::ArduinoDevice::usualBaud, 3600, drive::ArduinoDevice::timeout_s},
    {"vesc", drive::VescDevice::usualBaud, 3600, 0.2},
    {"opencr", drive::OpenCrDevice::usualBaud, 4096, drive::OpenCrDevice::timeout_s},
    {"roboteq", drive::RoboteqDevice::usualBaud, 3600, 0.2}};
constexpr int canId = 10, fullSpeed = 12000; // of their motors: counts a second

const SimulatedBase *findBase(const QString &kind) {
    const auto found = std::find_if(std::begin(simulatedBases), std::end(simulatedBases),
                                    [&](const SimulatedBase &base) { return kind == base.kind; });
    return found == std::end(simulatedBases) ? nullptr : found;
}

/// Changes the settings of simulator and motor control so that this drives the robot.
void putBase(const SimulatedBase &base, const QString &layout, QMap<QString, QJsonObject> &settings) {
    QJsonObject motors = settings["simulator"]["motors"].toObject();
    motors["kind"] = base.kind;
    motors["full_speed"] = fullSpeed;
    motors["vesc"] = QJsonObject{{"timeout_s", base.timeout_s}, {"brake_current_a", 20}, {"can_id", canId}};
    settings["simulator"]["motors"] = motors;
    QJsonObject line{{"url", QString("serial://%1?baud=%2").arg(motors["link"].toString()).arg(base.baud)}};
    QJsonObject controllers{{"kind", base.kind}, {"timeout_s", base.timeout_s}};
    if (base.kind == QString("vesc"))
        line["address"] = canId;
    controllers["1"] = line;
    if (layout == "differential")
        controllers["count"] = 1; // the wheels behind have no motors
    settings["motorcontrol"]["controllers"] = controllers;
    settings["motorcontrol"]["pid"] = QJsonObject{{"qpps", fullSpeed}};
}

/// A world that came with the programs, in an installation or a source tree.
QString usualWorld(const QString &programs) {
    for (const char *place : {"/../share/hermes/worlds/", "/../../../deploy/worlds/"})
        if (const QFileInfo file(programs + place + "pillars.json"); file.exists())
            return file.canonicalFilePath();
    return {};
}

/// Settings of the daemons of such a robot, by their names.
QMap<QString, QJsonObject> settingsOf(const Arguments &arguments, const QString &folder,
                                      const QString &world) {
    const QString motors = folder + "/motors", laser = folder + "/laser", here = QDir::currentPath();
    const auto portOf = [](const char *daemon) { return QString("127.0.0.1:%1").arg(defaultPort(daemon)); };
    const QJsonObject line{{"url", QString("serial://%1?baud=115200").arg(motors)}};
    const SimulatedBase *base = findBase(arguments.base);
    const bool isUsual = base && !arguments.given.contains("--kinematics");
    QJsonObject frame{{"layout", isUsual ? "two_wheels" : arguments.kinematics}};
    if (base)
        frame["counts_per_turn"] = base->countsPerTurn;
    const QJsonObject record{{"folder", here + "/recordings"}};
    const bool hasScanner = !arguments.scanner.isEmpty();
    QMap<QString, QJsonObject> settings{
        {"simulator", {{"world", world}, {"motors", QJsonObject{{"link", motors}}}, {"frame", frame}}},
        {"motorcontrol", {{"controllers", QJsonObject{{"1", line}, {"2", line}}}, {"frame", frame}}},
        {"scanmatcher",
         {{"source", QJsonObject{{"address", portOf(hasScanner ? "scanner" : "velodynelogger")}}},
          {"odometry", QJsonObject{{"address", portOf("motorcontrol")}}},
          {"map", QJsonObject{{"folder", here + "/maps"}}}}},
        {"recorder", {{"record", record}}}};
    if (base)
        putBase(*base, frame["layout"].toString(), settings);
    if (arguments.kinematics == "ackermann")
        settings["motorcontrol"]["wheels"] = QJsonObject{{"rear_left", QJsonObject{{"controller", 1}}}};
    if (hasScanner) {
        const bool isOnNetwork = arguments.scanner.startsWith("sick-"); // SICK's have no serial line
        QJsonObject simulated{{"model", arguments.scanner}}, read{{"model", arguments.scanner}};
        simulated[isOnNetwork ? "port" : "link"] = isOnNetwork ? QJsonValue(sickPort) : QJsonValue(laser);
        read["url"] = isOnNetwork ? QString("tcp://127.0.0.1:%1").arg(sickPort) : "serial://" + laser;
        if (isOnNetwork)
            read["model"] = arguments.scanner.contains("tim") ? "sick-tim5xx" : "sick-lms1xx";
        settings["simulator"]["scanner"] = simulated;
        settings["simulator"]["lidar"] = QJsonObject{{"port", 0}};
        settings["scanner"] = {{"scanner", read}, {"record", record}};
    } else {
        settings["velodynelogger"] = {{"source", QJsonObject{{"address", "127.0.0.1"}}}, {"record", record}};
    }
    return settings;
}

Result<void> put(const QString &path, const QJsonObject &settings) {
    QFile file(path);
    const QByteArray text = QJsonDocument(settings).toJson();
    if (!file.open(QIODevice::WriteOnly) || file.write(text) != text.size())
        return Error(ErrorCode::InputOutput, path + ": " + file.errorString());
    return {};
}

/// A daemon takes its settings.
Result<void> check(const QString &programs, const QString &name, const QString &path) {
    QProcess daemon;
    daemon.start(programs + "/hermes-" + name, {"--config", path, "--check"});
    if (!daemon.waitForStarted() || !daemon.waitForFinished())
        return Error(ErrorCode::InputOutput, programs + "/hermes-" + name + ": " + daemon.errorString());
    if (daemon.exitCode() == 0)
        return {};
    return Error(ErrorCode::InvalidParams, QString::fromUtf8(daemon.readAllStandardError()).trimmed());
}

/// Writes their settings, and those of the supervisor that starts them; the simulator, whose lines the others
/// open, first.
Result<void> write(const QString &programs, const QString &folder,
                   const QMap<QString, QJsonObject> &settings) {
    QStringList names = settings.keys();
    names.removeAll("simulator");
    names.prepend("simulator");
    QJsonArray processes;
    for (const QString &name : qAsConst(names)) {
        const QString path = folder + '/' + name + ".json";
        if (const Result<void> written = put(path, settings[name]); !written)
            return written;
        if (const Result<void> checked = check(programs, name, path); !checked)
            return checked;
        processes.append(
            QJsonObject{{"name", name}, {"arguments", QJsonArray{"--config", path}}, {"autostart", true}});
    }
    return put(folder + "/supervisor.json", {{"robot", "simulated"}, {"processes", processes}});
}

} // namespace

QStringList kinematicsOf(const QString &base) {
    if (!findBase(base)) // two RoboClaws
        return {"mecanum", "differential", "two_wheels", "omni3", "omni4"};
    QStringList kinds{"differential", "two_wheels"}; // of two motors
    if (base == "vesc")
        kinds.append("ackermann"); // it has an output for the servo
    return kinds;
}

Result<void> checkSimulate(const Arguments &arguments) {
    const QStringList bases = FoundSerial::controllerKinds();
    if (!arguments.base.isEmpty() && !bases.contains(arguments.base))
        return Error(
            ErrorCode::InvalidParams,
            QString("--base: found \"%1\", expected one of %2").arg(arguments.base, bases.join(", ")));
    const QStringList kinds = kinematicsOf(arguments.base);
    if (kinds.contains(arguments.kinematics) || !arguments.given.contains("--kinematics"))
        return {};
    return Error(ErrorCode::InvalidParams, QString("--kinematics: found \"%1\", expected one of %2")
                                               .arg(arguments.kinematics, kinds.join(", ")));
}

Result<void> simulate(const Arguments &arguments) {
    const QString programs = QCoreApplication::applicationDirPath();
    const QString world =
        arguments.world.isEmpty() ? usualWorld(programs) : QFileInfo(arguments.world).absoluteFilePath();
    if (!QFile::exists(world))
        return Error(ErrorCode::InputOutput, world.isEmpty()
                                                 ? "no world came with this program; --world FILE names one"
                                                 : world + ": there is no such world");
    const QTemporaryDir folder;
    if (!folder.isValid())
        return Error(ErrorCode::InputOutput, folder.errorString());
    const auto settings = settingsOf(arguments, folder.path(), world);
    if (const Result<void> written = write(programs, folder.path(), settings); !written)
        return written;
    QProcess supervisor;
    SignalWatcher signals(nullptr); // before there is anything to end
    QObject::connect(&signals, &SignalWatcher::received, &supervisor, &QProcess::terminate);
    supervisor.setProcessChannelMode(QProcess::ForwardedChannels);
    supervisor.start(programs + "/hermes-supervisor", {"--config", folder.path() + "/supervisor.json"});
    if (!supervisor.waitForStarted())
        return Error(ErrorCode::InputOutput, programs + "/hermes-supervisor: " + supervisor.errorString());
    note(QString("a robot is simulated in %1: %2; recordings and maps are put below %3, its settings are in "
                 "%4 until it ends\n"
                 "hermesctl drive motorcontrol drives it, hermes-gui shows it, Ctrl-C ends it")
             .arg(world, QStringList(settings.keys()).join(", "), QDir::currentPath(), folder.path()));
    QEventLoop loop;
    QObject::connect(&supervisor, qOverload<int, QProcess::ExitStatus>(&QProcess::finished), &loop,
                     &QEventLoop::quit);
    loop.exec();
    if (supervisor.exitStatus() == QProcess::NormalExit && supervisor.exitCode() == 0)
        return {};
    return Error(ErrorCode::DeviceFault,
                 QString("the supervisor ended with status %1").arg(supervisor.exitCode()));
}

} // namespace hermes::ctl
