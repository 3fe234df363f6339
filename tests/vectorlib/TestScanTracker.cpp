// The tracker of scans: what it expects, how sure it is, and what it forgets.
#include "tests/vectorlib/TrackedRoom.h"

using namespace vectorlib;

Q_DECLARE_METATYPE(vectorlib::Pose2D)
Q_DECLARE_METATYPE(vectorlib::LineSegment2D<float>)

class TestScanTracker : public QObject, TrackedRoom {
    Q_OBJECT
private Q_SLOTS:
    void init() { enter(); }

    void goesByTheOdometry() {
        // To the other end of the room and about, within a tenth of a second: only the odometry can know.
        QVERIFY(isNear(see({2, 1, 2}, 10.1, track({4, 2, 2}, 10.1)).pose, {2, 1, 2}));
        QCOMPARE(tracker->counts().byOdometry, std::uint64_t(1));
        QCOMPARE(tracker->counts().matched, std::uint64_t(2));
    }

    void ignoresTheOdometryWhenTold() {
        ScanTrackerSettings settings;
        settings.useOdometry = false;
        tracker->apply(settings);
        QVERIFY(isNear(see({-1.9, -1, 0.05}, 10.1, track({4, 2, 2}, 10.1)).pose, {-1.9, -1, 0.05}));
        QCOMPARE(tracker->counts().byOdometry, std::uint64_t(0));
    }

    void isAsSureAsTheOdometry() {
        see({-1.9, -1, 0}, 10.1, track({0.1, 0, 0}, 10.1, 0)); // as sure as it can be
        see({-1.8, -1, 0}, 10.2, track({0.2, 0, 0}, 10.2, 0));
        QCOMPARE(tracker->builder.track.settings.expectedDeviationXY, OdometryModel::leastDeviationXY);
        QCOMPARE(tracker->builder.track.settings.expectedDeviationAlpha, OdometryModel::leastDeviationAlpha);
        // Wheels may slip all the same: between two scans the odometry tells only what the scans leave open.
        QCOMPARE(tracker->builder.matchPair.settings.deviationXY, ScanPairSettings().deviationXY);
        see({-1.7, -1, 0}, 10.3, track({0.3, 0, 0}, 10.3, 100)); // no surer than without
        QVERIFY(tracker->builder.track.settings.expectedDeviationXY > 9);
        see({-1.6, -1, 0}, 10.4, track({0.4, 0, 0}, 10.4)); // it does not tell
        QCOMPARE(tracker->builder.track.settings.expectedDeviationXY, TrackingSettings().expectedDeviationXY);
    }

    void looksWidelyAfterAPause() {
        QVERIFY(isNear(see({-0.8, 0, 0.7}, 12).pose, {-0.8, 0, 0.7}));
        QCOMPARE(tracker->counts().matched, std::uint64_t(2));
    }

    void looksNoLessWidelyThanItIsSetUp() {
        ScanTrackerSettings settings;
        settings.tracking.permitted = {5, 0.1, 0.2};
        tracker->apply(settings);
        see({-2, -1, 0}, 12);
        const TrackingSettings &used = tracker->builder.track.settings;
        QCOMPARE(used.permitted.dx, 5.0);
        QCOMPARE(used.permitted.dy, TrackingSettings::forPoorExpectation().permitted.dy);
        see({-2, -1, 0}, 12.1); // a moment later
        QCOMPARE(used.permitted.dy, 0.1);
    }

    void survivesStampsThatStepBack() {
        for (const double stamp : {9.0, 12.0, 8.0, 8.0, 1e9, 0.0})
            QVERIFY(isNear(see({-2, -1, 0}, stamp).pose, {-2, -1, 0}));
        QCOMPARE(tracker->counts().matched, std::uint64_t(7));
    }

    // The motion from the scan before would lead back to where it was wrongly thought to be.
    void placeForgetsTheScanBefore() {
        ScanTrackerSettings settings;
        settings.tracking.permitted = {0.2, 0.2, 0.2};
        tracker->apply(settings);
        tracker->grow(false);
        tracker->place({-1.2, -1.6, 0}); // somebody errs
        QCOMPARE(see({-2, -1, 0}, 10.1).outcome, ScanReport::Outcome::Lost);
        tracker->place({-2, -1, 0}); // and mends it
        QVERIFY(isNear(see({-2, -1, 0}, 10.2).pose, {-2, -1, 0}));
        QCOMPARE(tracker->builder.report().outcome, ScanReport::Outcome::Matched);
    }

