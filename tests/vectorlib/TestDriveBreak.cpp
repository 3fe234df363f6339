// What tells that the sensor was carried while it maps.
#include "tests/vectorlib/TrackedRoom.h"

using namespace vectorlib;

class TestDriveBreak : public QObject, TrackedRoom {
    Q_OBJECT
private Q_SLOTS:
    void init() { enter(); }

    void aBreakIsToldByWhatTheMapHidesMore() {
        const auto matched = ScanReport::Outcome::Matched;
        DriveBreak drive;
        QVERIFY(!drive.isContradicted(matched, 0.3, false)); // the map is bent
        drive.take(matched, true, false, false, 0);
        QVERIFY(drive.isSuspect());
        QVERIFY(!drive.isContradicted(matched, 0.4, false));
        QVERIFY(!drive.isSuspect());
        drive.correct(); // it is not bent any more
        drive.take(matched, true, false, false, 0);
        QVERIFY(drive.isContradicted(matched, 0.3, false));
    }

    // Who is carried contradicts one scan, who walks beside the sensor one after another.
    void aDriveTearsBetweenTwoScans() {
        const auto matched = ScanReport::Outcome::Matched;
        DriveBreak carried, walked;
        carried.take(matched, true, true, false, 0.2);
        QVERIFY(carried.mayBeTorn() && !carried.isTorn());
        carried.take(matched, true, true, false, 0.01);
        QVERIFY(carried.isTorn());
        for (int i = 0; i < 5; ++i) {
            walked.take(matched, true, true, false, 0.2);
            QVERIFY(!walked.isTorn());
        }
        QVERIFY(!walked.mayBeTorn());
        DriveBreak bent;
        bent.take(matched, true, true, false, 0.2);
        bent.take(matched, true, true, false, std::nullopt); // there was nothing to compare
        QVERIFY(!bent.isTorn());
    }

    void whatTheMapShowsTearsNoDrive() {
        const auto matched = ScanReport::Outcome::Matched;
        DriveBreak drive;
        drive.take(matched, true, false, true, 0.2);
        QVERIFY(drive.isSuspect() && !drive.mayBeTorn());
        QVERIFY(!drive.isContradicted(matched, 0.5, false));
        drive.take(matched, true, true, true, 0.01);
        QVERIFY(!drive.isTorn());
    }

    // As the lost scan between the two is passed over.
    void twoScansThatTheSameOneContradictTearADrive() {
        const auto lost = ScanReport::Outcome::Lost;
        DriveBreak drive;
        drive.take(ScanReport::Outcome::Matched, true, true, false, 0);
        drive.take(lost, true, false, false, 0.4);
        QVERIFY(drive.mayBeTorn() && !drive.isTorn());
        drive.take(lost, true, false, false, 0.4, true);
        QVERIFY(drive.isTorn());
    }

    void oneBadScanTearsNoDrive() {
        const auto lost = ScanReport::Outcome::Lost, matched = ScanReport::Outcome::Matched;
        DriveBreak drive;
        drive.take(matched, true, true, false, 0);
        drive.take(lost, true, false, false, 0.4);
        QVERIFY(drive.mayBeTorn());
        drive.take(matched, true, true, false, 0.01, true); // the scan before the bad one shows it
        QVERIFY(!drive.isTorn() && !drive.mayBeTorn());
    }

    // The odometry knows nothing of it, and the map does not have the place.
    void whoIsCarriedMapsNothing() {
        const std::vector<LineSegment2D<float>> other{{{0, 0}, {2, 0}},    {{2, 0}, {2, 9}},
                                                      {{2, 9}, {0.5f, 9}}, {{0.5f, 9}, {0.5f, 7}},
                                                      {{0.5f, 7}, {0, 7}}, {{0, 7}, {0, 0}}};
        for (int i = 1; i < 6; ++i)
            see({-2, -1, 0}, 10 + 0.1 * i, track({}, 10 + 0.1 * i));
        const std::size_t walls = tracker->builder.map.size();
        for (int i = 6; i < 40; ++i) {
            see(other, {1, 3, 0.4}, 10 + 0.1 * i, track({}, 10 + 0.1 * i));
            QVERIFY(tracker->trust() < 0.5);
        }
        QCOMPARE(tracker->builder.map.size(), walls);
        QVERIFY(tracker->placeState() == PlaceState::Sought);
        QCOMPARE(tracker->counts().restarts, std::uint64_t(0));
    }

