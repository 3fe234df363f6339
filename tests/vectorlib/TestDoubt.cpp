// Drives through buildings that are drawn at random, on which something goes wrong. A pose that is wrong by
// more than 0.3 m or 5 degrees is told as doubtful within 3 s of scans, and no wall is drawn from it.
// HERMES_CASES tells how many drives are drawn, HERMES_SEED the first of them; without it always the same 50.
#include "tests/vectorlib/OfficeFloor.h"
#include "tests/vectorlib/RingBuilding.h"

#include <vectorlib/mapping/ScanTracker.h>

using namespace vectorlib;
using Point = Vector2D<double>;

constexpr double between_s = 0.15; // scans
constexpr double wrong_m = 0.3, wrong_rad = 5 * pi / 180;
constexpr double longest_s = 3; // that a wrong pose is believed
constexpr double believed = 0.5;
constexpr double noWall_m = 0.4; // an edge of the map so far from all walls
constexpr double step_m = 0.15;
constexpr int window = 20, enoughTold = 13;     // scans
constexpr double bend_m = 0.1, bend_rad = 0.03; // of a map, in a scan
constexpr int maxScans = 160;

enum class Trouble {
    Nothing,
    Carried,
    Told,
    OtherMap,
    Furniture,
    People,
    Slip,
    OdometryJump,
    Scale,
    Blind,
    Clock,
    Crowd
};
const std::vector<const char *> troubles{"nothing",          "carried",         "a wrong place is told",
                                         "another map",      "furniture moved", "people",
                                         "wheels slip",      "odometry jumps",  "odometry scaled",
                                         "no scans for 3 s", "the clock steps", "stands in a crowd"};

// Who goes by a robot: where, in its frame, and how fast.
struct Passer {
    double ahead, left, speed; // metres, m/s
    bool isCart;
};

struct Building {
    ScanWorld world;
    std::vector<Pose2D> way;
};

// Of a drive, or of many.
struct Figures {
    int drives = 0, failed = 0;
    int right = 0, doubted = 0, wrong = 0, wronglyBelieved = 0; // poses
    double longest = 0;                                         // that a wrong pose was believed; seconds
    double farthest = 0;                                        // edge of the map from any wall; metres

    void add(const Figures &f) {
        drives += f.drives;
        failed += f.failed;
        right += f.right;
        doubted += f.doubted;
        wrong += f.wrong;
        wronglyBelieved += f.wronglyBelieved;
    }
};

class Drive {
public:
    explicit Drive(unsigned seed)
        : random_(seed) {
        trouble_ = Trouble(any(int(troubles.size())));
        isMapping_ = any(2) == 0;
        hasOdometry_ = any(4) != 0;
        static constexpr int rays[] = {91, 181, 361, 721};
        static constexpr double fields[] = {pi, 1.5 * pi, 2 * pi};
        scanner_ = {rays[any(4)], fields[any(3)], between(0.005, 0.02), any(3) == 0 ? 8.0 : 30.0};
    }
    std::size_t trouble() const { return std::size_t(trouble_); }
    QString text() const {
        return QString("%1, %2, %3, %4 rays over %5 degrees to %6 m")
            .arg(troubles[std::size_t(trouble_)], isMapping_ ? "mapping" : "localizing",
                 hasOdometry_ ? "odometry" : "no odometry")
            .arg(scanner_.rays)
            .arg(scanner_.fieldOfView * 180 / pi)
            .arg(scanner_.reach);
    }

    Figures run() {
        Building b = building();
        b.way.resize(std::min(b.way.size(), std::size_t(2 * maxScans)));
        when_ = 20 + std::size_t(any(40)); // it goes wrong
        if (!isMapping_ || trouble_ == Trouble::OtherMap)
            map(b);
        if (trouble_ == Trouble::OtherMap)
            b = building();
        b.way.resize(std::min(b.way.size(), std::size_t(maxScans)));
        ScanTrackerSettings settings;
        settings.relocalizeSeconds = 1e6; // the same on each machine
        tracker_.apply(settings);
        tracker_.place(b.way.front());
        tracker_.grow(isMapping_);
        if (trouble_ == Trouble::OtherMap)
            tracker_.seek();
        const std::size_t known = tracker_.builder.map.size();
        drive(b);
        if (trouble_ == Trouble::OtherMap)
            figures_.farthest = tracker_.builder.map.size() > known ? 100 : 0;
        else if (isMapping_ && trouble_ != Trouble::People && trouble_ != Trouble::Crowd && !mayBend_)
            judgeMap(b.world);
        figures_.drives = 1;
        figures_.failed = figures_.longest > longest_s || figures_.farthest > noWall_m;
        return figures_;
    }

private:
    double between(double a, double b) { return std::uniform_real_distribution<double>(a, b)(random_); }
    int any(int count) { return int(random_() % unsigned(count)); }

