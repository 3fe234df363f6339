#include "daemons/motorcontrol/BatteryGauge.h"

#include <algorithm>
#include <cmath>

namespace hermes::motorcontrol {
namespace {

constexpr double restCurrent = 1;     // A; motors that draw less count as resting
constexpr double restTime_s = 5;      // until the voltage is worth a look
constexpr double settling_s = 300;    // of the voltage after a load
constexpr double restDeviation = 0.1; // of the charge by the voltage, beside that of a voltage that settles
constexpr double settlingDeviation = 0.1;
constexpr double correction_s = 60;     // time constant with which a rest corrects the count
constexpr double countDeviation = 0.1;  // share of what was counted
constexpr double smoothing_s = 60;      // of the motors' current that the time left is told for
constexpr double steady_s = 1;          // between two readings; in a longer gap all may have happened
constexpr double forgetTime_s = 60;     // without a reading: it may be another battery
constexpr double unseenPerHour = 0.5;   // share of the capacity that may have been drawn unseen
constexpr double otherBattery = 2.5;    // standard deviations
constexpr double longest_s = 48 * 3600; // more is not told
constexpr double bearable_v = 34;       // data sheet of the RoboClaw 2x45A; others bear more
constexpr double overFull = 1.25;       // times the voltage of the full battery: no charger goes beyond
constexpr double agreement_v = 1;       // between two controllers: their errors, and what is lost in cables
constexpr double resolution_v = 0.1;    // of a controller
constexpr double differing_s = 1;       // so long they may differ: they are not read at the same time

} // namespace

void BatteryGauge::configure(const Settings &settings) {
    const bool isOther = settings.capacity_Ah != settings_.capacity_Ah ||
                         settings.full_v != settings_.full_v || settings.empty_v != settings_.empty_v;
    settings_ = settings;
    if (isOther)
        forget();
}

void BatteryGauge::forget() {
    charge_.reset();
    motors_a_.reset();
    rested_s_ = 0;
}

QString BatteryGauge::faultOf(const BatteryReading &reading, double seconds) {
    QStringList texts;
    for (std::size_t i = 0; i < reading.voltages.size(); ++i)
        texts.append(QString(i == 0 ? "controller %1 tells %2 V" : "controller %1 %2 V")
                         .arg(i + 1)
                         .arg(reading.voltages[i]));
    const QString told = texts.join(", ");
    const auto [lowest, highest] = std::minmax_element(reading.voltages.begin(), reading.voltages.end());
    const double most = std::max(bearable_v, overFull * settings_.full_v);
    const auto isPossible = [most](double voltage) { return voltage > 0 && voltage <= most; };
    if (!std::all_of(reading.voltages.begin(), reading.voltages.end(), isPossible))
        return told + QString(": expected more than 0 V, at most %1 V").arg(most);
    const bool differ = *highest - *lowest > agreement_v + resolution_v / 2;
    differing_s_ = differ ? differing_s_ + seconds : 0;
    if (differing_s_ > differing_s)
        return told + QString(": expected at most %1 V between them").arg(agreement_v);
    return std::isfinite(reading.motors_a) ? QString()
                                           : QString("a controller tells %1 A").arg(reading.motors_a);
}

void BatteryGauge::take(double now, const Result<BatteryReading> &reading) {
    const double seconds = last_ ? std::max(0.0, now - *last_) : 0;
    last_ = now;
    unseen_s_ += seconds;
    missing_ = reading ? faultOf(*reading, seconds) : reading.error().message;
    if (!missing_.isEmpty()) {
        rested_s_ = 0;
        return tell();
    }
    if (unseen_s_ > forgetTime_s)
        forget();
    const double motors_a = std::max(0.0, reading->motors_a), past_a = motors_a_.value_or(motors_a);
    motors_a_ = past_a + (1 - std::exp(-unseen_s_ / smoothing_s)) * (motors_a - past_a);
    const bool rests = std::abs(reading->motors_a) < restCurrent && differing_s_ == 0;
    rested_s_ = rests && unseen_s_ < steady_s ? rested_s_ + unseen_s_ : 0;
    if (charge_)
        count(settings_.idle_a + motors_a, unseen_s_);
    if (rests && rested_s_ >= restTime_s)
        correct(*std::min_element(reading->voltages.begin(), reading->voltages.end()), unseen_s_);
    unseen_s_ = 0;
    tell();
}

void BatteryGauge::count(double current, double seconds) {
    const double drawn = current * seconds / 3600 / settings_.capacity_Ah;
    const double blind = seconds < steady_s ? 0 : unseenPerHour * seconds / 3600;
    charge_->mean = std::max(0.0, charge_->mean - drawn);
    charge_->deviation = std::min(1.0, charge_->deviation + countDeviation * drawn + blind);
}

void BatteryGauge::correct(double voltage, double seconds) {
    const double span = settings_.full_v - settings_.empty_v;
    const Estimate byVoltage{std::clamp((voltage - settings_.empty_v) / span, 0.0, 1.0),
                             restDeviation + settlingDeviation * std::exp(-rested_s_ / settling_s)};
    const auto differs = [&] {
        return std::abs(byVoltage.mean - charge_->mean) >
               otherBattery * std::hypot(byVoltage.deviation, charge_->deviation);
    };
    if (!charge_ || differs())
        charge_ = byVoltage;
    if (charge_->deviation <= byVoltage.deviation)
        return; // the count is better
    const double share = 1 - std::exp(-seconds / correction_s);
    charge_->mean += share * (byVoltage.mean - charge_->mean);
    charge_->deviation += share * (byVoltage.deviation - charge_->deviation);
}

void BatteryGauge::tell() {
    state_ = {};
    state_.reason = missing_;
    if (!missing_.isEmpty())
        return;
    const double current = settings_.idle_a + *motors_a_;
    state_.current_a = current;
    if (!charge_) {
        state_.reason = QString("the motors must rest for %1 s first").arg(restTime_s);
        return;
    }
    state_.charge = charge_->mean;
    state_.chargeDeviation = charge_->deviation;
    const auto lasts = [&](double charge) {
        const double usable_Ah = std::max(0.0, charge - settings_.reserve) * settings_.capacity_Ah;
        return current * longest_s > usable_Ah * 3600 ? usable_Ah * 3600 / current : longest_s;
    };
    state_.left_s = lasts(charge_->mean);
    state_.leftLeast_s = lasts(charge_->mean - charge_->deviation);
}

} // namespace hermes::motorcontrol
