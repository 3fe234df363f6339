#pragma once

#include <vectorlib/mapping/ScanTracker.h>
#include <vectorlib/observation/SimulatedScanner.h>

#include <QtTest>

/// A tracker of the scans of a simulated scanner, for tests to be derived from: in a room of 8 m x 6 m with a
/// niche.
class TrackedRoom {
protected:
    using ScanTracker = vectorlib::ScanTracker;
    using Pose2D = vectorlib::Pose2D;
    using OdometryTrack = vectorlib::OdometryTrack;
    using Walls = std::vector<vectorlib::LineSegment2D<float>>;

    static inline const Walls room{{{-4, -3}, {4, -3}}, {{4, -3}, {4, 3}},  {{4, 3}, {-1, 3}},
                                   {{-1, 3}, {-1, 2}},  {{-1, 2}, {-4, 2}}, {{-4, 2}, {-4, -3}}};

    static bool isNear(const Pose2D &a, const Pose2D &b) {
        return std::hypot(a.x - b.x, a.y - b.y) < 0.02 &&
               std::abs(vectorlib::wrapAngle(a.theta - b.theta)) < 0.01;
    }
    static OdometryTrack track(const Pose2D &pose, double stamp, std::optional<double> variance = {}) {
        vectorlib::OdometrySample sample{stamp, pose, {}, {}};
        if (variance)
            sample.covariance = Eigen::Matrix3d(Eigen::Matrix3d::Identity() * *variance);
        return {1, {sample}};
    }

    /// A new tracker has seen the room once.
    void enter() {
        scanner = vectorlib::SimulatedScanner<float>(5);
        tracker = std::make_unique<ScanTracker>();
        tracker->place({-2, -1, 0});
        QCOMPARE(see({-2, -1, 0}, 10, track({}, 10)).outcome, vectorlib::ScanReport::Outcome::Matched);
    }
    /// A new tracker knows these walls as a finished map, and is told to be there.
    void finishMap(const Walls &walls, const Pose2D &at) {
        tracker = std::make_unique<ScanTracker>();
        for (const auto &wall : walls)
            tracker->builder.map.add(vectorlib::EdgeRaw2D({}, vectorlib::LineSegment2D<double>(wall), 0.01));
        tracker->grow(false);
        tracker->place(at);
    }
    const vectorlib::ScanReport &see(const Pose2D &pose, double stamp,
                                     const std::optional<OdometryTrack> &odometry = std::nullopt) {
        return see(room, pose, stamp, odometry);
    }
    const vectorlib::ScanReport &see(const Walls &world, const Pose2D &pose, double stamp,
                                     const std::optional<OdometryTrack> &odometry = std::nullopt) {
        vectorlib::TimedScan scan;
        scan.points = scanner(world, pose);
        scan.rays = std::size_t(scanner.rays);
        scan.stamp = stamp;
        scan.odometry = odometry;
        return tracker->process(scan);
    }

    vectorlib::SimulatedScanner<float> scanner{5};
    std::unique_ptr<ScanTracker> tracker;
};
