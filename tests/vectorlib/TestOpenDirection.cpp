// Along corridors, where the lines leave a direction open.
#include "tests/vectorlib/TrackedRoom.h"

using namespace vectorlib;

class TestOpenDirection : public QObject, TrackedRoom {
    Q_OBJECT
private Q_SLOTS:
    void init() { enter(); }

    // Its ends are out of reach: nothing tells how far the sensor went.
    void trustIsLowAlongABareCorridor() {
        const Walls corridor{{{-40, -1}, {40, -1}}, {{40, 1}, {-40, 1}}};
        scanner.maxRange = 6;
        tracker = std::make_unique<ScanTracker>();
        for (int i = 0; i <= 20; ++i) {
            see(corridor, {0.1 * i, 0, 0}, 10 + 0.1 * i);
            QVERIFY2(tracker->trust() < 0.5, saying(tracker->trust()));
        }
        QCOMPARE(tracker->counts().matched, std::uint64_t(21));
    }

    void aCorridorIsLeftOpenToTheOdometry() {
        const Walls corridor{{{-99, -1}, {99, -1}}, {{99, 1}, {-99, 1}}};
        tracker = std::make_unique<ScanTracker>();
        scanner.maxRange = 8; // its ends are never seen
        for (int i = 0; i < 120; ++i)
            see(corridor, {0.05 * i, 0, 0}, 10 + 0.1 * i, track({0.05 * i, 0, 0}, 10 + 0.1 * i));
        const double x = tracker->builder.report().pose.x;
        QVERIFY2(std::abs(x - 0.05 * 119) < 0.01, saying(x));
    }

    // Its walls face all ways, and yet it looks the same farther on.
    void aBendIsLeftOpenToTheOdometry_data() { falseAndTrue("grows", "finished map", "growing map"); }
    void aBendIsLeftOpenToTheOdometry() {
        QFETCH(bool, grows);
        const Walls bend = ringCorridor();
        finishMap(grows ? Walls() : bend, inRing(0));
        tracker->grow(grows);
        for (int i = 0; i < 300; ++i) {
            const Pose2D real = inRing(0.01 * i);
            const Pose2D pose = see(bend, real, 10 + 0.1 * i, track(real, 10 + 0.1 * i)).pose;
            QVERIFY2(std::hypot(pose.x - real.x, pose.y - real.y) < 0.2, saying(pose.x - real.x));
        }
        QVERIFY2((tracker->trust() > 0.5) == grows, saying(tracker->trust())); // after 18 m by the odometry
    }

    // Who is driven there seems to stand.
    void withoutOdometryTrustIsLowInABareCorridor_data() { falseAndTrue("bends", "straight", "bent"); }
    void withoutOdometryTrustIsLowInABareCorridor() {
        QFETCH(bool, bends);
        const Walls walls = bends ? ringCorridor() : Walls{{{-40, -1}, {40, -1}}, {{40, 1}, {-40, 1}}};
        scanner.maxRange = 5;
        finishMap(walls, bends ? inRing(0) : Pose2D());
        for (int i = 0; i < 30; ++i)
            see(walls, bends ? inRing(0.01 * i) : Pose2D{0.06 * i, 0, 0}, 10 + 0.1 * i);
        QVERIFY2(tracker->trust() < 0.5, saying(tracker->trust()));
    }

