#include <vectorlib/mapping/GlobalPairMatcher.h>
#include <vectorlib/simd/Lanes.h>

#include "tests/support/AllocationCounter.h"
#include "tests/vectorlib/RepeatingWorlds.h"
#include "tests/vectorlib/ScanWorld.h"

using namespace vectorlib;
using Points = ScanWorld::Points;
using Verdict = GlobalPairVerdict;

static const ScanWorld::Scanner wholeTurn{720, 2 * pi, 0.01};

static double metres(const Transformation2D &a, const Transformation2D &b) {
    return (a.translation() - b.translation()).norm();
}
static double degrees(const Transformation2D &a, const Transformation2D &b) {
    return std::abs((a.inverse() * b).alpha()) * 180 / pi;
}
static bool isRight(const GlobalPairSolution &s, const Transformation2D &motion) {
    return metres(s.pose, motion) < 0.03 && degrees(s.pose, motion) < 0.5;
}
static bool holds(const GlobalPairMatch &match, const Transformation2D &motion) {
    return std::any_of(match.solutions.begin(), match.solutions.end(),
                       [&](const GlobalPairSolution &s) { return isRight(s, motion); });
}
static double probabilities(const GlobalPairMatch &match) {
    double sum = 0;
    for (const GlobalPairSolution &s : match.solutions)
        sum += s.probability;
    return sum;
}
/// One is contradicted hardly more, of what both scans could see, and explains 0.6 of as much or more.
static bool fitsAlike(const SurfaceAgreement &one, const SurfaceAgreement &other) {
    const auto contradicted = [](const SurfaceAgreement &a) {
        return a.contradicted() / (a.explained() + a.contradicted());
    };
    return one.explained() > 0.6 * other.explained() && contradicted(one) < contradicted(other) + 0.02;
}
/// A hall with niches and pillars, of which every part looks different.
static ScanWorld hall() {
    ScanWorld w = ScanWorld::of(
        {{-7, -4}, {2, -4}, {2, -5}, {4, -5}, {4, -4}, {8, -4}, {8, 3}, {5, 5}, {-3, 5}, {-3, 4}, {-7, 4}});
    w.pillars = {{{5, 0}, 0.4}, {{-4, 2}, 0.3}, {{0, 3}, 0.2}, {{-5, -2}, 0.5}};
    return w;
}