    void knowsTheScannerOfEachScan() {
        TimedScan scan;
        scan.points = scanner(room, {-2, -1, 0});
        scan.points.resize(scan.points.size() / 3); // most rays see nothing
        scan.rays = 1800;
        scan.stamp = 10.1;
        tracker->process(scan);
        QCOMPARE(tracker->builder.extract.segment.settings.nominalPoints, std::size_t(1800));
        QCOMPARE(tracker->builder.extract.segment.settings.minPoints, EarSettings().minPoints);
    }

    // Any program may publish scans: fewer rays than points, far more, or none.
    void aLieAboutTheRaysDoesNoHarm() {
        double stamp = 10;
        for (const std::size_t rays : {0, 1, 2, 3, 1000000}) {
            TimedScan scan;
            scan.points = scanner(room, {-2, -1, 0});
            scan.rays = rays;
            scan.stamp = stamp += 0.1;
            QVERIFY(isNear(tracker->process(scan).pose, {-2, -1, 0}));
        }
    }

    void followsScansThatTheMapDoesNotShow() {
        // Through a door: the map and the scan before show nothing of the hall behind it.
        const std::vector<LineSegment2D<float>> hall{{{20, -9}, {37, -9}},
                                                     {{37, -9}, {37, 4}},
                                                     {{37, 4}, {29, 8}},
                                                     {{29, 8}, {20, 8}},
                                                     {{20, 8}, {20, -9}}};
        const auto at = [](int i) { return Pose2D{27 + 0.1 * i, -1, 0.02 * i}; };
        int followed = 0;
        Pose2D before = tracker->builder.report().pose;
        for (int i = 0; i < 8; ++i) {
            const Pose2D told{28 + 0.15 * i, 0, 0.03 * i}; // of the wheels, which slip
            see(hall, at(i), 10.1 + 0.1 * i, track(told, 10.1 + 0.1 * i));
            const Transformation2D motion = tracker->tracked(Transformation2D(before));
            before = tracker->builder.report().pose;
            if (i > 0 && tracker->trackedBy() == TrackedBy::Scan && tracker->builder.isExpectedByScan()) {
                const Pose2D from = at(i - 1), to = at(i);
                QVERIFY(isNear(motion.pose(), from.inverse() * to));
                ++followed;
            }
        }
        QVERIFY2(followed > 0, saying(followed));
    }

    void passesOverAScanOfNothing() {
        see({-1.9, -1, 0}, 10.1, track({0.1, 0, 0}, 10.1));
        TimedScan ground; // a row of points across the way
        for (int i = 0; i < 40; ++i)
            ground.points.emplace_back(1.5F, 0.05F * float(i) - 1);
        ground.rays = std::size_t(scanner.rays);
        ground.stamp = 10.2;
        ground.odometry = track({0.2, 0, 0}, 10.2);
        QVERIFY(tracker->process(ground).outcome != ScanReport::Outcome::Matched);
        QVERIFY(tracker->builder.isPassedOver());
        QVERIFY(isNear(see({-1.7, -1, 0}, 10.3, track({0.4, 0.1, 0.1}, 10.3)).pose, {-1.7, -1, 0}));
        QVERIFY(tracker->builder.isExpectedByScan());
        QVERIFY(!tracker->builder.isPassedOver());
    }

    void clearForgetsAll() {
        tracker->clear();
        QVERIFY(tracker->builder.map.isEmpty());
        QCOMPARE(tracker->counts().scans, std::uint64_t(0));
        QVERIFY(isNear(see({3, 2, 1}, 5).pose, {0, 0, 0})); // the first scan makes the frame
    }

    void trustIsHighInARoom() {
        for (int i = 1; i <= 20; ++i) {
            see({-2 + 0.1 * i, -1, 0.05 * i}, 10 + 0.1 * i);
            QVERIFY2(tracker->trust() > 0.9 && tracker->trust() <= 1, saying(tracker->trust()));
        }
    }

