#pragma once

#include <array>

namespace hermes::motorcontrol {

/// Compares the speed that one wheel was told with what its encoder says. Speeds in rad/s, times in seconds
/// of a clock that never jumps.
///
/// A command explains the speeds between itself and those that came before it, as far as braking leads from
/// there; the two before it still count whole, for a wheel learns of a command and shows it a cycle late
/// each. The time of motion that no command explains adds up, whatever is wrong and whatever is commanded
/// meanwhile; only as much time in which the wheel was seen to follow takes it away.
class EncoderMonitor {
public:
    enum class Mismatch { None, StandsStill, MovesUncommanded, MovesBackwards, MovesTooFast };
    struct Settings {
        double commanded = 0.5;   ///< slower commands than this may leave the wheel standing: friction
        double moving = 0.25;     ///< slower than this counts as standing
        double hold_s = 0.5;      ///< so much unexplained motion is a fault; longer than braking takes
        double deceleration = 20; ///< rad/s^2, the least with which a wheel follows a slower command
    };

    void set(const Settings &settings) { settings_ = settings; }

    /// Once a cycle. Gives what is wrong when it has been wrong for hold_s in all. duty is that of its motor
    /// (-1 to 1), 0 where the controller does not tell it.
    Mismatch judge(double commanded, double measured, double now, double duty = 0);
    /// The wheel was not watched for a while: what it was told before explains nothing. What has added up
    /// stays.
    void skip() { last_ = 0; }
    /// Somebody has looked at the wheel.
    void forget() { last_ = unexplained_s_ = 0; }

private:
    Mismatch compare(double commanded, double measured, double duty) const;

    Settings settings_;
    double unexplained_s_ = 0;
    std::array<double, 2> told_{};     // the last two commands
    double slowest_ = 0, fastest_ = 0; // that commands explain
    double last_ = 0;                  // 0: nothing was judged yet
};

/// For messages: "was told to turn and stands still".
const char *toText(EncoderMonitor::Mismatch mismatch);

} // namespace hermes::motorcontrol