    // A corridor with doors whose ends are out of reach, in a finished map: only the ends of walls tell how
    // far along it the sensor is.
    void endsOfWallsTellThePlaceAlongACorridor_data() {
        QTest::addColumn<double>("wrong"); // metres
        for (const double wrong : {-0.7, -0.4, 0.0, 0.7, 1.5})
            QTest::addRow("%g m off", wrong) << wrong;
    }
    void endsOfWallsTellThePlaceAlongACorridor() {
        QFETCH(double, wrong);
        const Walls corridor{
            {{-40, -1}, {-3.1f, -1}}, {{-2.2f, -1}, {0.4f, -1}}, {{2, -1}, {40, -1}}, {{40, 1}, {-40, 1}}};
        scanner.maxRange = 5;
        finishMap(corridor, {wrong, 0, 0});
        // One scan may err by far: the pose stays, and is doubted, until another one agrees.
        const bool isFar = std::abs(wrong) > 0.3;
        for (int i = 0; i < 3; ++i) { // what was mended is no motion
            const Pose2D pose = see(corridor, {0.1 * i, 0, 0}, 10 + 0.1 * i).pose;
            const bool isDoubted = isFar && i == 0;
            QVERIFY2(std::abs(pose.x - 0.1 * i - (isDoubted ? wrong : 0)) < 0.2, saying(pose.x));
            QVERIFY2((tracker->trust() < 0.5) == isDoubted, saying(tracker->trust()));
        }
    }

    // The wheels turn more slowly than they tell, which only the ends of walls show.
    void whatSlidesAlongACorridorContradictsTheOdometry() {
        Walls corridor{{{40, 1}, {-40, 1}}};
        for (float x = -40; x < 40; x += 1.5f + 0.1f * std::abs(x))
            corridor.push_back({{x, -1}, {x + 1, -1}});
        scanner.maxRange = 5;
        finishMap(corridor, {});
        for (int i = 0; i < 30; ++i)
            see(corridor, {0.1 * i, 0, 0}, 10 + 0.1 * i, track({0.3 * i, 0, 0}, 10 + 0.1 * i));
        QVERIFY2(std::abs(tracker->builder.report().pose.x - 2.9) < 0.3,
                 saying(tracker->builder.report().pose.x));
        QVERIFY(tracker->counts().contradicted > 0);
    }

    // Five scans agree with it, but tell nothing of the way along.
    void aPlaceToldInABareCorridorIsDoubted_data() { falseAndTrue("grows", "finished map", "growing map"); }
    void aPlaceToldInABareCorridorIsDoubted() {
        QFETCH(bool, grows);
        Walls corridor{{{-40, -1}, {20, -1}}, {{20, -1}, {20, 1}}, {{20, 1}, {-40, 1}}};
        scanner.maxRange = 5;
        finishMap(corridor, {});
        tracker->grow(grows);
        tracker->claim({10, 0, 0});
        for (int i = 0; i < 8; ++i) {
            see(corridor, {10, 0, 0}, 10 + 0.1 * i, track({}, 10 + 0.1 * i));
            QVERIFY2(tracker->trust() < 0.5, saying(tracker->trust()));
        }
        QVERIFY(!grows || tracker->placeState() == PlaceState::Told);
        for (int i = 0; i < 80; ++i)
            see(corridor, {10 + 0.1 * i, 0, 0}, 11 + 0.1 * i, track({0.1 * i, 0, 0}, 11 + 0.1 * i));
        QVERIFY2(tracker->trust() > 0.5, saying(tracker->trust())); // its end is seen
        QVERIFY(tracker->placeState() == PlaceState::Known);
    }

    // A cart goes by in a corridor that is known for long, or it stands and the wheels slip.
    void nothingIsDrawnWhereScansAndOdometryDiffer() {
        const Walls corridor{{{-40, -1}, {40, -1}}, {{40, 1}, {-40, 1}}};
        scanner.maxRange = 5;
        tracker = std::make_unique<ScanTracker>();
        for (int i = 0; i < 20; ++i)
            see(corridor, {}, 10 + 0.1 * i, track({}, 10 + 0.1 * i));
        std::size_t walls = 0;
        for (int i = 20; i < 50; ++i) {
            Walls seen = corridor;
            const float x = 0.1f * float(i) - 0.5f;
            for (const float y : {-0.95f, 0.55f})
                seen.insert(seen.end(), {{{x, y}, {x, y + 0.4f}},
                                         {{x, y + 0.4f}, {x + 1, y + 0.4f}},
                                         {{x + 1, y + 0.4f}, {x + 1, y}},
                                         {{x + 1, y}, {x, y}}});
            see(seen, {}, 10 + 0.1 * i, track({}, 10 + 0.1 * i));
            if (i == 25)
                walls = tracker->builder.map.size();
            QVERIFY2(i < 25 || tracker->trust() < 0.5, saying(tracker->trust()));
        }
        QCOMPARE(tracker->builder.map.size(), walls);
        for (int i = 50; i < 130; ++i) { // along walls that are drawn by the same pose
            const Pose2D pose{0.1 * (i - 49), 0, 0};
            see(corridor, pose, 10 + 0.1 * i, track(pose, 10 + 0.1 * i));
        }
        QVERIFY2(tracker->trust() > 0.5, saying(tracker->trust()));
    }

