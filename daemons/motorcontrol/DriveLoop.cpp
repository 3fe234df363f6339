#include "daemons/motorcontrol/DriveLoop.h"

#include "common/Log.h"
#include "common/Realtime.h"
#include "common/Time.h"
#include "common/interface/InterfaceRegistry.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>

namespace hermes {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double overspeed = 1.5; // times full duty: faster no wheel turns
constexpr int realtimePriority = 20;
constexpr double shutdown_s = 0.15; // for the last set-point

const QString source = "drive";

} // namespace

DriveLoop::DriveLoop(Listener listener)
    : listener_(std::move(listener))
    , timer_([this] { cycle(); }, this) {}

Result<void> DriveLoop::start(const MotorSettings &settings) {
    settings_ = settings;
    telemetry_.realtime = becomeRealtime(realtimePriority);
    for (int i = 0; i < controllerCount; ++i)
        controllers_.push_back(std::make_unique<MotorController>(i + 1, settings.controllers[i]));
    configure(settings);
    const auto opened = openLines();
    if (!opened)
        return opened;
    if (!timer_.start(period))
        return Error(ErrorCode::InternalError,
                     QString("the system gives no timer: %1").arg(std::strerror(errno)));
    return {};
}

Result<void> DriveLoop::openLines() {
    for (int i = 0; i < controllerCount; ++i) {
        if (lineOf_[i])
            continue;
        const QString url = settings_.controllers[i].url;
        const auto parsed = InterfaceUrl::parse(url);
        const auto interface = parsed ? makeInterface(*parsed, nullptr) : Result<Interface *>(parsed.error());
        if (!interface)
            return Error(ErrorCode::InvalidSetting,
                         QString("controllers.%1.url: %2").arg(i + 1).arg(interface.error().message));
        std::vector<MotorController *> onLine;
        for (int k = i; k < controllerCount; ++k) {
            if (settings_.controllers[k].url == url)
                onLine.push_back(controllers_[k].get());
        }
        lines_.push_back(new ControllerLine(*interface, onLine, this));
        for (int k = i; k < controllerCount; ++k) {
            if (settings_.controllers[k].url == url)
                lineOf_[k] = lines_.back();
        }
        lines_.back()->open();
    }
    return {};
}

void DriveLoop::configure(const MotorSettings &settings) {
    settings_ = settings;
    drive_.configure(settings.drive);
    odometry_.setNoise(settings.odometry);
    tracker_.configure(settings.wheels, settings.countsPerTurn,
                       overspeed * settings.pid.qpps * 2 * pi / settings.countsPerTurn);
    faults_.configure(settings);
    for (const auto &controller : controllers_)
        controller->configure(settings);
    obey();
}

void DriveLoop::shutDown(std::function<void()> done) {
    drive_.setNotReady("the daemon is stopping");
    if (!timer_.isRunning())
        return done();
    done_ = std::move(done);
    doneLatest_ = monotonicNow() + shutdown_s;
    send({});
}

void DriveLoop::obey() {
    if (drive_.setPoint() == WheelValues{} && sent_ != WheelValues{})
        send({});
    telemetry_.moved = false;
    report();
}

void DriveLoop::cycle() {
    const double now = monotonicNow();
    for (const auto &controller : controllers_)
        controller->beginCycle(now);
    updateReadiness();
    takeReadings(now);
    faults_.judgeControllers(telemetry_, drive_, now);
    send(drive_.step(now));
    report();
    const bool allObeyed = std::all_of(controllers_.begin(), controllers_.end(),
                                       [](const auto &c) { return !c->isReady() || c->hasObeyed(); });
    if (done_ && (allObeyed || now > doneLatest_)) {
        timer_.stop();
        std::exchange(done_, {})();
    }
}

void DriveLoop::updateReadiness() {
    if (done_)
        return;
    for (const auto &controller : controllers_) {
        if (!controller->isReady())
            return drive_.setNotReady(controller->name() + ": " + controller->error());
    }
    drive_.setReady();
}

void DriveLoop::takeReadings(double now) {
    for (int i = 0; i < controllerCount; ++i) {
        const MotorController &controller = *controllers_[i];
        Telemetry::Controller &told = telemetry_.controllers[i];
        told = {controller.name(),
                controller.error(),
                controller.version(),
                lineOf_[i]->interface().name(),
                controller.isReady(),
                controller.readings(),
                lineOf_[i]->counts(controller),
                lineOf_[i]->strayBytes(),
                controller.overruns()};
    }
    const auto motion = tracker_.update({&controllers_[0]->readings(), &controllers_[1]->readings()});
    telemetry_.moved = motion.has_value();
    if (!motion) {
        if (now - telemetry_.mono > MotorController::lostAfter_s)
            faults_.forgetWheels();
        return;
    }
    telemetry_.mono = motion->time;
    telemetry_.stamp = stampNow() - (now - motion->time);
    telemetry_.speeds = motion->speeds;
    for (int i = 0; i < wheelCount; ++i)
        telemetry_.turns[i] += motion->turns[i];
    telemetry_.twist = settings_.drive.layout.twist(motion->speeds);
    telemetry_.slip = settings_.drive.layout.slip(motion->speeds);
    odometry_.move(settings_.drive.layout.twist(motion->turns));
    if (!motion->plausible) {
        ++telemetry_.counterJumps;
        odometry_.doubt(0.1, 0.1);
        logWarning(source, "a controller has lost its counts; the odometry goes on from where it was");
    }
    faults_.judgeWheels(sent_, motion->speeds, drive_, now);
}

void DriveLoop::send(const WheelValues &setPoint) {
    const double countsPerRadian = settings_.countsPerTurn / (2 * pi);
    const auto acceleration =
        quint32(std::llround(settings_.emergencyDeceleration / settings_.wheelRadius * countsPerRadian));
    std::array<std::array<qint32, 2>, controllerCount> speeds{};
    for (int i = 0; i < wheelCount; ++i) {
        const WheelMount &wheel = settings_.wheels[i];
        speeds[wheel.controller][wheel.motor] =
            qint32(std::lround(wheel.sign * setPoint[i] * countsPerRadian));
    }
    for (int i = 0; i < controllerCount; ++i)
        controllers_[i]->command(speeds[i], acceleration);
    sent_ = setPoint;
    for (ControllerLine *line : lines_)
        line->wake();
}

void DriveLoop::report() {
    telemetry_.pose = odometry_.pose();
    telemetry_.covariance = odometry_.covariance();
    telemetry_.target = drive_.target();
    telemetry_.setPoint = drive_.setPoint();
    telemetry_.cycle = timer_.statistics();
    telemetry_.haltReason = drive_.haltReason();
    telemetry_.latch = drive_.latch().toJson();
    telemetry_.lease = drive_.lease().state(monotonicNow());
    listener_(telemetry_);
}

} // namespace hermes
