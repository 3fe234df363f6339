#include "RoomScans.h"

#include "vectorlib/correspondence/CorrespondenceFinder.h"

using namespace vectorlib;

/// Segments of any length and direction, or of four directions as those of buildings; metres.
static Segments drawn(std::size_t count, double size, bool isBuilding, std::mt19937 &random) {
    std::uniform_real_distribution<double> at(-size, size), angle(-pi, pi), length(0.1, 4), skew(-0.02, 0.02);
    Segments segments;
    for (std::size_t i = 0; i < count; ++i) {
        const double a = isBuilding ? pi / 2 * double(random() % 4) + skew(random) : angle(random);
        const Point begin(at(random), at(random));
        segments.emplace_back(begin, begin + Point(std::cos(a), std::sin(a)) * length(random));
    }
    return segments;
}
/// The wall of a round hall of 5 m, in so many pieces.
static Segments round(std::size_t count) {
    Segments segments;
    const auto corner = [&](std::size_t i) {
        const double a = 2 * pi * double(i) / double(count);
        return Point(std::cos(a), std::sin(a)) * (5 + std::sin(3 * a));
    };
    for (std::size_t i = 0; i < count; ++i)
        segments.emplace_back(corner(i), corner(i + 1));
    return segments;
}
/// Both walls of a straight corridor, in pieces of half a metre.
static Segments corridor(std::size_t count) {
    Segments segments;
    for (std::size_t i = 0; i < count / 2; ++i) {
        const double x = 0.5 * double(i) - 0.125 * double(count);
        segments.emplace_back(Point(x, -2), Point(x + 0.5, -2));
        segments.emplace_back(Point(x + 0.5, 2), Point(x, 2));
    }
    return segments;
}
static Segments world(int kind, std::size_t count) {
    std::mt19937 random(7);
    return kind == 0   ? drawn(count, 1.5 * std::sqrt(double(count)), true, random)
           : kind == 1 ? round(count)
                       : corridor(count);
}

/// The static segments that may belong to a dynamic one: none is missed, and few others are looked at.
class TestNearLines : public QObject {
    Q_OBJECT

private Q_SLOTS:
    void noneIsMissed() {
        std::mt19937 random(newSeed());
        std::uniform_real_distribution<double> size(1, 40), shift(-3, 0.5), turn(0, pi);
        NearLines lines;
        std::size_t found = 0;
        for (int i = 0; i < 300; ++i) {
            const double metres = size(random);
            const Segments fixed = drawn(60, metres, i % 2, random),
                           moving = drawn(20, metres, i % 2, random);
            const PermittedError permitted{std::pow(10, shift(random)),
                                           i % 3 ? std::pow(10, shift(random)) : 0, turn(random)};
            lines.build(fixed, std::hypot(permitted.dx, permitted.dy));
            for (const Segment &m : moving) {
                std::vector<char> isNear(fixed.size(), 0);
                lines.query(m, [&](int f) { return isNear[std::size_t(f)] = 1; });
                for (std::size_t f = 0; f < fixed.size(); ++f)
                    if (mayCorrespond(fixed[f], m, permitted)) {
                        ++found;
                        QVERIFY2(isNear[f], saying("draw %1, segment %2", i, f));
                    }
            }
        }
        QVERIFY2(found > 100, saying(found));
    }

    void farAndHugeReachesAreNoTrouble() {
        NearLines lines;
        const Segments fixed = {Segment({1e300, 0}, {1e300, 1e299}), Segment({2, -1}, {2, 1}),
                                Segment({-1e9, 5}, {1e9, 5})};
        for (double reach : {0.0, 1.0, 1e6, 1e308, std::numeric_limits<double>::infinity()}) {
            lines.build(fixed, reach);
            bool isFound = false;
            lines.query(fixed[1], [&](int f) { return !(isFound = isFound || f == 1); });
            QVERIFY(isFound);
        }
    }

    void timeGrowsWithTheSets_data() {
        const Rows<int> row("kind");
        row("buildings", 0);
        row("round hall", 1);
        row("corridor", 2);
    }

    // Expected where few lie on each other, so that no bound ends the search: 32 times as many segments take
    // 32 times as long, and more where they no longer fit the caches, but not 1,000 times.
    void timeGrowsWithTheSets() {
        QFETCH(int, kind);
        CorrespondenceFinder find;
        find.settings.permitted = {0.005, 0.005, 0.05};
        double seconds[2] = {1e9, 1e9};
        for (int repeat = 0; repeat < 5; ++repeat)
            for (int k = 0; k < 2; ++k) {
                const Segments fixed = world(kind, k == 0 ? 1000 : 32000);
                const Segments moving = moved(Transformation2D(0.4, 0.2, 0.3).inverse(), fixed);
                const std::clock_t begin = std::clock(); // of this process: others may be busy, too
                const SearchResult &found = find(fixed, moving, {30.4, 1.2, 0.3});
                seconds[k] = std::min(seconds[k], double(std::clock() - begin) / CLOCKS_PER_SEC);
                QVERIFY(found.outcome != SearchOutcome::TooManyPairs);
            }
        qInfo("1,000 segments %.2f ms, 32,000 segments %.2f ms", 1e3 * seconds[0], 1e3 * seconds[1]);
        QVERIFY(seconds[1] < 320 * seconds[0]);
    }
};
