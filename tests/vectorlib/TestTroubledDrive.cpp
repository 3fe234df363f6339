// Drives on which odometry or scans are late, missing, frozen or stamped wrongly, drawn at random. Whatever
// is wrong, no edge may enter the map that is no wall.
#include <vectorlib/mapping/ScanTracker.h>
#include <vectorlib/motion/MotionModel.h>
#include <vectorlib/motion/Odometry.h>
#include <vectorlib/observation/Observer.h>

using namespace vectorlib;
using Segment = LineSegment2D<double>;
using Point = Vector2D<double>;

constexpr double start = 1.7e9; // of the clock
constexpr double turn = 0.1;    // of the scanner; seconds
constexpr float middle = 0.05f;

static std::vector<Segment> makeRoom() {
    std::vector<Segment> walls;
    const auto box = [&](Point centre, double half, double angle, bool inside) {
        std::vector<Point> corners;
        for (int i = 0; i < 4; ++i) {
            const double a = angle + (inside ? 1 : -1) * i * pi / 2;
            corners.push_back(centre + Point(std::cos(a), std::sin(a)) * half);
        }
        for (std::size_t i = 0; i < 4; ++i)
            walls.emplace_back(corners[i], corners[(i + 1) % 4]);
    };
    box({0, 0}, 5.2, pi / 4, true);
    box({0.2, -0.1}, 0.7, 0.3, false);
    box({3.1, 0.7}, 0.4, 0.9, false);
    box({-0.8, 3.1}, 0.35, 0.2, false);
    box({-3.2, -1.4}, 0.4, 0.6, false);
    box({1.3, -3.0}, 0.3, 1.1, false);
    return walls;
}
const std::vector<Segment> room = makeRoom();

// Once around a square of 4 m with round corners, at 0.8 m/s and up to 1 rad/s; a pose each millisecond.
static std::vector<Pose2D> makeWay() {
    std::vector<Pose2D> way(500, Pose2D{-1.2, -2, 0});
    double v = 0, omega = 0;
    Pose2D at = way.back();
    for (int side = 0, ms = 0; side < 4; ms = 0, ++side) {
        for (const double corner = (side + 1) * pi / 2; at.theta < corner - 0.001 && ms < 20000; ++ms) {
            const bool bends = ms >= 3000;
            v += std::clamp(0.8 - v, -0.001, 0.001);
            const double braking = std::sqrt(2 * 4 * std::max(0.0, corner - at.theta));
            omega += std::clamp((bends ? std::min(1.0, braking) : 0) - omega, -0.004, 0.004);
            at.theta += omega * 0.001;
            at.x += std::cos(at.theta) * v * 0.001;
            at.y += std::sin(at.theta) * v * 0.001;
            way.push_back(at);
        }
    }
    way.insert(way.end(), 300, at);
    return way;
}
const std::vector<Pose2D> way = makeWay();
const double wayEnd = double(way.size() - 1) / 1000;

static Pose2D poseAt(double seconds) {
    const double ms = std::clamp(seconds * 1000, 0.0, double(way.size()) - 1.001);
    const Pose2D &a = way[std::size_t(ms)], &b = way[std::size_t(ms) + 1];
    const double k = ms - std::floor(ms);
    return {a.x + k * (b.x - a.x), a.y + k * (b.y - a.y), a.theta + k * (b.theta - a.theta)};
}

using Spans = std::vector<std::pair<double, double>>; // from, to; seconds

static std::optional<double> endOf(const Spans &spans, double time) {
    for (const auto &[from, to] : spans)
        if (time >= from && time < to)
            return to;
    return std::nullopt;
}

// A turn of a scanner that goes by these poses: taken clockwise and told counter-clockwise, as by an HDL-32E.
static TimedScan takeScan(const std::vector<Segment> &walls, double begin,
                          const std::function<Pose2D(double)> &poseOf, std::mt19937_64 &random) {
    constexpr int rays = 1800;
    std::normal_distribution<double> noise(0, 0.01);
    TimedScan scan;
    scan.stamp = start + begin;
    scan.rays = rays;
    for (int i = rays - 1; i >= 0; --i) {
        const double seconds = turn * i / rays, angle = -2 * pi * i / rays;
        const Pose2D pose = poseOf(begin + seconds);
        const Point ray(std::cos(pose.theta + angle), std::sin(pose.theta + angle)), from(pose.x, pose.y);
        double range = noHit;
        for (const Segment &wall : walls)
            range = std::min(range, rayDistance(ray, wall.begin() - from, wall.end() - from));
        if (range > 100)
            continue;
        range += noise(random);
        scan.points.emplace_back(float(range * std::cos(angle)), float(range * std::sin(angle)));
        scan.seconds.push_back(float(seconds));
    }
    return scan;
}

