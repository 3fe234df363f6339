#include "daemons/ros2/Ros2.h"

#include "common/Log.h"
#include "common/OwnRobot.h"
#include "common/Project.h"
#include "common/client/DaemonAddress.h"
#include "common/settings/SettingsTable.h"
#include "protocol/ros/Definition.h"

#include <QHostInfo>
#include <cmath>

namespace hermes::ros2 {
namespace {

constexpr std::chrono::milliseconds healthPeriod{1000}, pollPeriod{100};
constexpr int maxWaits = 50;           // for a map
const Quality newest{false, false, 1}; // matches whoever offers at least that
const Quality repeated{true, false, 10};

const QStringList graphForms{"auto", "humble", "jazzy", "none"};

GraphForm graphFormOf(const QString &text) {
    const int index = graphForms.indexOf(text);
    constexpr GraphForm forms[] = {GraphForm::Auto, GraphForm::Humble, GraphForm::Jazzy, GraphForm::None};
    return forms[std::max(0, index)];
}

/// The heading of what lies in the plane.
double headingOf(const ros::Quaternion &q) {
    return std::atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z));
}

} // namespace

Ros2::Ros2()
    : Daemon({"ros2", "ROS 2 bridge",
              "Tells ROS 2 what the robot tells, by DDS, and takes its commands: scans, odometry, frames, "
              "map, health; "
              "cmd_vel when it is allowed"})
    , daemons_(ownRobot().value_or(RobotIdentity()).id) {
    declareSettings();
    connect(&looks_, &QTimer::timeout, this, &Ros2::updateHealth);
}

Ros2::~Ros2() {
    stop();
}

void Ros2::declareSettings() {
    using Applies = SettingsTable::Applies;
    const QJsonObject text{{"type", "string"}, {"maxLength", 200}};
    SettingsTable table;
    table.group("Robot", Applies::OnRestart);
    table.defineList("daemons",
                     "Addresses of the daemons that are told to ROS, and of supervisors, whose daemons are. "
                     "Empty: those of this host",
                     text);
    table.define("namespace", "", "Of all topics and of the node, for several robots: robot1")
        .with("pattern", "^$|^[A-Za-z_][A-Za-z0-9_]*(/[A-Za-z_][A-Za-z0-9_]*)*$");
    table.define("frame_prefix", "", "Of all frames, for several robots: robot1/")
        .with("pattern", "^[A-Za-z0-9_/]{0,100}$");
    table.define("replays", false,
                 "Tells what the robot's daemons replay, and nothing else, with /clock: for a second "
                 "hermes-ros2 with a domain "
                 "or namespace of its own");
    table.group("Network", Applies::OnRestart);
    table.define("domain", 0, "ROS_DOMAIN_ID: only nodes with the same one see each other", "", 0, 232);
    table.defineList("networks",
                     "Names or addresses of the interfaces on which the robot is told to everybody. Empty: "
                     "to this host alone",
                     text);
    table.defineList("peers", "Hosts that are asked for where the network has no multicast", text);
    table.define("fragment_bytes", 63000,
                 "Of a message in one datagram. Large ones suit wires and readers with small buffers; 1300 "
                 "suits a bad wireless network",
                 "byte", 1024, 63000);
    table
        .define("graph", "auto",
                "Form of the node for `ros2 node list`: humble, or jazzy from Iron on; auto: that of "
                "other nodes, once there is one")
        .choices(graphForms);
    table.define(
        "enclave", "",
        "Folder of an enclave of SROS2, KEYSTORE/enclaves/NAME: only nodes with keys of that store see the "
        "robot, and do what their permissions say. Empty: everybody on the networks does");
    table.group("Commands", Applies::OnRestart);
    table.define("commands", false,
                 "Nodes may move the robot by cmd_vel and tell its place by initialpose. Everybody on the "
                 "network can then");
    table.declareIn(settings());
}

Bridge::Options Ros2::options() {
    Bridge::Options options;
    const QJsonObject values = settings().values();
    options.network.domain = int(settings().integer("domain"));
    options.network.networks = values["networks"].toVariant().toStringList();
    options.network.peers = values["peers"].toVariant().toStringList();
    options.network.fragmentBytes = int(settings().integer("fragment_bytes"));
    options.network.enclave = settings().text("enclave");
    options.graph = graphFormOf(settings().text("graph"));
    const QString space = settings().text("namespace");
    options.space = space.isEmpty() ? QString() : '/' + space;
    options.framePrefix = settings().text("frame_prefix");
    options.tellsReplays = settings().flag("replays");
    return options;
}

Result<void> Ros2::start() {
    server().gaps().watch(VelocityCommands::maxAge_s);
    auto bridge = Bridge::open(options(), daemons_);
    if (!bridge)
        return bridge.error();
    bridge_ = bridge.take();
    velocity_ = std::make_unique<VelocityCommands>(daemons_, server().gaps());
    if (const Result<void> listening = listenToRos(); !listening)
        return listening;
    if (const Result<void> serving = serve(); !serving)
        return serving;
    follow();
    lookForPeers();
    looks_.start(healthPeriod);
    setState(DaemonState::Running);
    updateHealth();
    return {};
}