    Building building() {
        if (any(2) == 0) {
            RingBuilding ring(random_);
            std::vector<Pose2D> way;
            for (const Pose2D &pose : ring.drive(1)) {
                if (!way.empty()) {
                    const Pose2D motion = way.back().inverse() * pose;
                    way.push_back(way.back() * Pose2D{motion.x / 2, motion.y / 2, motion.theta / 2});
                }
                way.push_back(pose);
            }
            return {ring.world, way};
        }
        OfficeFloor floor({between(50, 70), between(50, 60)}, random_);
        return {{floor.world.walls, {}}, floor.drive(2 * maxScans, step_m)};
    }
    // As a drive whose loops were closed leaves it.
    void map(const Building &b) {
        MapBuilder builder;
        for (const Pose2D &pose : b.way) {
            const TimedScan scan = scanOf(b.world, pose);
            builder.extract.segment.settings = EarSettings::forScanner(scan.fieldOfView, scan.rays);
            builder.extract.segment.settings.closed = scan.closed;
            builder.find(scan.points, pose);
            builder.place(builder.edges(), pose);
        }
        tracker_.builder.map = builder.map;
    }
    TimedScan scanOf(const ScanWorld &world, const Pose2D &pose) {
        TimedScan scan;
        scan.points = world.scan(Transformation2D(pose), random_, scanner_);
        scan.rays = std::size_t(scanner_.rays);
        scan.fieldOfView = scanner_.fieldOfView;
        scan.closed = scanner_.fieldOfView > 6.2;
        return scan;
    }

    void drive(Building &b) {
        double clock = 1000;
        Pose2D odometry;
        Twist2D twist;
        Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
        const double scale = trouble_ == Trouble::Scale ? between(0.8, 1.25) : 1;
        const double slip = any(2) ? 1 : between(0.3, 1);
        std::normal_distribution<double> noise(1, 0.01);
        const std::size_t carriedTo = placeNear(b, when_);
        if (trouble_ == Trouble::Furniture)
            furnish(b);
        std::vector<double> people(std::size_t(any(11)));
        for (double &angle : people)
            angle = between(0, 2 * pi);
        std::vector<Passer> crowd(std::size_t(1 + any(8)));
        for (Passer &passer : crowd)
            passer = {between(-6, 6), between(-0.9, 0.9), between(0.5, 1.5) * (any(3) ? 1 : -1), any(3) == 0};
        for (std::size_t n = 0, at = 0; n < std::size_t(maxScans) && at + 1 < b.way.size(); ++n) {
            const bool isWrong = n >= when_ && n < when_ + 20, begins = n == when_;
            const bool stands = trouble_ == Trouble::Crowd && n > when_ && n < when_ + 80;
            if (stands)
                twist = {};
            else if (n > 0) {
                const Pose2D motion = b.way[at].inverse() * b.way[at + 1];
                const double k =
                    scale * noise(random_) * (trouble_ == Trouble::Slip && isWrong ? 1 - slip : 1);
                const Pose2D told{motion.x * k, motion.y * k, motion.theta * k};
                odometry = odometry * told;
                twist = Twist2D::between(told, between_s);
                covariance += Eigen::Vector3d(1e-3, 1e-3, 1e-3).asDiagonal() * std::hypot(motion.x, motion.y);
                ++at;
            }
            if (begins && trouble_ == Trouble::Carried)
                at = carriedTo;
            if (begins && trouble_ == Trouble::Told)
                tracker_.claim(b.way[at] * Pose2D{between(-4, 4), between(-4, 4), between(-3, 3)});
            if (begins && trouble_ == Trouble::OdometryJump)
                odometry = odometry * Pose2D{between(-3, 3), between(-3, 3), between(-3, 3)};
            if (begins && trouble_ == Trouble::Clock)
                clock += between(-5, 5);
            clock += between_s;
            if (hasOdometry_)
                odometry_.add({clock, odometry, twist, covariance});
            if (trouble_ == Trouble::Blind && isWrong)
                continue;
            ScanWorld seen = b.world;
            if (trouble_ == Trouble::People)
                for (double &angle : people) {
                    angle += between(-0.2, 0.2);
                    const double far = 1 + 1.5 * std::abs(std::sin(7 * angle));
                    seen.pillars.push_back(
                        {{b.way[at].x + far * std::cos(angle), b.way[at].y + far * std::sin(angle)}, 0.2});
                }
            if (trouble_ == Trouble::Crowd && n >= when_)
                pass(crowd, b.way[at], seen);
            TimedScan scan = scanOf(seen, b.way[at]);
            scan.stamp = clock;
            if (hasOdometry_)
                scan.odometry = odometry_.over(clock, clock);
            judge(scan, b.way[at], b.world);
        }
    }
    // People, and carts of a metre, go by on both sides along the way, again and again.
    void pass(std::vector<Passer> &crowd, const Pose2D &robot, ScanWorld &seen) {
        for (Passer &passer : crowd) {
            passer.ahead = std::remainder(passer.ahead + passer.speed * between_s, 16);
            if (std::hypot(passer.ahead, passer.left) < 0.9)
                continue;
            const auto at = [&](double x, double y) {
                const Pose2D p = robot * Pose2D{passer.ahead + x, passer.left + y, 0};
                return Point(p.x, p.y);
            };
            if (!passer.isCart)
                seen.pillars.push_back({at(0, 0), 0.2});
            const Point corners[] = {at(-0.5, -0.3), at(-0.5, 0.3), at(0.5, 0.3), at(0.5, -0.3)};
            for (int k = 0; passer.isCart && k < 4; ++k)
                seen.walls.emplace_back(corners[k], corners[(k + 1) % 4]);
        }
    }
    // 1 to 7 m from a pose of the way.
    std::size_t placeNear(const Building &b, std::size_t from) {
        const Pose2D &begin = b.way[std::min(from, b.way.size() - 1)];
        for (int tries = 0; tries < 1000; ++tries) {
            const std::size_t to = std::size_t(any(int(b.way.size()) / 2));
            const double far = std::hypot(b.way[to].x - begin.x, b.way[to].y - begin.y);
            if (far > 1 && far < 7)
                return to;
        }
        return from;
    }
    // Cupboards that the map does not have, beside the way.
    void furnish(Building &b) {
        for (int i = 0; i < 8; ++i) {
            const Pose2D &beside = b.way[std::size_t(any(int(b.way.size())))];
            const Point at(beside.x + between(-2, 2), beside.y + between(-2, 2));
            bool isFree = true;
            for (const Pose2D &pose : b.way)
                isFree = isFree && std::hypot(pose.x - at.x - 0.4, pose.y - at.y - 0.3) > 0.8;
            const Point corners[] = {at, {at.x, at.y + 0.6}, {at.x + 0.8, at.y + 0.6}, {at.x + 0.8, at.y}};
            for (int k = 0; isFree && k < 4; ++k)
                b.world.walls.emplace_back(corners[k], corners[(k + 1) % 4]);
        }
    }