// What goes wrong on a drive.
struct Trouble {
    Spans behind;     ///< robot and scanner run slow; their clock lags, and catches up sevenfold afterwards
    Spans silent;     ///< no odometry
    Spans late;       ///< it comes at the end only
    Spans frozen;     ///< it tells its last pose again and again
    Spans blind;      ///< no scans
    double clock = 0; ///< by which the odometry's clock is ahead; seconds
    bool odometry = true;
};

struct Event {
    std::optional<OdometrySample> sample;
    TimedScan scan;
};

class Drive {
public:
    Drive(const Trouble &trouble, unsigned seed)
        : trouble_(trouble)
        , random_(seed) {
        std::vector<double> worldTime; // of each millisecond of the clock
        double world = 0;
        for (int ms = 0; world < wayEnd; ++ms) {
            worldTime.push_back(world);
            if (!endOf(trouble.behind, ms / 1000.0))
                world = std::min((ms + 1) / 1000.0, world + 0.007);
        }
        if (trouble.odometry)
            addOdometry(worldTime);
        addScans(worldTime);
    }
    std::multimap<double, Event> events; // by time

private:
    // 50 times a second; the wheels slip by 3 %, of which it does not know.
    void addOdometry(const std::vector<double> &worldTime) {
        Transformation2D told(poseAt(0));
        Pose2D last = poseAt(0);
        double lastTime = -0.02, xy = 0, alpha = 0;
        for (std::size_t ms = 0; ms < worldTime.size(); ms += 20) {
            const double time = double(ms) / 1000;
            if (endOf(trouble_.silent, time))
                continue;
            const Pose2D now = endOf(trouble_.frozen, time) ? last : poseAt(worldTime[ms]);
            Twist2D motion = Twist2D::between(last.inverse() * now, 0.97);
            told = told * Transformation2D(motion.motion(1));
            xy += 4e-4 * std::hypot(motion.vx, motion.vy);
            alpha += 9e-4 * std::abs(motion.omega);
            const double gap = time - lastTime;
            OdometrySample sample{start + time + trouble_.clock,
                                  told.pose(),
                                  {motion.vx / gap, motion.vy / gap, motion.omega / gap},
                                  Eigen::Matrix3d(Eigen::Vector3d(xy, xy, alpha).asDiagonal())};
            events.emplace(endOf(trouble_.late, time).value_or(time) + 0.004, Event{sample, {}});
            last = now;
            lastTime = time;
        }
    }
    void addScans(const std::vector<double> &worldTime) {
        for (double begin = 0; begin + turn < wayEnd; begin += turn) {
            const auto end = std::lower_bound(worldTime.begin(), worldTime.end(), begin + turn);
            if (!endOf(trouble_.blind, begin) && !endOf(trouble_.blind, begin + turn))
                events.emplace(double(end - worldTime.begin()) / 1000 + 0.002,
                               Event{std::nullopt, takeScan(room, begin, poseAt, random_)});
        }
    }
    const Trouble &trouble_;
    std::mt19937_64 random_;
};

// The farthest that an edge of the map is from the wall that is nearest there.
static double worstEdge(const VectorMap &map) {
    double worst = 0;
    map.forEach([&](const MapEdge &edge) {
        for (int i = 0; i <= 10; ++i) {
            const Point p = edge.segment.begin() + (edge.segment.end() - edge.segment.begin()) * (i / 10.0);
            double nearest = 1e9;
            for (const Segment &wall : room)
                nearest = std::min(nearest, wall.distance(p));
            worst = std::max(worst, nearest);
        }
    });
    return worst;
}

static Spans draw(std::mt19937 &random, int count, double shortest, double longest) {
    std::uniform_real_distribution<double> share;
    Spans spans;
    for (int i = 0; i < count; ++i) {
        const double from = 1 + share(random) * (wayEnd - 3);
        spans.emplace_back(from, from + shortest + share(random) * (longest - shortest));
    }
    return spans;
}

static Trouble drawTrouble(const QString &kind, std::mt19937 &random) {
    Trouble t;
    const bool mixed = kind == "mixed";
    if (mixed || kind == "behind")
        t.behind = draw(random, 4, 0.02, 0.4);
    if (kind == "far behind")
        t.behind = draw(random, 3, 0.3, 1.5);
    if (mixed || kind == "silent")
        t.silent = draw(random, 3, 0.05, 0.7);
    if (mixed || kind == "late")
        t.late = draw(random, 3, 0.05, 0.7);
    if (kind == "frozen")
        t.frozen = draw(random, 3, 0.05, 0.7);
    if (mixed || kind == "blind")
        t.blind = draw(random, 2, 0.1, 1.0);
    if (kind == "clock")
        t.clock = std::uniform_real_distribution<double>(-0.09, 0.15)(random);
    t.odometry = kind != "none at all";
    return t;
}