void Ros2::stop() {
    looks_.stop();
    readers_.clear();
    triggers_.clear();
    getMap_.reset();
    velocity_.reset();
    bridge_.reset();
    daemons_.follow({});
}

void Ros2::lookForPeers() {
    for (const QString &peer : options().network.peers)
        QHostInfo::lookupHost(peer, this, [this, peer](const QHostInfo &found) {
            if (found.error() != QHostInfo::NoError)
                health().set("peers", HealthLevel::Warn,
                             QString("%1: %2; it is asked for again at the next start")
                                 .arg(peer, found.errorString()));
        });
}

void Ros2::follow() {
    QStringList addresses;
    for (const QString &one : settings().values()["daemons"].toVariant().toStringList())
        if (const Result<QString> address = daemonAddress(one))
            addresses.append(*address);
        else
            logWarning("daemons", address.error().message);
    if (addresses.isEmpty())
        for (const QString &name : daemonNames())
            if (name != identity().name)
                addresses.append(*daemonAddress(name));
    daemons_.follow(addresses);
}

template <typename M>
Result<void> Ros2::read(const char *topic, const Quality &quality,
                        void (Ros2::*take)(const M &message, const Reader::Sample &sample)) {
    const QString name = bridge_->ddsTopic(QLatin1String(topic));
    const auto received = [this, take, name](const Reader::Sample &sample) {
        if (const auto message = ros::fromCdr<M>(sample.cdr))
            return (this->*take)(*message, sample);
        else
            lastUnreadable_ = name + ": " + QString::fromStdString(message.error());
        ++unreadable_;
    };
    auto reader = bridge_->participant().read(name, ros::typeOf<M>(), quality, received,
                                              "typehash=" + ros::typeHash(ros::hashedTextOf<M>()) + ';');
    if (!reader)
        return reader.error();
    bridge_->addEndpoints({(*reader)->guid()}, {});
    readers_.push_back(reader.take());
    return {};
}

/// A stop counts from writers of both kinds: one that repeats what is lost, and one that does not.
Result<void> Ros2::listenToRos() {
    for (const Result<void> &made :
         {read("cmd_vel", newest, &Ros2::takeTwist), read("cmd_vel", newest, &Ros2::takeTwistStamped),
          read("initialpose", newest, &Ros2::takePose), read("emergency_stop", newest, &Ros2::takeStop),
          read("emergency_stop", repeated, &Ros2::takeStop)})
        if (!made)
            return made;
    return {};
}

bool Ros2::mayCommand(const char *topic, const Guid &writer) {
    if (settings().flag("commands") && !settings().flag("replays"))
        return true;
    if (forbidden_++ == 0)
        logWarning("ros", QString("%1 of %2 is refused: the setting \"commands\" is false")
                              .arg(QLatin1String(topic), nodeOf(writer)));
    return false;
}

QString Ros2::nodeOf(const Guid &writer) const {
    const QString node = bridge_->graph().nodeOf(writer);
    return node.isEmpty() ? "a ROS node without a name" : "ROS " + node;
}

void Ros2::takeTwist(const ros::Twist &twist, const Reader::Sample &sample) {
    if (mayCommand("cmd_vel", sample.writer))
        velocity_->take({twist.linear.x, twist.linear.y, twist.angular.z}, sample.writer, sample.stamp,
                        sample.age_s, nodeOf(sample.writer));
}

/// Its stamp is the time when it was made; often it is 0, which tells nothing.
void Ros2::takeTwistStamped(const ros::TwistStamped &twist, const Reader::Sample &sample) {
    const ros::Time made = twist.header.stamp;
    const double age_s =
        made.sec == 0 && made.nanosec == 0 ? 0 : sample.stamp - (made.sec + made.nanosec * 1e-9);
    Reader::Sample stamped = sample;
    stamped.age_s = age_s;
    takeTwist(twist.twist, stamped);
}

void Ros2::takePose(const ros::PoseWithCovarianceStamped &pose, const Reader::Sample &sample) {
    if (!mayCommand("initialpose", sample.writer))
        return;
    if (pose.header.frameId != bridge_->robot().mapFrame()) {
        logWarning("ros", QString("initialpose is in the frame \"%1\", expected \"%2\"")
                              .arg(QString::fromStdString(pose.header.frameId).left(100),
                                   QString::fromStdString(bridge_->robot().mapFrame())));
        return;
    }
    const ros::Pose &at = pose.pose.pose;
    const ros::Mount mount = bridge_->robot().matchedMount().value_or(ros::Mount());
    const Pose2D sensor = Pose2D{at.position.x, at.position.y, headingOf(at.orientation)} * mount.pose;
    if (!(std::isfinite(sensor.x) && std::isfinite(sensor.y) && std::isfinite(sensor.theta)))
        return logWarning("ros", "initialpose is no finite pose");
    call("pose.set", {{"x", sensor.x}, {"y", sensor.y}, {"theta", sensor.theta}},
         [who = nodeOf(sample.writer)](const Result<QJsonValue> &result) {
             if (!result)
                 logWarning("ros", "initialpose of " + who + ": " + result.error().message);
         });
}