    void judge(TimedScan &scan, const Pose2D &real, const ScanWorld &world) {
        const ScanReport report = tracker_.process(scan);
        follow(real, report);
        const Pose2D off = (drift_ * Transformation2D(real)).inverse().pose() * report.pose;
        const double turned = std::remainder(off.theta, 2 * pi);
        const bool isWrong = trouble_ == Trouble::OtherMap || std::hypot(off.x, off.y) > wrong_m ||
                             std::abs(turned) > wrong_rad;
        const bool isTold =
            isWrong && (trouble_ == Trouble::OtherMap ||
                        isToldApart(world, real, (drift_.inverse() * Transformation2D(report.pose)).pose()));
        const bool isBelieved =
            report.outcome == ScanReport::Outcome::Matched && tracker_.trust() >= believed;
        if (++scans_ % 5 == 0 && tracker_.wantsSearch())
            tracker_.search(); // as recover() does by the clock
        figures_.right += !isWrong;
        figures_.doubted += !isWrong && !isBelieved && scans_ > 1;
        figures_.wrong += isWrong;
        figures_.wronglyBelieved += isWrong && isBelieved;
        // What could be told when it began: new walls agree with any pose.
        const double leap = std::hypot(off.x - lastOff_.x, off.y - lastOff_.y);
        lastOff_ = off;
        if (leap > 1 && isWrong) // elsewhere
            wrongScans_ = toldScans_ = 0;
        wrongScans_ = isWrong ? wrongScans_ + 1 : 0;
        toldScans_ = !isWrong ? 0 : toldScans_ + (isTold && wrongScans_ <= window);
        isExcused_ = isWrong &&
                     ((isExcused_ && wrongScans_ > 1) || (wrongScans_ == window && toldScans_ < enoughTold));
        mayBend_ = mayBend_ || isExcused_ || (isWrong && isBelieved && !isTold);
        spell_ = isWrong && isBelieved && !isExcused_ ? spell_ + between_s : 0;
        figures_.longest = std::max(figures_.longest, wrongScans_ >= window ? spell_ : 0);
    }
    // A map that grows bends with the drive until loops are closed: the pose is right where the map shows the
    // same. What leaps does not bend.
    void follow(const Pose2D &real, const ScanReport &report) {
        if (!isMapping_)
            return;
        const Transformation2D error = Transformation2D(report.pose) * Transformation2D(real).inverse();
        if (last_ && report.outcome == ScanReport::Outcome::Matched) {
            const Transformation2D step = *last_ * Transformation2D(real),
                                   now = error * Transformation2D(real);
            const Transformation2D change = step.inverse() * now;
            if (change.translation().norm() < bend_m && std::abs(change.alpha()) < bend_rad)
                drift_ = error * last_->inverse() * drift_;
            bent_ = std::max(bent_, ((drift_ * Transformation2D(real)).translation() -
                                     Transformation2D(real).translation())
                                        .norm());
        }
        last_.reset();
        if (report.outcome == ScanReport::Outcome::Matched)
            last_ = error;
    }
    // Whether a scanner without noise could tell that it is not at the other pose.
    bool isToldApart(const ScanWorld &world, const Pose2D &real, const Pose2D &other) {
        ScanWorld::Scanner exact = scanner_;
        exact.rays = 91;
        exact.sigma = 0;
        int apart = 0, both = 0;
        std::mt19937 random;
        const ScanWorld::Points a = world.scan(Transformation2D(real), random, exact),
                                b = world.scan(Transformation2D(other), random, exact);
        std::size_t k = 0;
        const auto angle = [](const Vector2D<float> &p) { return std::atan2(p.y, p.x); };
        for (const Vector2D<float> &p : a) {
            while (k < b.size() && angle(b[k]) < angle(p) - 0.01f)
                ++k;
            if (k == b.size() || angle(b[k]) > angle(p) + 0.01f)
                continue;
            ++both;
            apart += std::abs(p.norm() - b[k].norm()) > 0.3f;
        }
        return apart > 0.2 * both;
    }
    void judgeMap(const ScanWorld &world) {
        tracker_.builder.map.forEach([&](const MapEdge &edge) {
            for (const double share : {0.1, 0.5, 0.9}) {
                const Point p = edge.segment.begin() + (edge.segment.end() - edge.segment.begin()) * share;
                double nearest = 1e9;
                for (const auto &wall : world.walls)
                    nearest = std::min(nearest, wall.distance(p));
                figures_.farthest = std::max(figures_.farthest, nearest - bent_);
            }
        });
    }