    // It shows more of the robot's surroundings than the walls, and always the same.
    void whoGoesAlongDoesNotPull() {
        const auto box = [](Walls &walls, const Pose2D &robot, float x, float y, float length, float width) {
            const Transformation2D pose(robot);
            const Vector2D<double> corners[] = {
                {x, y}, {x + length, y}, {x + length, y + width}, {x, y + width}};
            for (int k = 0; k < 4; ++k)
                walls.emplace_back(Vector2D<float>(pose * corners[(k + 1) % 4]),
                                   Vector2D<float>(pose * corners[k]));
        };
        enter();
        Pose2D real{-2, -1, 0};
        for (int i = 0; i < 90; ++i) {
            real.x += i > 20 ? 0.06 : 0;
            Walls seen = room;
            box(seen, real, 0.8f, -0.7f, 0.6f, 1.2f);
            box(seen, real, -0.3f, 0.6f, 1.0f, 0.6f);
            box(seen, real, -0.3f, -1.3f, 1.0f, 0.6f);
            const Pose2D pose =
                see(seen, real, 10.1 + 0.1 * i, track({real.x + 2, real.y + 1, 0}, 10.1 + 0.1 * i)).pose;
            QVERIFY2(std::hypot(pose.x - real.x, pose.y - real.y) < 0.2, saying(pose.x - real.x));
        }
    }

    // Nothing there tells where.
    void aBareCorridorIsNotSlidAlong() {
        const Walls corridor{{{-40, -1}, {40, -1}}, {{40, 1}, {-40, 1}}};
        scanner.maxRange = 5;
        finishMap(corridor, {1, 0, 0});
        for (int i = 0; i < 20; ++i)
            QVERIFY(isNear(see(corridor, {0, 0, 0}, 10 + 0.1 * i).pose, {1, 0, 0}));
    }

    // Who is pushed is doubted though the wheels stand; a map that grows is drawn as the pose errs.
    void aDirectionIsOpenByTheWay() {
        OpenDirection pushed, drives, mapped;
        for (int i = 0; i <= 40; ++i) {
            const Transformation2D pose(0.5 * i, 0, 0);
            pushed.dispute({0.05, 0});
            mapped.follow(pose, true, true, true, std::nullopt, i, {});
            drives.follow(pose, true, true, false, std::nullopt, i, {});
        }
        QVERIFY2(pushed.belief() < 0.5, saying(pushed.belief()));
        QVERIFY2(mapped.belief() > 0.95, saying(mapped.belief()));
        QVERIFY2(drives.belief() < 0.5, saying(drives.belief()));
        for (int i = 0; i < 5; ++i)
            mapped.dispute({0.5, 0});
        QVERIFY2(mapped.belief() < 0.5, saying(mapped.belief()));
    }

private:
    // Between walls of 5 m and 7 m radius.
    static Walls ringCorridor() {
        Walls walls;
        const auto at = [](double radius, int i) {
            return Vector2D<float>(float(radius * std::cos(i * pi / 45)),
                                   float(radius * std::sin(i * pi / 45)));
        };
        for (int i = 0; i < 90; ++i) {
            walls.emplace_back(at(7, i), at(7, i + 1));
            walls.emplace_back(at(5, i + 1), at(5, i));
        }
        return walls;
    }
    static Pose2D inRing(double angle) {
        return {6 * std::cos(angle), 6 * std::sin(angle), wrapAngle(angle + pi / 2)};
    }
};
