#include "RepeatingWorlds.h"

#include "tests/support/RandomRoom.h"
#include "vectorlib/observation/SimulatedScanner.h"
#include "vectorlib/relations/RelationMatcher.h"
#include "vectorlib/relations/RelationScores.h"
#include "vectorlib/relations/TypedSegmentExtractor.h"

using namespace vectorlib;
using TypedSegments = std::vector<TypedSegment>;

/// Matching without any pose where things repeat: no wrong place may be told as found too often, and where
/// nothing repeats the true one must be.
class TestRelationsRepeating : public QObject {
    Q_OBJECT

private Q_SLOTS:
    void signsAreLinesJumpsAndObliqueAngles() {
        const EndType angle = EndType::Angle, jump = EndType::Jump, interior = EndType::Interior;
        const TypedSegments corner{segment({3, -2}, {3, 1}, interior, angle),
                                   segment({3, 1}, {-1, 1}, angle, interior)};
        const TypedSegments jumps{segment({3, -2}, {3, 1}, jump, angle),
                                  segment({3, 1}, {-1, 1}, angle, jump)};
        const TypedSegments oblique{segment({3, -2}, {3, 1}, interior, angle),
                                    segment({3, 1}, {1, 3}, angle, interior)};
        const TypedSegments oneLine{segment({3, -2}, {3, -1}, interior, interior),
                                    segment({3, 0}, {3, 1}, interior, interior)};
        const std::vector<CorrespondencePair> both{{0, 0}, {1, 1}};
        const MatchSigns signs;
        QCOMPARE(signs(both, corner, corner, {}), 2);
        QCOMPARE(signs(both, jumps, jumps, {}), 4);
        QCOMPARE(signs(both, jumps, corner, {}), 2); // what is an edge in one scan only tells nothing
        QCOMPARE(signs(both, oblique, oblique, {}), 3);
        QCOMPARE(signs(both, oneLine, oneLine, {}), 1);
        QCOMPARE(signs({}, corner, corner, {}), 0);
    }

    void aCornerAloneIsUnspecific() {
        const TypedSegments corner{segment({3, -2}, {3, 1}, EndType::Interior, EndType::Angle),
                                   segment({3, 1}, {-1, 1}, EndType::Angle, EndType::Interior)};
        TypedSegments joined = corner;
        joined[0].joined = true;
        const RelationMatch &found = match_(joined, joined);
        QCOMPARE(describe(found.outcome), describe(RelationOutcome::Unspecific));
        QVERIFY(found.pairs.empty() && found.evidence == 0);
        RelationMatcher any;
        any.settings.leastSigns = 0;
        QCOMPARE(describe(any(joined, joined).outcome), describe(RelationOutcome::Matched));
    }

    void wrongPlacesAreRarelyFound() {
        constexpr unsigned seed = 1000;
        Count all;
        for (std::size_t kind = 0; kind < std::size(RepeatingWorlds::names); ++kind) {
            std::mt19937 random(seed);
            RepeatingWorlds worlds(random);
            Count count;
            for (int i = 0; i < 80; ++i) {
                const RepeatingWorlds::Pair pair = worlds.draw(RepeatingWorlds::Kind(kind));
                add(segmentsOf(pair.fixed, pair.scanner), segmentsOf(pair.moving, pair.scanner), pair.motion,
                    count);
            }
            qInfo("seed %u, %s: %d wrong of %d matched", seed, RepeatingWorlds::names[kind], count.wrong,
                  count.matched);
            all.matched += count.matched;
            all.wrong += count.wrong;
        }
        QVERIFY2(all.wrong <= 30, saying(all.wrong));
        QVERIFY2(all.matched >= 300, saying(all.matched));
    }

    void roomsThatDoNotRepeatAreFound_data() {
        const Rows<bool, int> row("isFullTurn", "least"); // least: of 80
        row("full turn", true, 80);
        row("half a turn, any heading", false, 40);
    }

    void roomsThatDoNotRepeatAreFound() {
        FETCH(bool, isFullTurn, int, least);
        Count count;
        for (std::uint64_t seed = 1000; seed < 1080; ++seed) {
            RandomRoom room(seed);
            room.second.theta = 0.77 * double(seed);
            add(scanned(room.edges, room.first, isFullTurn, 2 * seed),
                scanned(room.edges, room.second, isFullTurn, 2 * seed + 1),
                Transformation2D(room.first).inverse() * Transformation2D(room.second), count);
        }
        const QString found =
            QString("seeds 1000 to 1079: %1 matched, %2 wrong").arg(count.matched).arg(count.wrong);
        QVERIFY2(count.matched >= least && count.wrong <= 1, qPrintable(found));
    }

private:
    struct Count {
        int matched = 0, wrong = 0;
    };
    /// Wrong is what errs by more than 0.5 m or 10 degrees.
    void add(const TypedSegments &reference, const TypedSegments &current, const Transformation2D &motion,
             Count &count) {
        const RelationMatch &found = match_(reference, current);
        if (!found.isMatched())
            return;
        const Transformation2D error = motion.inverse() * found.pose;
        ++count.matched;
        count.wrong += error.translation().norm() > 0.5 || std::abs(error.alpha()) > 10 * pi / 180;
    }
    static TypedSegments segmentsOf(const std::vector<Vector2D<float>> &points,
                                    const ScanWorld::Scanner &scanner) {
        TypedSegmentExtractor extract;
        extract.setScanner(scanner.fieldOfView, std::size_t(scanner.rays));
        return extract(points);
    }
    static TypedSegments scanned(const std::vector<LineSegment2D<double>> &edges, const Pose2D &pose,
                                 bool isFullTurn, std::uint64_t seed) {
        SimulatedScanner<double> scanner(seed);
        scanner.fieldOfView = isFullTurn ? 2 * pi : pi;
        scanner.rays = isFullTurn ? 720 : 361;
        std::vector<Vector2D<float>> points;
        for (const Vector2D<double> &p : scanner(edges, pose))
            points.emplace_back(p);
        return segmentsOf(points, {scanner.rays, scanner.fieldOfView});
    }
    static TypedSegment segment(Vector2D<double> begin, Vector2D<double> end, EndType beginType,
                                EndType endType) {
        TypedSegment s{LineSegment2D<double>(begin, end), {}, {}, false, {}};
        s.begin.type = beginType;
        s.end.type = endType;
        return s;
    }
    RelationMatcher match_;
};
