#include "daemons/simulator/PosePath.h"
#include "vectorlib/geometry/Angle.h"

#include <cmath>

namespace hermes::simulator {

namespace {

constexpr int samplesPerSpan = 64; // a centimetre for poses 0.67 m apart

/// The curve from b to c whose slopes at the ends are those of the neighbours; t from 0 to 1.
double catmullRom(double a, double b, double c, double d, double t) {
    const double slopeB = (c - a) / 2, slopeC = (d - b) / 2;
    const double t2 = t * t, t3 = t2 * t;
    return (2 * t3 - 3 * t2 + 1) * b + (t3 - 2 * t2 + t) * slopeB + (3 * t2 - 2 * t3) * c +
           (t3 - t2) * slopeC;
}

} // namespace

PosePath::PosePath(const std::vector<Pose2D> &poses, double speed, double turnRate) {
    if (poses.empty())
        return;
    std::vector<double> headings = {poses.front().theta};
    for (std::size_t i = 1; i < poses.size(); ++i)
        headings.push_back(headings.back() + vectorlib::wrapAngle(poses[i].theta - headings.back()));

    samples_.push_back({0, poses.front().x, poses.front().y, headings.front()});
    for (std::size_t i = 1; i < poses.size(); ++i) {
        // At the ends of the path the end itself stands in for the missing neighbour.
        const std::size_t before = i < 2 ? i - 1 : i - 2, after = std::min(i + 1, poses.size() - 1);
        const Pose2D &a = poses[before], &b = poses[i - 1], &c = poses[i], &d = poses[after];
        for (int k = 1; k <= samplesPerSpan; ++k) {
            const double t = double(k) / samplesPerSpan;
            Sample sample{0, catmullRom(a.x, b.x, c.x, d.x, t), catmullRom(a.y, b.y, c.y, d.y, t),
                          catmullRom(headings[before], headings[i - 1], headings[i], headings[after], t)};
            const Sample &last = samples_.back();
            const double driving = std::hypot(sample.x - last.x, sample.y - last.y) / speed;
            const double turning = (sample.theta - last.theta) / turnRate;
            const double step = std::hypot(driving, turning);
            if (step <= 0) // the same pose twice
                continue;
            sample.progress = last.progress + step;
            samples_.push_back(sample);
        }
    }
}

const PosePath::Sample &PosePath::sampleBefore(double progress) const {
    const auto after = std::upper_bound(samples_.begin() + 1, samples_.end() - 1, progress,
                                        [](double p, const Sample &s) { return p < s.progress; });
    return *(after - 1);
}

Pose2D PosePath::poseAt(double progress) const {
    if (samples_.size() < 2)
        return samples_.empty() ? Pose2D() : Pose2D{samples_[0].x, samples_[0].y, samples_[0].theta};
    progress = std::clamp(progress, 0.0, length());
    const Sample &a = sampleBefore(progress), &b = *(&a + 1);
    const double t = (progress - a.progress) / (b.progress - a.progress);
    return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y),
            vectorlib::wrapAngle(a.theta + t * (b.theta - a.theta))};
}

Twist2D PosePath::twistAt(double progress, double rate) const {
    if (samples_.size() < 2 || rate == 0)
        return {};
    const Sample &a = sampleBefore(std::clamp(progress, 0.0, length())), &b = *(&a + 1);
    const double scale = rate / (b.progress - a.progress);
    const double dx = (b.x - a.x) * scale, dy = (b.y - a.y) * scale;
    const double heading = poseAt(progress).theta;
    const double c = std::cos(heading), s = std::sin(heading);
    return {c * dx + s * dy, c * dy - s * dx, (b.theta - a.theta) * scale};
}

namespace {

constexpr double arrival = 1e-6; // seconds at full speed: a micrometre at 1 m/s

} // namespace

void PathFollower::advance(double seconds) {
    if (!driving_ && rate_ == 0)
        return;
    const double rest = path_.length() - progress_;
    const double change = acceleration_ * seconds;
    // The rate from which it can still come to rest where the path ends.
    const double brake = std::sqrt(2 * acceleration_ * std::max(0.0, rest));
    rate_ = driving_ ? std::min({1.0, rate_ + change, brake}) : std::max(0.0, rate_ - change);
    progress_ += rate_ * seconds;
    if (path_.length() - progress_ > arrival)
        return;
    progress_ = path_.length();
    rate_ = 0;
    driving_ = false;
}

} // namespace hermes::simulator
