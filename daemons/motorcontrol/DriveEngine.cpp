#include "daemons/motorcontrol/DriveEngine.h"

#include "vectorlib/geometry/Angle.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hermes::motorcontrol {
DriveEngine::DriveEngine(const MotorSettings &settings) {
    telemetry_.controllers.count = settings.controllers.size();
    for (std::size_t i = 0; i < settings.controllers.size(); ++i) {
        const auto onLine =
            std::count_if(settings.controllers.begin(), settings.controllers.end(),
                          [&](const auto &c) { return c.url == settings.controllers[i].url; });
        controllers_.push_back(
            std::make_unique<MotorController>(int(i) + 1, settings.controllers[i], int(onLine)));
        telemetry_.controllers[i].name = controllers_.back()->name();
    }
    configure(settings);
}

void DriveEngine::configure(const MotorSettings &settings) {
    settings_ = settings;
    telemetry_.unopened =
        settings.areOthersSet ? "other controllers are set, which are opened at the next start" : "";
    for (WheelMount &wheel : settings_.wheels) {
        if (wheel.sign == 0 || wheel.controller < controllers())
            continue;
        telemetry_.unopened = QString("the wheels need controller %1, which is opened at the next start")
                                  .arg(wheel.controller + 1);
        wheel = WheelMount::none();
    }
    drive_.configure(settings.drive);
    odometry_.setNoise(settings.odometry);
    tracker_.configure(settings_.wheels, settings.countsPerTurn,
                       MotorController::overspeed * settings.pid.qpps * 2 * vectorlib::pi /
                           settings.countsPerTurn,
                       std::max(1.0, settings.serialTimeout_s + 0.5));
    faults_.configure(settings);
    for (const auto &controller : controllers_)
        controller->configure(settings);
    if (retired_)
        return;
    drive_.setReady(); // that the settings were changed does not hide what stands in the way
    updateReadiness();
}

void DriveEngine::retire(const QString &why) {
    drive_.setNotReady(why, "shutdown");
    retired_ = true;
    stand();
}

bool DriveEngine::obey() {
    telemetry_.moved = false;
    const bool halts = drive_.setPoint() == WheelValues{} && sent_ != WheelValues{};
    if (halts)
        stand();
    return halts;
}

void DriveEngine::cycle(double now) {
    for (const auto &controller : controllers_)
        controller->beginCycle(now);
    updateReadiness();
    takeReadings();
    trackWheels(now);
    faults_.judgeControllers(telemetry_, drive_, now);
    judgeObedience();
    command(drive_.step(now));
}

bool DriveEngine::hasObeyed() const {
    return std::all_of(controllers_.begin(), controllers_.end(),
                       [](const auto &c) { return c->hasObeyed(); });
}

void DriveEngine::updateReadiness() {
    if (retired_)
        return;
    if (!telemetry_.unopened.isEmpty())
        return drive_.setNotReady(telemetry_.unopened);
    for (const auto &controller : controllers_) {
        if (!controller->isReady())
            return drive_.setNotReady(controller->name() + ": " + controller->error());
        if (controller->isTooSlow())
            return drive_.setNotReady(controller->name() +
                                      QString(": its line gives less than %1 set-points a second")
                                          .arg(MotorController::leastRate_Hz));
    }
    drive_.setReady();
}

void DriveEngine::judgeObedience() {
    for (std::size_t i = 0; i < controllers_.size(); ++i) {
        const QString disobedience = controllers_[i]->takeDisobedience();
        if (!disobedience.isEmpty())
            drive_.fault(QString("controller_%1").arg(i + 1), controllers_[i]->name() + ": " + disobedience);
    }
    if (std::exchange(resets_, drive_.resets()) == drive_.resets())
        return;
    faults_.forgetWheels();
    for (const auto &controller : controllers_) // whatever has latched again by what was read before
        controller->release();
}