    // They stand close around and are elsewhere in each scan; some wall is seen between them.
    void trustIsLowAmongPeople() {
        std::mt19937 random(1);
        std::uniform_real_distribution<double> way(0.5, 1.5), angle(-pi, pi);
        double sum = 0;
        for (int i = 1; i <= 20; ++i) {
            std::vector<LineSegment2D<float>> world = room;
            for (int person = 0; person < 14; ++person) {
                const double a = angle(random), r = way(random);
                const Vector2D<float> p(float(-1.5 + r * std::cos(a)), float(-0.5 + r * std::sin(a)));
                for (int k = 0; k < 4; ++k) {
                    const auto corner = [&](int n) {
                        const double at = a + n * pi / 2;
                        return p + Vector2D<float>(float(0.25 * std::cos(at)), float(0.25 * std::sin(at)));
                    };
                    world.emplace_back(corner(k + 1), corner(k));
                }
            }
            see(world, {-1.5, -0.5, 0}, 10 + 0.1 * i);
            sum += tracker->trust();
        }
        QVERIFY2(sum / 20 < 0.5, saying(sum / 20));
    }

    void trustIsNoneWhenLost() {
        ScanTrackerSettings settings;
        settings.tracking.permitted = {0.2, 0.2, 0.2};
        tracker->apply(settings);
        tracker->grow(false);
        QVERIFY(tracker->trust() == 0); // of the first scan: there was no map
        tracker->place({1, 2, 1});
        QCOMPARE(see({-2, -1, 0}, 10.1).outcome, ScanReport::Outcome::Lost);
        QCOMPARE(tracker->trust(), 0.0);
    }

    void whatContradictsAFinishedMapIsLost_data() {
        const Rows<std::vector<LineSegment2D<float>>, Pose2D, bool> row("world", "pose", "isLost");
        row("as it was", room, {-2, -1, 0}, false);
        row("carried by 0.45 m", room, {-1.55, -1, 0}, true);
        row("turned by 20 degrees", room, {-2, -1, 0.35}, true);
        auto furnished = room;
        for (const float x : {-3.f, 1.f}) // two cupboards at the lower wall
            for (const LineSegment2D<float> &side : {LineSegment2D<float>({x + 1, -3}, {x + 1, -2.5f}),
                                                     LineSegment2D<float>({x + 1, -2.5f}, {x, -2.5f}),
                                                     LineSegment2D<float>({x, -2.5f}, {x, -3})})
                furnished.push_back(side);
        row("new furniture", furnished, {-2, -1, 0}, false);
    }
    void whatContradictsAFinishedMapIsLost() {
        using World = std::vector<LineSegment2D<float>>;
        FETCH(World, world, Pose2D, pose, bool, isLost);
        for (int i = 1; i <= 5; ++i)
            see({-2, -1, 0}, 10 + 0.1 * i, track({}, 10 + 0.1 * i));
        tracker->grow(false);
        int lost = 0, wrong = 0;
        for (int i = 6; i < 26; ++i) { // the odometry knows nothing of it
            const ScanReport &report = see(world, pose, 10 + 0.1 * i, track({}, 10 + 0.1 * i));
            lost += report.outcome != ScanReport::Outcome::Matched;
            wrong += report.outcome == ScanReport::Outcome::Matched && !isNear(report.pose, pose);
        }
        QVERIFY2(wrong <= 10, saying(wrong));
        QVERIFY2(isLost || lost == 0, saying(lost));
    }

    void whatIsKnownAgainstAPlaceFadesWithTheWay() {
        auto furnished = room;
        furnished.push_back({{0, -3}, {0, -1.5f}});
        tracker->grow(false);
        tracker->place({-2, -1, 0});
        see(furnished, {-2, -1, 0}, 10.1);
        const double first = tracker->against();
        for (int i = 2; i < 40; ++i)
            see(furnished, {-2, -1, 0}, 10 + 0.1 * i);
        const double known = tracker->against();
        QVERIFY(known > 0.02 && first > 0.5 * known); // the first scan counts in full
        tracker->place({-2, -1, 0}, known);
        for (int i = 40; i < 80; ++i)
            see(furnished, {-2, -1, 0}, 10 + 0.1 * i);
        QVERIFY(tracker->against() < 0.1 * known);
        for (int i = 80; i <= 100; ++i) // to and fro
            see(furnished, {-2 + 0.1 * std::min(i - 80, 100 - i), -1, 0}, 10 + 0.1 * i);
        QVERIFY(tracker->against() > 0.3 * known);
    }