class TestTroubledDrive : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void noWallIsMadeUp_data() {
        rowsOf("kind", {"all is well", "behind", "far behind", "silent", "late", "frozen", "blind", "clock",
                        "none at all", "mixed"});
    }

    void noWallIsMadeUp() {
        QFETCH(QString, kind);
        for (unsigned seed = 1; seed <= (slowness > 1 ? 2u : 6u); ++seed) {
            std::mt19937 random(seed);
            const Trouble trouble = drawTrouble(kind, random);
            ScanTracker tracker;
            tracker.place(poseAt(0));
            OdometryBuffer odometry;
            double farthest = 0;
            for (auto &[time, event] : Drive(trouble, seed).events) {
                if (event.sample) {
                    odometry.add(*event.sample);
                    continue;
                }
                event.scan.odometry = odometry.over(event.scan.begin(), event.scan.end());
                const Pose2D found = tracker.process(event.scan).pose,
                             real = poseAt(event.scan.stamp - start);
                farthest = std::max(farthest, std::hypot(found.x - real.x, found.y - real.y));
            }
            const double worst = worstEdge(tracker.builder.map);
            const QString what =
                QString("seed %1: an edge is off by %2 m, a pose by %3 m").arg(seed).arg(worst).arg(farthest);
            QVERIFY2(worst <= 0.05 && farthest <= 0.02, qPrintable(what));
            QCOMPARE(tracker.counts().lost, std::uint64_t(0));
            QVERIFY(tracker.builder.map.size() >= 15); // of 24 walls, some not to be seen
        }
    }

    void findsTheVelocityOfABentScan() {
        const Twist2D real{0.8, -0.1, 1.0};
        const auto poseOf = [&](double t) { return Pose2D{-1, -2, 0.4} * real.motion(t - turn / 2); };
        std::mt19937_64 random(1);
        const TimedScan scan = takeScan(room, 0, poseOf, random);
        std::vector<Segment> known;
        for (const Segment &wall : room)
            known.push_back(Transformation2D(-1, -2, 0.4).inverse() * wall);
        TwistCorrection correct;
        Twist2D found;
        for (int i = 0; i < 3; ++i) {
            std::vector<Vector2D<float>> points = scan.points;
            compensateMotion(points, scan.seconds, middle, found);
            const auto wrong = correct(points, scan.seconds, middle, known);
            QVERIFY(i > 0 || (wrong.bend > 0.1 && wrong.bend < 0.4));
            QVERIFY(i < 2 || wrong.bend < 0.01);
            found = {found.vx + wrong.twist.vx, found.vy + wrong.twist.vy, found.omega + wrong.twist.omega};
        }
        QVERIFY(std::abs(found.vx - real.vx) < 0.1 && std::abs(found.vy - real.vy) < 0.1);
        QVERIFY(std::abs(found.omega - real.omega) < 0.05);
    }

    void trustsTheVelocityWhereNothingTells() {
        const std::vector<Segment> corridor{{{-9, -1}, {9, -1}}, {{9, 1}, {-9, 1}}};
        std::mt19937_64 random(1);
        const TimedScan scan = takeScan(
            corridor, 0,
            [](double t) {
                return Pose2D{0.8 * t, 0, 0};
            },
            random);
        TwistCorrection correct;
        QVERIFY(std::abs(correct(scan.points, scan.seconds, middle, corridor).twist.vx) < 1e-6);
        QCOMPARE(correct(scan.points, scan.seconds, middle, {}).bend, 0.0);
        QCOMPARE(correct(scan.points, {}, 0, corridor).bend, 0.0);
    }

    // Something pushed the robot aside in the middle of the turn: no velocity makes this scan straight.
    void whatStaysBentStaysOut() {
        const Pose2D at{-1, -2, 0.4};
        std::mt19937_64 random(1);
        ScanTracker tracker;
        tracker.place(at);
        double time = 0;
        const auto see = [&](const std::function<Pose2D(double)> &poseOf) {
            TimedScan scan = takeScan(room, time, poseOf, random);
            tracker.process(scan);
            time += turn;
            return tracker.builder.map.takeChanges().size();
        };
        const auto stand = [&](double) { return at; };
        QVERIFY(see(stand) > 0);
        QVERIFY(see(stand) > 0);
        const double push = time + turn / 2;
        QCOMPARE(see([&](double t) {
                     return t < push ? at : Pose2D{at.x, at.y + 0.2, at.theta + 0.1};
                 }),
                 std::size_t(0));
        QVERIFY(see(stand) > 0);
        QVERIFY(worstEdge(tracker.builder.map) < 0.05);
    }
};