/// The motion between two scans from nothing but the scans.
class TestGlobalPairMatcher : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void anyMotionIsFound_data() {
        const Rows<int, int, double> row("world", "rays", "turn");
        row("hall, whole turn", 0, 720, 1.0);
        row("hall, coarse", 0, 240, 1.0);
        row("hall, half a turn", 0, 361, 0.5);
        row("round pillars", 1, 720, 1.0);
    }

    void anyMotionIsFound() {
        FETCH(int, world, int, rays, double, turn);
        std::mt19937 random(newSeed());
        const ScanWorld place = world == 0 ? hall() : ScanWorld::grove();
        const ScanWorld::Scanner scanner{rays, 2 * pi * turn, 0.01};
        // A scanner of half a turn may look elsewhere: less of a turn is sure to overlap.
        std::uniform_real_distribution<double> shift(-1.2, 1.2),
            angle(-pi * (turn * 2 - 0.7), pi * (turn * 2 - 0.7));
        std::uniform_real_distribution<double> heading(-pi, pi);
        GlobalPairMatcher match;
        int right = 0, wrong = 0;
        constexpr int runs = 60;
        for (int i = 0; i < runs; ++i) {
            const Transformation2D from(world == 0 ? shift(random) : shift(random) - 1, shift(random) / 2,
                                        turn == 1 ? heading(random) : heading(random) / 12);
            const Transformation2D motion(shift(random), shift(random), angle(random));
            const GlobalPairMatch &found =
                match(place.scan(from, random, scanner), place.scan(from * motion, random, scanner));
            if (!found.isAccepted())
                continue;
            right += isRight(found.solutions[0], motion);
            wrong += metres(found.solutions[0].pose, motion) > 0.5 ||
                     degrees(found.solutions[0].pose, motion) > 10;
            QVERIFY(found.solutions[0].probability >= match.settings.enough);
            QVERIFY(probabilities(found) < 1 + 1e-9);
        }
        QCOMPARE(wrong, 0);
        QVERIFY2(right >= 0.9 * runs, saying(right));
    }

    void motionAndItsInverse() {
        std::mt19937 random(newSeed());
        std::uniform_real_distribution<double> shift(-1.5, 1.5), angle(-pi, pi);
        GlobalPairMatcher match;
        for (int i = 0; i < 30; ++i) {
            const Transformation2D motion(shift(random), shift(random), angle(random));
            const Points a = hall().scan({}, random, wholeTurn), b = hall().scan(motion, random, wholeTurn);
            const GlobalPairSolution there = match(a, b).solutions.at(0);
            const GlobalPairSolution back = match(b, a).solutions.at(0);
            QVERIFY(isRight(there, motion));
            QVERIFY(metres(there.pose * back.pose, {}) < 0.02 && degrees(there.pose * back.pose, {}) < 0.3);
        }
    }

    void corridorIsOpenAlongIt() {
        std::mt19937 random(4);
        const Transformation2D motion(0.3, 0.1, 0.1);
        const ScanWorld corridor = ScanWorld::corridor();
        GlobalPairMatcher match;
        const GlobalPairMatch &found =
            match(corridor.scan({}, random, wholeTurn), corridor.scan(motion, random, wholeTurn));
        QVERIFY2(found.verdict == Verdict::OpenDirection, describe(found.verdict));
        QVERIFY(!found.isAccepted());
        // The solutions stand in lines along the corridor, facing either way; each knows what lies across.
        int along = 0;
        double least = 0, most = 0;
        for (const GlobalPairSolution &s : found.solutions) {
            const double side = std::cos(s.pose.alpha()) > 0 ? 1 : -1;
            if (std::abs(s.pose.y() - side * 0.1) > 0.05 || std::abs(std::sin(s.pose.alpha() - 0.1)) > 0.02)
                continue;
            ++along;
            least = std::min(least, side * s.pose.x());
            most = std::max(most, side * s.pose.x());
            const Eigen::Matrix3d covariance = match.covarianceOf(s);
            QVERIFY(covariance(0, 0) > 100 * covariance(1, 1));
            QVERIFY(covariance(1, 1) < 0.01 * 0.01 && covariance(2, 2) < 0.01 * 0.01);
            QVERIFY(s.probability < 0.8);
        }
        QVERIFY2(along >= 8 && most - least > 2, saying(along));
    }

    void symmetricRoomIsAmbiguous_data() {
        const Rows<double, int> row("width", "ways");
        row("rectangle", 8.0, 2);
        row("square", 6.0, 4);
    }

    void symmetricRoomIsAmbiguous() {
        FETCH(double, width, int, ways);
        std::mt19937 random(5);
        const double x = width / 2;
        const ScanWorld room = ScanWorld::of({{-x, -3}, {x, -3}, {x, 3}, {-x, 3}});
        GlobalPairMatcher match;
        const Transformation2D from(0.5, -0.7, 0.3), motion(0.6, 0.4, 0.5);
        const GlobalPairMatch &found =
            match(room.scan(from, random, wholeTurn), room.scan(from * motion, random, wholeTurn));
        QVERIFY2(found.verdict == Verdict::Ambiguous, describe(found.verdict));
        for (int way = 0; way < ways; ++way) {
            const Transformation2D turned(0, 0, 2 * pi * way / ways);
            QVERIFY(holds(found, from.inverse() * turned * from * motion));
        }
        QVERIFY(found.solutions[0].probability < 0.9);
        QVERIFY(found.solutions[1].probability > 0.02);
    }

    // Where all looks alike the true motion may explain less than another one, as the views overlap less. If
    // it fits as well what both scans could see, the other one is hardly ever accepted.
    void whatFitsAlikeIsAmbiguous() {
        constexpr unsigned seed = 13;
        qInfo("seed %u", seed);
        std::mt19937 random(seed);
        RepeatingWorlds worlds(random);
        GlobalPairMatcher match, judge;
        int right = 0, wrong = 0, alike = 0;
        constexpr int kinds = 8, runs = 80;
        for (int i = 0; i < kinds * runs; ++i) {
            const RepeatingWorlds::Pair pair = worlds.draw(RepeatingWorlds::Kind(i % kinds));
            const GlobalPairMatch &found = match(pair.fixed, pair.moving);
            if (!found.isAccepted())
                continue;
            const GlobalPairSolution &best = found.solutions[0];
            if (metres(best.pose, pair.motion) < 0.5 && degrees(best.pose, pair.motion) < 10) {
                ++right;
                continue;
            }
            ++wrong;
            const GlobalPairMatch &truth = judge.judge(pair.fixed, pair.moving, pair.motion);
            alike += !truth.solutions.empty() && fitsAlike(truth.solutions[0].agreement, best.agreement);
        }
        qInfo("accepted: %d right, %d far wrong, %d of them while the truth fits alike", right, wrong, alike);
        QVERIFY2(alike <= runs * kinds / 80, saying(alike)); // of some the search sees none
        QVERIFY2(wrong <= runs * kinds / 32, saying(wrong));
        QVERIFY2(right >= 0.4 * runs * kinds, saying(right));
    }

    void mirroredRoomIsNotTheSame() {
        std::mt19937 random(6);
        const ScanWorld room = hall();
        Points mirrored = room.scan({}, random, wholeTurn);
        for (auto &p : mirrored)
            p.y = -p.y;
        std::reverse(mirrored.begin(), mirrored.end());
        GlobalPairMatcher match;
        const GlobalPairMatch &found = match(room.scan({}, random, wholeTurn), mirrored);
        QVERIFY2(!found.isAccepted(), describe(found.verdict));
    }

    void anotherPlaceIsRefused() {
        std::mt19937 random(7);
        GlobalPairMatcher match;
        for (int i = 0; i < 40; ++i) {
            const Transformation2D pose(0.05 * i - 1, 0, 0.3 * i);
            const GlobalPairMatch &found =
                match(hall().scan(pose, random), ScanWorld::grove().scan({-1, 0.1 * i - 2, 0}, random));
            QVERIFY2(!found.isAccepted(), saying(i));
        }
    }

    void nothingIsMadeOfNothing() {
        std::mt19937 random(9);
        const float nan = std::numeric_limits<float>::quiet_NaN(),
                    inf = std::numeric_limits<float>::infinity();
        const Points good = hall().scan({}, random), empty, one{{1, 1}},
                     bad{{nan, 1}, {inf, -inf}, {3e38f, -3e38f}, {0, 0}, {-0.0f, nan}},
                     same(300, Vector2D<float>(2, 0)), origin(300, Vector2D<float>(0, 0));
        Points wall;
        for (int i = 0; i < 200; ++i)
            wall.emplace_back(2.0f, 0.02f * float(i) - 2);
        GlobalPairMatcher match;
        for (const Points *a : {&empty, &one, &bad, &same, &origin}) {
            QCOMPARE(match(*a, good).verdict, Verdict::NothingFixed);
            QCOMPARE(match(good, *a).verdict, Verdict::NothingMoving);
            QCOMPARE(match(*a, *a).verdict, Verdict::NothingFixed);
            QVERIFY(match(good, *a).solutions.empty());
        }
        const GlobalPairMatch &oneWall = match(wall, wall);
        QVERIFY2(!oneWall.isAccepted(), describe(oneWall.verdict));
        Points holes = good;
        for (std::size_t i = 0; i < holes.size(); i += 7)
            holes[i].x = nan;
        QVERIFY(match(good, good).isAccepted());
        QVERIFY(match(good, holes).isAccepted());
        QVERIFY(metres(match(good, holes).solutions[0].pose, {}) < 0.01);
    }

    void manyPointsTakeBoundedTime() {
        std::mt19937 random(10);
        std::uniform_real_distribution<float> any(-50, 50), ring(-pi, pi);
        Points noise, spiral, otherNoise;
        for (int i = 0; i < 100000; ++i) {
            noise.emplace_back(any(random), any(random));
            otherNoise.emplace_back(any(random), any(random));
            const float angle = float(2 * pi * i / 100000 - pi), r = 3 + 0.5f * std::sin(40 * angle);
            spiral.emplace_back(r * std::cos(angle), r * std::sin(angle));
        }
        const Points fine = hall().scan({}, random, {100000, 2 * pi, 0.01});
        const Points other = hall().scan({0.4, 0.3, 2}, random, {100000, 2 * pi, 0.01});
        GlobalPairMatcher match;
        auto timer = runningTimer();
        QVERIFY(!match(noise, otherNoise).isAccepted());
        QVERIFY(!match(spiral, noise).isAccepted());
        QVERIFY(!match(spiral, spiral).isAccepted()); // it fits every ninth of a turn
        QVERIFY(match(fine, other).isAccepted());
        QVERIFY(isRight(match(fine, other).solutions[0], {0.4, 0.3, 2}));
        QVERIFY2(timer.elapsed() < 60000 * slowness, saying(timer.elapsed()));
    }

    void steadyStateAllocatesNothing() {
        std::mt19937 random(11);
        const Points first = hall().scan({}, random), second = hall().scan({0.2, 0, 0.1}, random);
        const Points pillars = ScanWorld::grove().scan({}, random),
                     corridor = ScanWorld::corridor().scan({}, random);
        GlobalPairMatcher match;
        const std::size_t more = allocationsOnceGrown(4, [&] {
            match(first, second);
            match(first, pillars);
            match.covarianceOf(match(corridor, corridor).solutions.at(0));
        });
        QCOMPARE(more, std::size_t(0));
    }

    void largestOfSixteen() {
        std::mt19937 random(12);
        std::uniform_int_distribution<int> any(-32768, 32767);
        for (int i = 0; i < 1000; ++i) {
            std::array<std::int16_t, 16> numbers;
            for (std::int16_t &n : numbers)
                n = std::int16_t(any(random));
            QCOMPARE(simd::largestOfSixteen(numbers.data()),
                     *std::max_element(numbers.begin(), numbers.end()));
        }
    }
};