    // What the odometry and the scan before tell does not hold over a pause or a leap: then the map decides.
    void whoIsCarriedInAPauseMapsNothing_data() {
        QTest::addColumn<double>("pause_s");
        QTest::addColumn<double>("leap_m");
        QTest::addColumn<bool>("hasOdometry");
        QTest::addColumn<bool>("isCarried");
        for (const bool isCarried : {true, false}) {
            const auto row = [isCarried](const char *name) -> QTestData & {
                return QTest::addRow("%s, %s", name, isCarried ? "carried" : "as before");
            };
            row("no scans for 6 s") << 6.0 << 0.0 << true << isCarried;
            row("without odometry") << 6.0 << 0.0 << false << isCarried;
            row("the clock is set back") << -5.0 << 0.0 << true << isCarried;
            row("the odometry leaps") << 0.1 << 2.0 << true << isCarried;
        }
    }
    void whoIsCarriedInAPauseMapsNothing() {
        QFETCH(double, pause_s);
        QFETCH(double, leap_m);
        QFETCH(bool, hasOdometry);
        QFETCH(bool, isCarried);
        const auto seen = [&](const Walls &world, const Pose2D &pose, double stamp, double x) {
            see(world, pose, stamp, hasOdometry ? std::optional(track({x, 0, 0}, stamp)) : std::nullopt);
        };
        for (int i = 1; i < 6; ++i)
            seen(room, {-2, -1, 0}, 10 + 0.1 * i, 0);
        const std::size_t walls = tracker->builder.map.size();
        const Walls other{{{0, 0}, {2, 0}},       {{2, 0}, {2, 9}},    {{2, 9}, {0.5f, 9}},
                          {{0.5f, 9}, {0.5f, 7}}, {{0.5f, 7}, {0, 7}}, {{0, 7}, {0, 0}}};
        for (int i = 0; i < 40; ++i) {
            const double stamp = 10.5 + pause_s + 0.1 * i;
            isCarried ? seen(other, {1, 3, 0.4}, stamp, leap_m) : seen(room, {-2, -1, 0}, stamp, leap_m);
            QVERIFY(!isCarried || tracker->trust() < 0.5);
            QVERIFY(isCarried || i < 5 || tracker->trust() > 0.5 || leap_m > 0);
        }
        QCOMPARE(tracker->builder.map.size(), walls);
        QCOMPARE(tracker->counts().restarts, std::uint64_t(0));
        QCOMPARE(tracker->placeState() == PlaceState::Known, !isCarried);
    }

    // None of these is a pause.
    void slowDoubledAndSwappedScansAreMapped_data() {
        QTest::addColumn<QVector<double>>("stamps"); // of the first scans; the others go on as they begin
        QTest::newRow("slow") << QVector<double>{10, 11, 12, 13};
        QTest::newRow("doubled") << QVector<double>{10, 10.1, 10.1, 10.1, 10.2, 10.2, 10.2, 10.3, 10.3, 10.4};
        QTest::newRow("swapped") << QVector<double>{10, 10.2, 10.1, 10.3, 10.5, 10.4, 10.6, 10.8, 10.7, 10.9};
    }
    void slowDoubledAndSwappedScansAreMapped() {
        QFETCH(QVector<double>, stamps);
        const Walls longer{{{-4, -3}, {9, -3}}, {{9, -3}, {9, 3}}, {{9, 3}, {-4, 3}}, {{-4, 3}, {-4, -3}}};
        tracker = std::make_unique<ScanTracker>();
        while (stamps.size() < 20)
            stamps.append(stamps.last() + stamps[1] - stamps[0]);
        int known = 0;
        for (const double stamp : qAsConst(stamps)) {
            see(longer, {0.2 * stamp - 4, 0, 0}, stamp, track({0.2 * stamp, 0, 0}, stamp));
            known += tracker->placeState() == PlaceState::Known;
        }
        QVERIFY2(known > 14, saying(known)); // not before a slow scanner is known for one
        int often = 0;
        tracker->builder.map.forEach([&](const MapEdge &edge) { often += edge.observations > 5; });
        QVERIFY(often >= 4);
    }

    // Neither the scan before nor the map tells where along the walls the sensor is, and the odometry knows
    // nothing of it.
    void whoIsCarriedBetweenWallsAlikeMapsNothing() {
        const auto box = [](float half) {
            return Walls{{{-half, -1}, {half, -1}},
                         {{half, -1}, {half, 1}},
                         {{half, 1}, {-half, 1}},
                         {{-half, 1}, {-half, -1}}};
        };
        tracker = std::make_unique<ScanTracker>();
        for (int i = 0; i < 8; ++i)
            see(box(3), {}, 10 + 0.1 * i, track({}, 10 + 0.1 * i));
        for (int i = 8; i < 16; ++i) {
            see(box(0.8f), {}, 10 + 0.1 * i, track({}, 10 + 0.1 * i));
            QVERIFY(tracker->trust() < 0.5);
        }
        QCOMPARE(tracker->builder.map.size(), std::size_t(4));
        QVERIFY(tracker->placeState() == PlaceState::Sought);
    }

    // A room that is nearly the same: the scan before shows it, too, but not where the odometry leads. Also
    // where a map that was bent hid as much before it was corrected.
    void whoIsCarriedToARoomAlikeMapsNothing_data() {
        falseAndTrue("wasBent", "from a good map", "from one that was bent");
    }
    void whoIsCarriedToARoomAlikeMapsNothing() {
        QFETCH(bool, wasBent);
        auto alike = room;
        for (LineSegment2D<float> &wall : alike)
            wall = {{wall.begin().x == 4 ? 4.3f : wall.begin().x, wall.begin().y},
                    {wall.end().x == 4 ? 4.3f : wall.end().x, wall.end().y}};
        tracker->place({1, 0, 0});
        for (int i = 1; i < 5; ++i)
            see({1, 0, 0}, 10 + 0.1 * i, track({}, 10 + 0.1 * i));
        if (wasBent) {
            VectorMap good = tracker->builder.map, bent;
            good.forEach([&](const MapEdge &edge) {
                const bool isRight = std::min(edge.segment.begin().x, edge.segment.end().x) > 3.9;
                bent.add(Transformation2D(isRight ? -1 : 0, 0, 0) * EdgeRaw2D(edge));
            });
            tracker->correct(bent, {});
            see({1, 0, 0}, 10.5, track({}, 10.5)); // the fifth scan, which is judged
            tracker->correct(good, {});
        }
        const std::size_t walls = tracker->builder.map.size();
        for (int i = 6; i < 20; ++i)
            see(alike, {0.5, 0, 0}, 10 + 0.1 * i, track({}, 10 + 0.1 * i));
        QCOMPARE(tracker->builder.map.size(), walls);
        QVERIFY(tracker->placeState() == PlaceState::Sought);
    }
};
