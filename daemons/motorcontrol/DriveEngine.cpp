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
    drive_.configure(settings.drive);
    odometry_.setNoise(settings.odometry);
    tracker_.configure(settings.wheels, settings.countsPerTurn,
                       MotorController::overspeed * settings.pid.qpps * 2 * vectorlib::pi /
                           settings.countsPerTurn,
                       std::max(1.0, settings.serialTimeout_s + 0.5));
    faults_.configure(settings);
    for (const auto &controller : controllers_)
        controller->configure(settings);
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
        told.timeout_s = controller.timeout_s();
        told.rate_Hz = controller.rate_Hz().value_or(0);
        told.readings = controller.readings();
        told.overruns = controller.overruns();
    }
}

void DriveEngine::trackWheels(double now) {
    const auto motion =
        tracker_.update({&controllers_.front()->readings(), &controllers_.back()->readings()});
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
    telemetry_.twist = settings_.drive.layout.twist(motion->speeds);
    telemetry_.slip = settings_.drive.layout.slip(motion->speeds);
    odometry_.move(settings_.drive.layout.twist(motion->turns));
    if (!motion->plausible) {
        ++telemetry_.counterJumps;
        odometry_.doubt(0.1, 0.1);
    }
    // Neither the control of the velocity nor a standstill is to be trusted where an encoder is not.
    const auto disobey = faults_.judgeWheels(sent_, motion->speeds, drive_, now);
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
        speeds[wheel.controller][wheel.motor] =
            qint32(std::lround(wheel.sign * setPoint[i] * countsPerRadian));
    }
    for (std::size_t i = 0; i < controllers_.size(); ++i)
        controllers_[i]->command(speeds[i]);
    sent_ = setPoint;
}

Telemetry &DriveEngine::report() {
    for (std::size_t i = 0; i < controllers_.size(); ++i)
        telemetry_.controllers[i].stands = controllers_[i]->stands();
    telemetry_.pose = odometry_.pose();
    telemetry_.covariance = odometry_.covariance();
    telemetry_.target = drive_.target();
    telemetry_.setPoint = drive_.setPoint();
    telemetry_.haltCause = drive_.haltCause();
    telemetry_.haltReason = drive_.haltReason();
    telemetry_.latch = drive_.latch();
    telemetry_.lease = drive_.lease();
    return telemetry_;
}

} // namespace hermes::motorcontrol
