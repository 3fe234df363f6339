#include <vectorlib/graph/DriveRefiner.h>

#include "tests/vectorlib/RevisitError.h"
#include "tests/vectorlib/RingBuilding.h"

using namespace vectorlib;

/// Poses that are nearly right.
class TestDriveRefiner : public QObject {
    Q_OBJECT

    /// Twice around a building, and the poses as they may be after loops were closed: they waver by some
    /// centimetres, slowly.
    struct Drive {
        std::vector<Pose2D> poses, wavering;
        DriveRefiner refine;

        explicit Drive(unsigned seed) {
            std::mt19937 random(seed);
            std::normal_distribution<double> noise;
            RingBuilding building(random);
            poses = building.drive(2);
            double x = 0, y = 0, alpha = 0;
            constexpr double kept = 0.95;
            for (std::size_t i = 0; i < poses.size(); ++i) {
                x = kept * x + 0.01 * noise(random);
                y = kept * y + 0.01 * noise(random);
                alpha = kept * alpha + 0.003 * noise(random);
                wavering.push_back({poses[i].x + x, poses[i].y + y, poses[i].theta + alpha});
                refine.add(building.world.scan(Transformation2D(poses[i]), random, {361, 1.5 * pi, 0.02, 12}),
                           i > 0 ? between(wavering[i - 1], wavering[i]) : Transformation2D());
            }
        }
    };

private Q_SLOTS:
    void posesBecomeMoreExact() {
        const unsigned seed = newSeed();
        for (unsigned building = 0; building < 3; ++building) {
            Drive d(seed + building);
            std::vector<Pose2D> refined = d.wavering;
            std::size_t told = 0, keys = 0;
            QVERIFY(d.refine(refined, {}, [&](std::size_t done, std::size_t all) {
                QCOMPARE(done, ++told);
                keys = all;
            }));
            QVERIFY(told > 0 && told == keys);
            const double before = revisitError(d.poses, d.wavering), after = revisitError(d.poses, refined);
            qInfo("%.4f to %.4f m", before, after);
            QVERIFY2(after < 0.5 * before, saying("%1 to %2", before, after));
            QCOMPARE(refined[0].x, d.wavering[0].x);
        }
    }

    // A loop to a room that is alike, which its weight hardly gives up.
    void aWrongLoopDoesNoHarm() {
        Drive d(3);
        std::vector<Pose2D> alone = d.wavering, withLoop = d.wavering;
        const std::size_t last = d.poses.size() - 1;
        PoseConstraint wrong;
        wrong.to = last;
        wrong.motion = between(d.poses[0], d.poses[last]) * Transformation2D(3, 0, 0);
        wrong.information *= 1e3;
        wrong.mayBeWrong = true;
        QVERIFY(d.refine(alone, {}));
        QVERIFY(d.refine(withLoop, {wrong}));
        QVERIFY(revisitError(d.poses, withLoop) < revisitError(d.poses, alone) + 0.001);
    }

    // Scans that are not where they are thought to be offer no match that counts.
    void posesThatAreFarOffStay() {
        Drive d(4);
        std::vector<Pose2D> poses = d.wavering;
        for (std::size_t i = poses.size() / 2; i < poses.size(); ++i)
            poses[i].x += 1;
        const std::vector<Pose2D> before = poses;
        QVERIFY(d.refine(poses, {}));
        double farthest = 0;
        for (std::size_t i = 0; i < poses.size(); ++i)
            farthest = std::max(farthest, std::hypot(poses[i].x - before[i].x, poses[i].y - before[i].y));
        QVERIFY2(farthest < 0.3, saying(farthest));
    }

    void scansOfNothingMoveNothing() {
        DriveRefiner refine;
        std::vector<Pose2D> poses;
        QVERIFY(refine(poses, {}));
        for (int i = 0; i < 100; ++i) {
            poses.push_back({std::cos(0.2 * i) * 5, std::sin(0.2 * i) * 5, std::remainder(0.2 * i, 2 * pi)});
            refine.add({}, Transformation2D(1, 0, 0.2));
        }
        const std::vector<Pose2D> before = poses;
        QVERIFY(refine(poses, {}));
        for (std::size_t i = 0; i < poses.size(); ++i)
            QVERIFY(std::hypot(poses[i].x - before[i].x, poses[i].y - before[i].y) < 1e-9);
    }

    void asManyPosesAsScans() {
        DriveRefiner refine;
        refine.add({}, {});
        std::vector<Pose2D> poses(2);
        QVERIFY(!refine(poses, {}));
    }
};
