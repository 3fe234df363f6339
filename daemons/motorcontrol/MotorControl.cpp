#include "daemons/motorcontrol/MotorControl.h"

#include "common/Log.h"
#include "daemons/motorcontrol/MotorJson.h"

#include <algorithm>
#include <future>
#include <sys/resource.h>

namespace hermes {
namespace {

constexpr quint64 slowEvery = 5; // cycles between two messages of what changes slowly
constexpr std::chrono::milliseconds stopLimit{1000};
constexpr int niceness = -11; // where it may: what must stop the robot does not wait behind ordinary work

} // namespace

MotorControl::MotorControl()
    : Daemon({"motorcontrol", "Motor control",
              "Drives four wheels through two RoboClaw controllers, tells where they have brought the robot, "
              "and stops when anything breaks"}) {
    feedWatchdogMyself();
    declareMotorSettings([this](const Field &field) { addSetting(field); });
    settings().addRule(checkMotorSettings);
    declareTopics();
    declareMotorCommands();
    declareControlCommands();
    connect(this, &Daemon::clientGone, this, [this](quint64 client) {
        if (loop_)
            inLoop(
                [client](DriveLoop &loop) -> Result<QJsonValue> {
                    loop.drive().clientGone(client);
                    return QJsonValue();
                },
                Reply([](const Result<QJsonValue> &) {}));
    });
}

MotorControl::~MotorControl() {
    stop();
}

void MotorControl::declareTopics() {
    const QJsonObject object{{"type", "object"}};
    addTopic(Topic("odometry",
                   "After each cycle (50 Hz): pose {x, y (m), theta (rad)} since odometry.reset, twist "
                   "{vx, vy (m/s), omega (rad/s)} as measured, covariance of the pose, row by row; mono")
                 .schema(object));
    addTopic(Topic("wheels",
                   "After each cycle, of each wheel: target, set_point and speed (rad/s), angle (rad); "
                   "slip (m/s): what no motion of a rigid robot explains")
                 .schema(object));
    addTopic(Topic("power",
                   "10 Hz, of each controller: battery_v, logic_v, current_a of both motors, temperature_c, "
                   "status and what it means")
                 .schema(object));
}

Result<void> MotorControl::start() {
    active_ = MotorSettings::from(settings());
    // The drive loop also waits for locks of the event queue that this thread may hold.
    if (::getpriority(PRIO_PROCESS, 0) > niceness)
        ::setpriority(PRIO_PROCESS, 0, niceness);
    loop_ = new DriveLoop([this](const Telemetry &telemetry) {
        QMetaObject::invokeMethod(
            this, [this, telemetry] { show(telemetry); }, Qt::QueuedConnection);
    });
    loop_->moveToThread(&thread_);
    connect(&thread_, &QThread::finished, loop_, &QObject::deleteLater);
    thread_.setObjectName("drive");
    thread_.start();
    Result<void> outcome;
    QMetaObject::invokeMethod(
        loop_, [&] { outcome = loop_->start(active_); }, Qt::BlockingQueuedConnection);
    health().expectEvery("cycle", std::chrono::seconds(1));
    return outcome;
}

void MotorControl::stop() {
    if (!loop_)
        return;
    // Not a blocking call: the loop's thread must still run its event loop to see the answers.
    auto stood = std::make_shared<std::promise<void>>();
    std::future<void> standing = stood->get_future();
    QMetaObject::invokeMethod(
        loop_, [loop = loop_, stood] { loop->shutDown([stood] { stood->set_value(); }); },
        Qt::QueuedConnection);
    if (standing.wait_for(stopLimit) != std::future_status::ready)
        logError("motorcontrol", "the drive loop does not end; the controllers stop by their own time-out");
    thread_.quit();
    thread_.wait();
    loop_ = nullptr;
}

void MotorControl::settingsChanged(const QStringList &paths) {
    static const QStringList groups{"controllers.", "pid.",    "frame.",    "wheels.",
                                    "motion.",      "safety.", "odometry.", "faults."};
    const bool ours = std::any_of(paths.begin(), paths.end(), [](const QString &path) {
        return std::any_of(groups.begin(), groups.end(),
                           [&](const QString &g) { return path.startsWith(g); });
    });
    if (!loop_ || !ours)
        return;
    const auto places = active_.controllers; // wait for a restart
    active_ = MotorSettings::from(settings());
    active_.controllers = places;
    QMetaObject::invokeMethod(
        loop_, [loop = loop_, s = active_] { loop->configure(s); }, Qt::QueuedConnection);
}

void MotorControl::inLoop(const Work &work, const Reply &reply) {
    if (!loop_)
        return reply.error(Error(ErrorCode::NotReady, "the daemon is stopping"));
    QMetaObject::invokeMethod(
        loop_,
        [loop = loop_, work, reply] {
            const Result<QJsonValue> result = work(*loop);
            loop->obey();
            reply.give(result);
        },
        Qt::QueuedConnection);
}

void MotorControl::show(const Telemetry &telemetry) {
    told_ = telemetry;
    if (!telemetry.moved && cycles_ == telemetry.cycle.cycles)
        return; // a report between two cycles
    cycles_ = telemetry.cycle.cycles;
    if (telemetry.moved) {
        publish("odometry", odometryJson(telemetry), telemetry.stamp);
        publish("wheels", wheelsJson(telemetry), telemetry.stamp);
    }
    if (cycles_ % slowEvery == 0) {
        publish("power", powerJson(telemetry));
        updateHealth();
        feedWatchdog();
    }
}

} // namespace hermes
