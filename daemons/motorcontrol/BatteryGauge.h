#pragma once

#include "common/Result.h"
#include "protocol/messages/Motors.h"

namespace hermes::motorcontrol {

/// What is measured of the battery at one time. Not measured: what computers and sensors draw.
struct BatteryReading {
    std::vector<double> voltages; ///< V, at each controller
    double motors_a = 0;          ///< what the bridges of all motors take from the battery
};

/// How much charge a battery holds, and how long that lasts (thesis 4.1.2: an hour of operation). While the
/// motors rest the voltage tells the charge, roughly; from there on the currents are counted, and each rest
/// corrects the count slowly. Both are known with a standard deviation only, and so is what they tell. Of
/// several voltages the lowest one counts, and none where they cannot all be true.
class BatteryGauge {
public:
    struct Settings {
        double capacity_Ah = 26;
        double full_v = 25.4, empty_v = 23.4; ///< at rest; between them the charge grows evenly
        double idle_a = 2;                    ///< of computers and sensors
        double reserve = 0.2;                 ///< share of the capacity that is to be left
    };

    /// What is known of the charge is forgotten where these are those of another battery.
    void configure(const Settings &settings);
    /// now: seconds of a clock that never jumps and goes on while the machine sleeps. An error where there is
    /// no reading says why.
    void take(double now, const Result<BatteryReading> &reading);
    const BatteryState &state() const { return state_; }
    /// Why there is no reading that can be true; empty when there is one.
    const QString &missing() const { return missing_; }

private:
    struct Estimate {
        double mean, deviation; ///< share of the capacity
    };

    void forget();
    QString faultOf(const BatteryReading &reading, double seconds);
    void count(double current, double seconds);
    void correct(double voltage, double seconds);
    void tell();

    Settings settings_;
    std::optional<Estimate> charge_;
    std::optional<double> last_;     ///< time of the last call
    std::optional<double> motors_a_; ///< smoothed
    double rested_s_ = 0;
    double differing_s_ = 0; ///< since the voltages agreed
    double unseen_s_ = 0;    ///< since the last reading
    QString missing_;
    BatteryState state_;
};

} // namespace hermes::motorcontrol
