// A robot with two scanners, one looking ahead and one back, of which the second may be mounted otherwise
// than it is told.
#pragma once

#include <vectorlib/mapping/ScanTracker.h>
#include <vectorlib/motion/Odometry.h>
#include <vectorlib/observation/SimulatedScanner.h>

#include <functional>

using namespace vectorlib;
using Segment = LineSegment2D<float>;
using Point = Vector2D<float>;
using State = SecondScanner::State;

// 9 m x 7 m, with pillars.
inline std::vector<Segment> makeRoom() {
    std::vector<Segment> walls{{{0, 0}, {9, 0}}, {{9, 0}, {9, 7}}, {{9, 7}, {3, 7}},
                               {{3, 7}, {3, 6}}, {{3, 6}, {0, 6}}, {{0, 6}, {0, 0}}};
    for (const auto &[x, y] :
         {std::pair{0.8f, 0.7f}, {4.5f, 3.2f}, {3.2f, 3.f}, {6.f, 3.6f}, {8.f, 0.8f}, {7.8f, 5.8f}}) {
        const std::vector<Point> corners{{x, y}, {x, y + 0.5f}, {x + 0.5f, y + 0.5f}, {x + 0.5f, y}};
        for (std::size_t i = 0; i < 4; ++i)
            walls.emplace_back(corners[i], corners[(i + 1) % 4]);
    }
    return walls;
}
inline const std::vector<Segment> room = makeRoom();

// 12 m x 6 m; it looks the same from both ends.
inline const std::vector<Segment> hall{
    {{-6, -3}, {6, -3}}, {{6, -3}, {6, 3}}, {{6, 3}, {-6, 3}}, {{-6, 3}, {-6, -3}}};
// 2 m wide and 14 m long; it begins 1.5 m behind the robot.
inline const std::vector<Segment> corridor{{{-1.5f, -1}, {12.5f, -1}},
                                           {{12.5f, -1}, {12.5f, 1}},
                                           {{12.5f, 1}, {-1.5f, 1}},
                                           {{-1.5f, 1}, {-1.5f, -1}}};

inline double offWalls(const std::vector<Segment> &walls, Vector2D<double> p) {
    double nearest = 1e9;
    for (const Segment &wall : walls)
        nearest = std::min(nearest, double(wall.distance(Point(p))));
    return nearest;
}

// An ellipse about the pillar in the middle, at 0.5 m/s or so, from a standstill.
inline Pose2D robotAt(double seconds) {
    const double t = std::max(0.0, seconds - 0.5), a = 0.2 * (t < 2 ? t * t / 4 : t - 1);
    const double x = 4.7 + 3 * std::sin(a), y = 3.3 - 2.3 * std::cos(a);
    return {x, y, std::atan2(2.3 * std::sin(a), 3 * std::cos(a))};
}

inline Pose2D straightOn(double seconds) {
    const double t = std::max(0.0, seconds - 0.5);
    return {0.5 * (t < 2 ? t * t / 4 : t - 1), 0, 0};
}

struct Robot {
    std::vector<Segment> walls = room;
    Pose2D (*at)(double) = robotAt;
    double fieldOfView = pi;
    bool hasOdometry = true;
    double period2 = 0.1; // of the second scanner
    std::function<std::optional<SecondScan>(SecondScan, double)> alter;
    Pose2D told{-0.25, 0, pi}; // the second one's mount; true is
    const Pose2D first{0.25, 0, 0}, second{-0.25, 0, pi};
    ScanTracker tracker;
    OdometryBuffer odometry;
    SimulatedScanner<> scan1{1}, scan2{2};
    std::function<void(double)> watch;
    std::function<bool(double)> firstIsSilent;
    std::vector<double> errors;

    void drive(double end, bool both = true) {
        ScanTrackerSettings settings;
        settings.sensorOnRobot = first;
        settings.secondOnRobot = told;
        tracker.apply(settings);
        for (auto *scanner : {&scan1, &scan2}) {
            scanner->fieldOfView = fieldOfView;
            scanner->rays = int(fieldOfView * 180 / pi) + 1; // one a degree
        }
        std::optional<SecondScan> waiting;
        double next2 = 0.033, next = 0;
        const Pose2D begin = at(0) * first;
        for (int ms = 0; ms < 1000 * end; ms += 10) {
            const double now = 0.001 * ms;
            if (ms % 20 == 0) // of the end of a scan that sweeps, too
                odometry.add({now + 0.2, at(0).inverse() * at(now + 0.2), {}, {}});
            if (both && now >= next2) {
                next2 += period2;
                SecondScan scan{scan2(walls, at(now) * second), {}, now, 360};
                waiting = alter ? alter(scan, now) : scan;
            }
            if (now < next)
                continue;
            next += 0.1;
            TimedScan scan;
            scan.points = scan1(walls, at(now) * first);
            scan.stamp = now;
            scan.rays = 360;
            scan.second = std::exchange(waiting, std::nullopt);
            if (firstIsSilent && firstIsSilent(now))
                scan.points.clear();
            if (hasOdometry)
                scan.odometry = odometry.over(scan.firstSeen(), scan.lastSeen());
            tracker.process(scan);
            const Transformation2D off = Transformation2D((begin.inverse() * at(now) * first).inverse() *
                                                          tracker.builder.report().pose);
            errors.push_back(off.translation().norm());
            if (watch)
                watch(now);
        }
    }
    // Of the map's walls in the room, every 10 cm: how far they are from its walls; and their length.
    double farthest(double share, double *length = nullptr) {
        std::vector<double> off;
        const Transformation2D begin(at(0) * first);
        tracker.builder.map.forEach([&](const MapEdge &e) {
            const auto s = begin * e.segment;
            for (double along = 0; along < s.length(); along += 0.1)
                off.push_back(offWalls(walls, s.begin() + s.direction() * along));
        });
        std::sort(off.begin(), off.end());
        if (length)
            *length = 0.1 * double(off.size());
        return off.empty() ? 1e9 : off[std::min(off.size() - 1, std::size_t(share * double(off.size())))];
    }
    double meanError() const {
        return std::accumulate(errors.begin(), errors.end(), 0.0) / double(errors.size());
    }
};

Q_DECLARE_METATYPE(vectorlib::Pose2D)
Q_DECLARE_METATYPE(std::vector<Segment>)
