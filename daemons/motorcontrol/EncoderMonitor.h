#pragma once

namespace hermes::motorcontrol {

/// Compares the speed that one wheel was told with what its encoder says. Speeds in rad/s, times in seconds
/// of a clock that never jumps.
class EncoderMonitor {
public:
    enum class Mismatch { None, StandsStill, MovesUncommanded, MovesBackwards, MovesTooFast };
    struct Settings {
        double commanded = 0.5; ///< slower commands than this may leave the wheel standing: friction
        double moving = 0.25;   ///< slower than this counts as standing
        double hold_s = 0.5;    ///< how long a mismatch must last; longer than braking takes
    };

    void set(const Settings &settings) { settings_ = settings; }

    /// Once a cycle. Gives what has been wrong without a break for hold_s.
    Mismatch judge(double commanded, double measured, double now);
    /// Forgets what lasts: the wheel was not watched for a while.
    void reset() { lasting_ = Mismatch::None; }

private:
    Mismatch compare(double commanded, double measured) const;

    Settings settings_;
    Mismatch lasting_ = Mismatch::None;
    double since_ = 0;
};

/// For messages: "was told to turn and stands still".
const char *toText(EncoderMonitor::Mismatch mismatch);

} // namespace hermes::motorcontrol