/// Anyone may stop; only people release, with Hermes' own tools.
void Ros2::takeStop(const ros::Bool &stop, const Reader::Sample &sample) {
    if (!stop.data)
        return;
    const QString who = nodeOf(sample.writer);
    if (Client *const client = motorControl(daemons_))
        client->call(
            "motor.estop", {{"client", who.left(100)}},
            [](const Result<QJsonValue> &result) {
                if (!result)
                    logError("ros", "the emergency stop was not carried out: " + result.error().message);
            },
            Client::defaultTimeout, Client::Repeats::AtOnce);
    else
        logError("ros", "an emergency stop of " + who + ": no motor control answers");
}

void Ros2::call(const QString &command, const QJsonObject &params, const Client::Callback &answered) {
    for (const auto &[address, daemon] : daemons_.all())
        if (daemon->isKnown && daemon->commands.contains(command))
            return daemon->client->call(command, params, answered);
    answered(Error(ErrorCode::NotReady, "no daemon of the robot answers that has " + command));
}

Result<void> Ros2::serveTrigger(const char *name, const QString &command, const QJsonObject &params,
                                bool isFree) {
    auto made = Trigger::open(
        *bridge_, QLatin1String(name),
        [this, name, command, params, isFree](const ros::TriggerRequest &, const Trigger::Answer &answer) {
            if (!isFree && !mayCommand(name, {}))
                return answer({false, "refused: the setting \"commands\" of hermes-ros2 is false"});
            call(command, params, [answer](const Result<QJsonValue> &result) {
                const QString text = result ? (*result)["path"].toString() : result.error().message;
                answer({result.ok(), text.toStdString()});
            });
        });
    if (!made)
        return made.error();
    triggers_.push_back(made.take());
    return {};
}

Result<void> Ros2::serve() {
    const QString name = "ros-map.csv";
    for (const Result<void> &made : {serveTrigger("stop", "motor.stop", {{"client", "a ROS service"}}, true),
                                     serveTrigger("reset_odometry", "odometry.reset", {}),
                                     serveTrigger("save_map", "map.save", {{"path", name}, {"force", true}})})
        if (!made)
            return made;
    auto map =
        GetMap::open(*bridge_, "get_map", [this](const ros::GetMapRequest &, const GetMap::Answer &answer) {
            answerMap(answer, maxWaits);
        });
    if (!map)
        return map.error();
    getMap_ = map.take();
    return {};
}

/// At the start there is none for a moment.
void Ros2::answerMap(const GetMap::Answer &answer, int waits) {
    const auto grid = ros::fromCdr<ros::OccupancyGrid>(bridge_ ? bridge_->latched("map") : std::string());
    if (grid || waits == 0)
        return answer({grid ? *grid : ros::OccupancyGrid()});
    QTimer::singleShot(pollPeriod, this, [this, answer, waits] { answerMap(answer, waits - 1); });
}

void Ros2::updateHealth() {
    const Bridge::Counts counts = bridge_->counts();
    int known = 0;
    for (const auto &[address, daemon] : daemons_.all())
        known += daemon->isKnown;
    health().set("daemons", known == 0 ? HealthLevel::Warn : HealthLevel::Ok,
                 known == 0 ? QString("no daemon of the robot answers")
                            : QString("%1 daemons are told").arg(known));
    health().set("ros", counts.unreadable + unreadable_ == 0 ? HealthLevel::Ok : HealthLevel::Warn,
                 counts.unreadable != 0 ? counts.lastProblem
                 : unreadable_ != 0
                     ? lastUnreadable_
                     : QString("%1 topics, %2 of them read").arg(counts.topics).arg(counts.read),
                 {{"topics", counts.topics},
                  {"read", counts.read},
                  {"written", double(counts.written)},
                  {"unreadable", double(counts.unreadable + unreadable_)},
                  {"left_out", double(counts.leftOut)},
                  {"dropped", double(counts.dropped)}});
    const bool mayCommand = settings().flag("commands");
    const VelocityCommands::Counts &taken = velocity_->counts();
    health().set("commands", velocity_->refusal().isEmpty() ? HealthLevel::Ok : HealthLevel::Warn,
                 !mayCommand ? QString("refused: the setting \"commands\" is false")
                 : !velocity_->refusal().isEmpty()
                     ? velocity_->node() + " does not move the robot: " + velocity_->refusal()
                 : velocity_->node().isEmpty() ? QString("none came")
                                               : "of " + velocity_->node(),
                 {{"taken", double(taken.taken)},
                  {"late", double(taken.late)},
                  {"others", double(taken.others)},
                  {"refused", double(taken.refused + forbidden_)}});
    if (mayCommand && settings().text("enclave").isEmpty() &&
        !settings().values()["networks"].toArray().isEmpty())
        health().set("insecure", HealthLevel::Warn,
                     "everybody on the networks " +
                         settings().values()["networks"].toVariant().toStringList().join(", ") +
                         " may move the robot (setting \"commands\")");
}

} // namespace hermes::ros2
