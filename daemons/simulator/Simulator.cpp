#include "daemons/simulator/Simulator.h"

#include "common/Log.h"
#include "common/files/FilesSetting.h"
#include "common/files/NamedFile.h"
#include "common/world/World.h"
#include "daemons/simulator/SimulatorSettings.h"
#include "protocol/messages/Motion.h"
#include "protocol/wire/Fields.h"
#include "vectorlib/geometry/Angle.h"

namespace hermes::simulator {

namespace {

constexpr auto healthItem = "lidar";
const QStringList takenAtTheStart{"listen",        "insecure",     "files.folders", "world",
                                  "motors.kind",   "motors.link",  "motors.link2",  "gps.link",
                                  "scanner.model", "scanner.link", "scanner.port"};
constexpr qint64 largestWorldFile = 16 << 20; // some 300,000 edges

TruthMessage messageOf(const Simulation::Truth &truth) {
    return {double(truth.stamp_ns) * 1e-9,
            {truth.pose.x, truth.pose.y, truth.pose.theta},
            truth.twist,
            truth.progress,
            truth.driving,
            truth.finished,
            truth.touching};
}

QString toText(LidarFault::Kind kind) {
    static constexpr const char *texts[] = {"none", "silence", "loss"};
    return QString(texts[int(kind)]); // in the order of the enumeration
}

} // namespace

Simulator::Simulator()
    : Daemon({"simulator", "Simulator",
              "A simulated robot in a world of walls: an HDL-32E that sends packets over UDP; on "
              "pseudo-terminals motor controllers, a GPS receiver and a 2D scanner"})
    , pump_([this](const Simulation::Truth &truth) { later([this, truth] { publishTruth(truth); }); },
            [this](const std::string &sentences) {
                later([this, sentences] { gpsLine_.send(QByteArray::fromStdString(sentences)); });
            },
            [this](const std::string &bytes) {
                later([this, bytes, session = scannerSession_] {
                    if (session == scannerSession_)
                        scannerLine_.send(QByteArray::fromStdString(bytes));
                });
            })
    , lines_([this](int line, const QByteArray &bytes, double now) {
        std::vector<MotorEmulator::Answer> answers;
        pump_.with([&](Simulation &simulation) {
            answers = simulation.drivetrain().receive(
                line, reinterpret_cast<const std::uint8_t *>(bytes.constData()), std::size_t(bytes.size()),
                now);
        });
        return answers;
    }) {
    SimulatorSettings().declareIn(settings());
    settings().addRule([](const QJsonObject &wanted) { return SimulatorSettings(wanted).violations(); });
    addSetting(namedFilesField());
    declareTopics();
    declareCommands();
    health().provide(healthItem, [this] { updateHealth(); });
}

void Simulator::declareTopics() {
    addTopic(Topic("truth", "Where the robot truly is, 50 times a second").carries<TruthMessage>());
}

void Simulator::declareCommands() {
    addCommand(Command("sim.load", "Loads a world file and puts the robot, standing, at its first pose")
                   .needs(Role::Engineer)
                   .param(Field::text("world", "World file (JSON); a relative path begins in the folder in "
                                               "which the simulator runs"))
                   .example({{"world", "deploy/worlds/pillars.json"}},
                            QJsonObject{{"path", "/home/robot/hermes/deploy/worlds/pillars.json"},
                                        {"name", "pillars"},
                                        {"edges", 36},
                                        {"poses", 39}})
                   .answers([this](const Call &call) -> Result<LoadedWorld> {
                       const Result<void> loaded =
                           loadNamed(call.text("world"), namedFilesFolders(settings()));
                       if (!loaded)
                           return loaded.error();
                       return LoadedWorld{worldPath_, QString::fromStdString(world_.name),
                                          world_.edges.size(), world_.poses.size()};
                   }));
    addCommand(Command("sim.state", "World, true pose, progress along the path, packets sent and left out")
                   .needs(Role::Observer)
                   .answers([this](const Call &) { return state(); }));
    addCommand(Command("sim.drive", "Follows the path of the world from where the robot is on it")
                   .param(Field::boolean("restart", "Begin again at the first pose").byDefault(false))
                   .answers([this](const Call &call) { return drive(call.flag("restart")); }));
    addCommand(Command("sim.halt", "Slows down and stops").answers([this](const Call &) {
        pump_.with([](Simulation &simulation) { simulation.halt(); });
    }));
    addCommand(Command("sim.place",
                       "Puts the robot anywhere, standing; sim.drive with restart brings it back to its path")
                   .param(Field::number("x", "Position").unit("m"))
                   .param(Field::number("y", "Position").unit("m"))
                   .param(Field::number("theta", "Heading").unit("rad"))
                   .answers([this](const Call &call) { return place(call); }));
    addCommand(
        Command("sim.noise", "Sets the noise of the sensors until the next start; what is not given stays")
            .param(Field::number("sigma_m", "Standard deviation of the lidar's range")
                       .unit("m")
                       .range(0, 1)
                       .optional())
            .param(Field::number("dropouts", "Share of the lidar's returns that do not come")
                       .range(0, 1)
                       .optional())
            .param(Field::number("outliers",
                                 "Share of the lidar's returns with a wrong range, up to twice as far")
                       .range(0, 1)
                       .optional())
            .param(Field::number("gps_sigma_m", "Standard deviation of each coordinate of a fix")
                       .unit("m")
                       .range(0, 1000)
                       .optional())
            .answers([this](const Call &call) { return setNoise(call); }));
    addCommand(
        Command("sim.fault",
                "Simulates a fault of a device; none ends its faults. docs/simulator.md tells what each does")
            .param(Field::text("device", "Which device").choices(faultDevices()))
            .param(Field::text("kind", "What it does wrong").choices(faultKinds()))
            .param(
                Field::number("share",
                              "Of the packets, answers or bytes that a loss leaves out or that are corrupt; "
                              "of the way that slip loses; of the charge that is left")
                    .range(0, 1)
                    .byDefault(0.1))
            .param(Field::number("delay_s", "By which slow answers are late; that an adapter waits for more "
                                            "bytes; that a brownout lasts")
                       .unit("s")
                       .range(0, 10)
                       .byDefault(0.05))
            .param(Field::integer("counts", "By which an encoder jumps").range(-1e9, 1e9).byDefault(100000))
            .example({{"device", "lidar"}, {"kind", "loss"}, {"share", 0.05}}, QJsonValue())
            .answers([this](const Call &call) { return setFault(call); }));
}

Result<void> Simulator::start() {
    const SimulatorSettings wanted(settings().inForce());
    QStringList links{wanted.link};
    if (!wanted.link2.isEmpty())
        links.append(wanted.link2);
    for (const Result<void> &opened : {lines_.open(links, motorKind(wanted.simulation.drivetrain.kind).baud),
                                       gpsLine_.open(wanted.gpsLink), openScanner(wanted)}) {
        if (!opened)
            return opened;
    }
    if (wanted.world.isEmpty()) {
        setState(DaemonState::Ready);
        return {};
    }
    const Result<void> loaded = loadNamed(wanted.world, {"/"});
    if (loaded && wanted.autostart)
        drive(false);
    return loaded;
}

void Simulator::settingsChanged(const QStringList &paths) {
    pump_.with([&](Simulation &simulation) {
        for (const QString &path : paths) {
            const auto value = [&] { return settings().number(path); };
            if (path == "lidar.sigma_m")
                simulation.changeLidars([&](LidarModel &lidar) { lidar.setSigma(value()); });
            else if (path == "lidar.dropouts")
                simulation.changeLidars([&](LidarModel &lidar) { lidar.setDropouts(value()); });
            else if (path == "lidar.outliers")
                simulation.changeLidars([&](LidarModel &lidar) { lidar.setOutliers(value()); });
            else if (path == "gps.sigma_m")
                simulation.gps().setSigma(value());
        }
    });
}

Result<void> Simulator::loadNamed(const QString &name, const QStringList &folders) {
    const Result<QByteArray> text = readNamedFile(name, folders, largestWorldFile);
    if (!text)
        return text.error();
    const QString path = absolutePath(name);
    return load(path, parseWorld(text->toStdString(), path.toStdString()));
}

Result<void> Simulator::load(const QString &path, const Outcome<World> &world) {
    if (!world)
        return Error(ErrorCode::InputOutput, QString::fromStdString(world.error()),
                     QJsonObject{{"path", path}});
    settings().takeWaiting(takenAtTheStart);
    SimulatorSettings wanted(settings().inForce());
    wanted.simulation.drivetrain.ownLines = lines_.count() > 1;
    const Outcome<void> started = pump_.start(*world, wanted.simulation, wanted.lidarHost.toStdString(),
                                              wanted.lidarPort, wanted.positionPort);
    if (!started) {
        setState(DaemonState::Fault);
        return Error(ErrorCode::InputOutput, QString::fromStdString(started.error()));
    }
    world_ = *world;
    worldPath_ = path;
    setState(DaemonState::Running);
    logInfo("simulator", QString("world %1: %2 edges, %3 poses; packets go to %4:%5")
                             .arg(path)
                             .arg(world_.edges.size())
                             .arg(world_.poses.size())
                             .arg(wanted.lidarHost)
                             .arg(wanted.lidarPort));
    return {};
}

Result<void> Simulator::drive(bool restart) {
    if (world_.poses.size() < 2)
        return Error(ErrorCode::NotReady, worldPath_.isEmpty()
                                              ? QString("no world is loaded; sim.load loads one")
                                              : worldPath_ + " has no path: two poses or more expected");
    bool drives = false;
    pump_.with([&](Simulation &simulation) {
        if (restart)
            simulation.restart();
        drives = simulation.drive();
    });
    if (!drives)
        return Error(
            ErrorCode::NotReady,
            "the robot is at the end of its path, or was placed beside it; restart: true begins again");
    return {};
}

Result<void> Simulator::place(const Call &call) {
    if (worldPath_.isEmpty())
        return Error(ErrorCode::NotReady, "no world is loaded; sim.load loads one");
    const Pose2D pose{call.number("x"), call.number("y"), vectorlib::wrapAngle(call.number("theta"))};
    pump_.with([&](Simulation &simulation) { simulation.place(pose); });
    return {};
}

Result<void> Simulator::setNoise(const Call &call) {
    if (worldPath_.isEmpty())
        return Error(ErrorCode::NotReady, "no world is loaded; sim.load loads one");
    pump_.with([&](Simulation &simulation) {
        simulation.changeLidars([&](LidarModel &lidar) {
            if (call.has("sigma_m"))
                lidar.setSigma(call.number("sigma_m"));
            if (call.has("dropouts"))
                lidar.setDropouts(call.number("dropouts"));
            if (call.has("outliers"))
                lidar.setOutliers(call.number("outliers"));
        });
        if (call.has("gps_sigma_m"))
            simulation.gps().setSigma(call.number("gps_sigma_m"));
    });
    return {};
}

Result<void> Simulator::setFault(const Call &call) {
    const std::string name = settings().text("motors.kind").toStdString();
    const MotorKind &motors = motorKind(name);
    if (const QString wrong = faultMismatch(call.text("device"), call.text("kind"), motors); !wrong.isEmpty())
        return invalidParams({{"kind", call.value("kind"), "a fault of this device"}}, wrong);
    if (call.text("device") == "gps" || call.text("device") == "scanner")
        return setSensorFault(call);
    if (call.text("device") != "lidar")
        return setMotorFault(call);
    LidarFault fault;
    const QString kind = call.text("kind");
    if (kind == "silence")
        fault.kind = LidarFault::Kind::Silence;
    if (kind == "loss")
        fault = {LidarFault::Kind::Loss, call.number("share")};
    pump_.setFault(fault);
    logInfo("simulator", "fault of the lidar: " + kind);
    return {};
}

SimulatorState Simulator::state() {
    SimulatorState state;
    state.world = worldPath_;
    pump_.with([&](Simulation &simulation) {
        const Simulation::Truth truth = simulation.truth();
        state.stamp = double(truth.stamp_ns) * 1e-9;
        state.pose = {truth.pose.x, truth.pose.y, truth.pose.theta};
        state.twist = truth.twist;
        state.progress = truth.progress;
        state.driving = truth.driving;
        state.finished = truth.finished;
        state.placed = simulation.isPlaced();
        state.touching = truth.touching;
        state.motors = motorState(simulation.drivetrain());
        state.lidar = simulation.lidar().options();
        state.scanner.revolutions = simulation.scanner() ? simulation.scanner()->revolutions() : 0;
    });
    state.motors.lines = lines_.state();
    state.gps = gpsLine_.state();
    state.scanner.model = scannerModel_;
    state.scanner.line = scannerLine_.state();
    const LidarFault fault = pump_.fault();
    state.fault = {toText(fault.kind), fault.share};
    state.packets = pump_.counts();
    return state;
}

void Simulator::publishTruth(const Simulation::Truth &truth) {
    publish(
        "truth", [&] { return messageOf(truth); }, double(truth.stamp_ns) * 1e-9);
}

void Simulator::updateHealth() {
    const PacketPump::Counts counts = pump_.counts();
    const LidarFault fault = pump_.fault();
    const quint64 failed = counts.sendErrors + counts.skipped;
    const QJsonObject values = asJson(counts).toObject();
    if (worldPath_.isEmpty())
        health().set(healthItem, HealthLevel::Warn,
                     "no world is loaded: the lidar sends no packets, and the motors have no power; sim.load "
                     "loads a world",
                     values);
    else if (fault.kind != LidarFault::Kind::None)
        health().set(healthItem, HealthLevel::Warn, "simulated fault: " + toText(fault.kind), values);
    else
        health().set(healthItem, faults_.level(double(failed)),
                     failed == 0
                         ? QString(settings().number("lidar.port") > 0 ? "sending" : "off: lidar.port is 0")
                         : QString("sending; %1 packets could not be sent, or not in time").arg(failed),
                     values);
}

} // namespace hermes::simulator
