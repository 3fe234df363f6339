#include "daemons/motorcontrol/FaultWatch.h"

#include "protocol/roboclaw/Status.h"

#include <algorithm>
#include <cmath>

namespace hermes::motorcontrol {
namespace {

using Level = Threshold::Level;

QStringList statusErrors(quint32 status) {
    QStringList texts;
    for (quint32 bit = 1; bit & roboclaw::statusErrors; bit <<= 1) {
        if (status & bit)
            texts.append(roboclaw::statusText(bit));
    }
    return texts;
}

} // namespace

void FaultWatch::configure(const MotorSettings &settings) {
    for (Controller &controller : controllers_) {
        controller.battery.set(settings.battery);
        controller.temperature.set(settings.temperature);
        for (Threshold &current : controller.current)
            current.set(settings.current);
    }
    for (EncoderMonitor &encoder : encoders_)
        encoder.set(settings.encoder);
}

void FaultWatch::judgeControllers(Telemetry &telemetry, Drive &drive, double now) {
    telemetry.levels = {};
    for (std::size_t i = 0; i < telemetry.controllers.size(); ++i) {
        const Telemetry::Controller &told = telemetry.controllers[i];
        if (!told.ready || !told.readings.complete)
            continue;
        Controller &watch = controllers_[i];
        const auto judge = [&](int item, Threshold &threshold, double value, const char *fault,
                               const auto &text) {
            const Level level = threshold.judge(value, now);
            telemetry.levels[item] = std::max(telemetry.levels[item], level);
            if (level == Level::Fault)
                drive.fault(fault, QString("%1: %2").arg(told.name, text()));
        };
        const drive::Readings &r = told.readings;
        judge(0, watch.battery, r.battery_v, "battery", [&] {
            return QString("the battery has %1 V, at least %2 V are needed")
                .arg(r.battery_v)
                .arg(watch.battery.settings().fault);
        });
        for (int motor = 0; motor < 2; ++motor)
            judge(1, watch.current[motor], std::abs(r.current_a[motor]), "current", [&] {
                return QString("M%1 draws %2 A, at most %3 A are allowed")
                    .arg(motor + 1)
                    .arg(r.current_a[motor])
                    .arg(watch.current[motor].settings().fault);
            });
        judge(2, watch.temperature, r.temperature_c, "temperature", [&] {
            return QString("%1 degrees Celsius, at most %2 are allowed")
                .arg(r.temperature_c)
                .arg(watch.temperature.settings().fault);
        });
        QStringList errors = statusErrors(r.status);
        for (int motor = 0; motor < 2; ++motor)
            if (const char *const fault = r.faults[motor])
                errors.append(QString("M%1: %2").arg(motor + 1).arg(fault));
        if (!errors.isEmpty())
            drive.fault(QString("controller_%1").arg(i + 1),
                        QString("%1 reports: %2").arg(told.name, errors.join(", ")));
    }
}

std::array<QString, wheelCount> FaultWatch::judgeWheels(const WheelValues &setPoint,
                                                        const WheelValues &speeds, const WheelValues &duties,
                                                        Drive &drive, double now) {
    std::array<QString, wheelCount> texts;
    for (int i = 0; i < wheelCount; ++i) {
        const auto mismatch = encoders_[i].judge(setPoint[i], speeds[i], now, duties[i]);
        if (mismatch == EncoderMonitor::Mismatch::None)
            continue;
        texts[i] = QString("wheel %1 %2 (%3 rad/s told, %4 rad/s measured)")
                       .arg(wheelNames[i], toText(mismatch))
                       .arg(setPoint[i], 0, 'g', 3)
                       .arg(speeds[i], 0, 'g', 3);
        drive.fault("encoder", texts[i]);
    }
    return texts;
}

void FaultWatch::skipWheels() {
    for (EncoderMonitor &encoder : encoders_)
        encoder.skip();
}

void FaultWatch::forgetWheels() {
    for (EncoderMonitor &encoder : encoders_)
        encoder.forget();
}

} // namespace hermes::motorcontrol