    void whatContradictedAMapDoesNotStopItsGrowth() {
        float far = 4.5f; // walls that are not where the map has them, so far that some of it still matches
        for (; far < 12 && !tracker->isContradicted(); far += 0.5f) {
            init();
            tracker->grow(false);
            for (int i = 1; i < 30 && !tracker->isContradicted(); ++i)
                see({{{-4, -3}, {far, -3}},
                     {{far, -3}, {far, far}},
                     {{far, far}, {-4, far}},
                     {{-4, far}, {-4, -3}}},
                    {-2, -1, 0}, 10 + 0.1 * i, track({}, 10 + 0.1 * i));
        }
        QVERIFY(tracker->isContradicted());
        QCOMPARE(tracker->builder.report().outcome, ScanReport::Outcome::Lost);
        tracker->grow(true);
        QCOMPARE(see({-2, -1, 0}, 13.1, track({}, 13.1)).outcome, ScanReport::Outcome::Matched);
    }

    void aCorrectedMountContradictsNothing() {
        ScanTrackerSettings settings;
        settings.sensorOnRobot = {0, 0, pi / 2}; // it is not
        tracker->apply(settings);
        tracker->place({-2, -1, 0}); // no piece begins before
        const auto drive = [this](int from, int to) {
            for (int i = from; i < to; ++i)
                see({-2 + 0.05 * i, -1, 0}, 10 + 0.1 * i, track({0.05 * i, 0, 0}, 10 + 0.1 * i));
        };
        drive(1, 9); // a piece
        tracker->apply({});
        drive(9, 23);
        QCOMPARE(tracker->counts().contradicted, std::uint64_t(0));
        tracker->apply(settings);
        drive(23, 40);
        QVERIFY(tracker->counts().contradicted > 0);
    }

    void whatIsSoughtIsLostUntilItIsFound() {
        tracker->seek();
        QCOMPARE(see({-2, -1, 0}, 10.1).outcome, ScanReport::Outcome::Lost);
        const auto found = tracker->recover();
        QVERIFY(found && found->isFound());
        QCOMPARE(see({-2, -1, 0}, 10.2).outcome, ScanReport::Outcome::Matched);
        QVERIFY(tracker->agrees());
    }

    // A second look from the same spot tells nothing new, however long it takes.
    void whatIsFoundIsKnownSomeWayOn() {
        tracker->seek();
        see({-2, -1, 0}, 10.1);
        QVERIFY(tracker->search().isFound());
        for (int i = 2; i < 60; ++i)
            see({-2, -1, 0}, 10 + 0.1 * i);
        QVERIFY(tracker->placeState() == PlaceState::Found && !tracker->wantsSearch());
        const Transformation2D moved(2, 0, 0); // the map, and the place with it
        VectorMap corrected;
        tracker->builder.map.forEach([&](const MapEdge &edge) { corrected.add(moved * EdgeRaw2D(edge)); });
        for (const auto &[step, stamp] : {std::pair(moved, 15.93), std::pair(moved.inverse(), 15.96)}) {
            tracker->correct(corrected, step); // and gives the one before
            QCOMPARE(see({-2, -1, 0}, stamp).outcome, ScanReport::Outcome::Matched);
            QVERIFY(!tracker->wantsSearch());
        }
        QVERIFY(tracker->trust() < 0.5);
        int i = 60;
        for (; !tracker->wantsSearch() && i < 80; ++i)
            see({-2 + 0.1 * (i - 60), -1, 0}, 10 + 0.1 * i);
        QVERIFY(i >= 70 && tracker->wantsToConfirm());
        tracker->search();
        QVERIFY(tracker->placeState() == PlaceState::Known);
    }

    void trustIsAProbabilityWhateverComes() {
        const double nan = std::nan(""), infinite = std::numeric_limits<double>::infinity();
        const double hostile[] = {0, 1, -1, 1e300, -1e300, nan, infinite, -infinite};
        const PoseTrust trust;
        for (const double a : hostile)
            for (const double b : hostile)
                for (const double c : hostile) {
                    Match match;
                    match.pose = Transformation2D(a, b, 0);
                    match.reliability = a;
                    match.rms = b;
                    match.matchedLength = c;
                    match.visibleLength = a;
                    const double p = trust(PoseTrust::features(match, Transformation2D(c, 0, 0), b));
                    QVERIFY(p >= 0 && p <= 1);
                }
        QCOMPARE(trust({1, nan, 0, 0, 0, 0}), 0.0);
    }
};
