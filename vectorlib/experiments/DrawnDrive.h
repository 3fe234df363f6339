#pragma once

#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/mapping/TimedScan.h"
#include "vectorlib/observation/SimulatedScanner.h"

#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace hermes::experiments {

/// A drive around a hall, or there and back along a corridor, bare or with rooms, drawn at random with what
/// troubles a tracker: noise, a short reach, people who walk along, wheels that slip, or no odometry. The
/// same seed gives the same drive.
class DrawnDrive {
public:
    static constexpr int scans = 60;

    explicit DrawnDrive(unsigned seed);

    /// halls, corridors or plans
    const std::string &kind() const { return kind_; }
    /// Drives on and takes a scan there.
    void take(vectorlib::TimedScan &scan);
    /// Where the last scan was taken.
    const vectorlib::Pose2D &truth() const { return truth_; }

private:
    using Point = vectorlib::Vector2D<double>;
    struct Person {
        double at, speed, aside; ///< on the robot's ellipse, radians; of the robot's speed; of its radii
    };

    double between(double a, double b) { return a + (b - a) * double(random_() % 100001) / 100000; }
    void drawWalls();
    void block(Point low, Point high, bool inside);
    /// On the ellipse that the robot drives, its radii so much larger.
    Point at(double angle, double aside = 1) const;
    /// The angle on the ellipse after a way that is no longer than this, with no turn over 0.3 rad.
    double after(double angle, double way) const;
    void tellOdometry(vectorlib::TimedScan &scan, const vectorlib::Pose2D &before);

    std::mt19937 random_;
    vectorlib::SimulatedScanner<float> scanner_;
    std::string kind_;
    std::vector<vectorlib::LineSegment2D<float>> walls_;
    Point middle_, radii_; ///< of the ellipse; metres
    double angle_ = 0, step_, pause_, slip_, turnError_, stamp_ = 0;
    bool hasOdometry_;
    std::vector<Person> people_;
    vectorlib::Pose2D truth_;
    vectorlib::Transformation2D told_; ///< by the odometry
};

} // namespace hermes::experiments