    std::mt19937 random_;
    Trouble trouble_;
    bool isMapping_, hasOdometry_;
    ScanWorld::Scanner scanner_;
    std::size_t when_ = 0;
    ScanTracker tracker_;
    OdometryBuffer odometry_;
    Figures figures_;
    int scans_ = 0;
    std::optional<Transformation2D> last_; // error, as a motion of the map
    Transformation2D drift_;               // of the map, where the robot is
    double bent_ = 0;                      // the farthest of it; metres
    Pose2D lastOff_;
    int wrongScans_ = 0, toldScans_ = 0; // since the pose became wrong; of the first of them
    bool isExcused_ = false;
    double spell_ = 0;     // seconds
    bool mayBend_ = false; // nothing could tell that a pose was wrong
};

class TestDoubt : public QObject {
    Q_OBJECT
private Q_SLOTS:
    // About one drive in fifty fails, and one right pose in twenty is doubted, more in crowds and without
    // odometry: so much is not reached yet.
    void aWrongPoseIsDoubted() {
        constexpr int maxFailed = 33, maxDoubted = 11, few = 2;
        const int usual = slowness > 1 ? 12 : 50; // sanitizers look at what each drive does, not at shares
        const int asked = qEnvironmentVariableIntValue("HERMES_CASES"), cases = asked > 0 ? asked : usual;
        const unsigned first = asked > 0 ? newSeed() : 1;
        std::vector<Figures> kinds(troubles.size());
        for (unsigned seed = first; seed < first + unsigned(cases); ++seed) {
            Drive drive(seed);
            const Figures f = drive.run();
            kinds[drive.trouble()].add(f);
            if (f.failed > 0)
                qInfo("seed %u: %s: believed for %.1f s, an edge is %.2f m from all walls", seed,
                      qPrintable(drive.text()), f.longest, f.farthest);
        }
        Figures all;
        qInfo("%-22s drives failed  right doubted  wrong believed", "");
        for (std::size_t i = 0; i < kinds.size(); ++i) {
            tell(troubles[i], kinds[i]);
            all.add(kinds[i]);
        }
        tell("all", all);
        QVERIFY2(all.failed <= std::max(few, cases / maxFailed), saying(all.failed));
        QVERIFY2(all.doubted * maxDoubted <= all.right, saying(all.doubted));
    }

private:
    static void tell(const char *what, const Figures &f) {
        qInfo("%-22s %6d %6d %6d %5.2f %% %6d %8d", what, f.drives, f.failed, f.right,
              100.0 * f.doubted / std::max(1, f.right), f.wrong, f.wronglyBelieved);
    }
};