void DriveEngine::takeReadings() {
    for (std::size_t i = 0; i < controllers_.size(); ++i) {
        const MotorController &controller = *controllers_[i];
        Telemetry::Controller &told = telemetry_.controllers[i];
        told.error = controller.error();
        told.version = controller.version();
        told.ready = controller.isReady();
        const drive::DeviceTimeout timeout = controller.timeout();
        told.timeout_s = std::isinf(timeout.seconds) ? std::nullopt : std::optional(timeout.seconds);
        told.coasts = timeout.coasts;
        told.rate_Hz = controller.rate_Hz().value_or(0);
        told.readings = controller.readings();
        told.overruns = controller.overruns();
    }
}

void DriveEngine::trackWheels(double now) {
    std::array<const drive::Readings *, controllerCount> readings{};
    std::transform(controllers_.begin(), controllers_.end(), readings.begin(),
                   [](const auto &controller) { return &controller->readings(); });
    const auto motion = tracker_.update(readings);
    telemetry_.moved = motion.has_value();
    if (!motion) {
        if (now - telemetry_.mono > MotorController::lostAfter_s)
            faults_.skipWheels();
        return;
    }
    telemetry_.mono = motion->time;
    telemetry_.speeds = motion->speeds;
    for (int i = 0; i < wheelCount; ++i)
        telemetry_.turns[i] += motion->turns[i];
    const WheelLayout &layout = settings_.drive.layout;
    telemetry_.twist = layout.twist(motion->speeds, steered_);
    telemetry_.slip = layout.slip(motion->speeds, steered_);
    odometry_.move(layout.twist(motion->turns, steered_));
    if (!motion->plausible) {
        ++telemetry_.counterJumps;
        odometry_.doubt(0.1, 0.1);
    }
    WheelValues duties{};
    for (int i = 0; i < wheelCount; ++i) {
        const WheelMount &wheel = settings_.wheels[i];
        if (wheel.sign == 0)
            continue;
        if (const auto duty = controllers_[wheel.controller]->freshDuty())
            duties[i] = (*duty)[wheel.motor];
    }
    // Neither the control of the velocity nor a standstill is to be trusted where an encoder is not.
    const auto disobey = faults_.judgeWheels(sent_, motion->speeds, duties, drive_, now);
    for (int i = 0; i < wheelCount; ++i) {
        if (!disobey[i].isEmpty())
            controllers_[settings_.wheels[i].controller]->bar("is barred: " + disobey[i]);
    }
}

void DriveEngine::command(const WheelValues &setPoint) {
    const double countsPerRadian = settings_.countsPerTurn / (2 * vectorlib::pi);
    std::array<std::array<qint32, 2>, controllerCount> speeds{};
    for (int i = 0; i < wheelCount; ++i) {
        const WheelMount &wheel = settings_.wheels[i];
        if (wheel.sign == 0)
            continue;
        speeds[wheel.controller][wheel.motor] =
            qint32(std::lround(wheel.sign * setPoint[i] * countsPerRadian));
    }
    for (std::size_t i = 0; i < controllers_.size(); ++i)
        controllers_[i]->command(speeds[i], settings_.servoAt(drive_.steering()));
    sent_ = setPoint;
    steered_ = std::exchange(steering_, drive_.steering());
}

Telemetry &DriveEngine::report() {
    bool stand = true;
    for (std::size_t i = 0; i < controllers_.size(); ++i) {
        stand &= telemetry_.controllers[i].stands = controllers_[i]->stands();
        telemetry_.controllers[i].mayTurn = controllers_[i]->mayTurn();
    }
    if (stand && !telemetry_.moved) { // they are not set up: their counts are no way, but are seen to rest
        telemetry_.speeds = {};
        telemetry_.twist = {};
        telemetry_.slip = 0;
    }
    telemetry_.pose = odometry_.pose();
    telemetry_.covariance = odometry_.covariance();
    telemetry_.target = drive_.target();
    telemetry_.setPoint = drive_.setPoint();
    telemetry_.targetSteering = drive_.targetSteering();
    telemetry_.steering = drive_.steering();
    telemetry_.haltCause = drive_.haltCause();
    telemetry_.haltReason = drive_.haltReason();
    telemetry_.latch = drive_.latch();
    telemetry_.lease = drive_.lease();
    return telemetry_;
}

} // namespace hermes::motorcontrol
