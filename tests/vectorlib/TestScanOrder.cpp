#include "tests/support/AllocationCounter.h"
#include "tests/support/RandomRoom.h"
#include "vectorlib/mapping/MapBuilder.h"
#include "vectorlib/observation/SimulatedScanner.h"
#include "vectorlib/places/PlaceSearch.h"
#include "vectorlib/relations/RelationMatcher.h"
#include "vectorlib/relations/TypedSegmentExtractor.h"

using namespace vectorlib;
using Points = std::vector<Vector2D<float>>;

/// What a caller may do to the points of a scan.
enum Order { AsSeen, Clockwise, Shuffled, HalfReversed, StartedAnywhere, OverOneTurn, Doubled, WithNaN, All };

static Points inOrder(Points points, int order, std::mt19937 &random) {
    const std::size_t n = points.size();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    Points result;
    switch (order) {
    case Clockwise:
        std::reverse(points.begin(), points.end());
        break;
    case Shuffled:
        std::shuffle(points.begin(), points.end(), random);
        break;
    case HalfReversed:
        std::reverse(points.begin() + std::ptrdiff_t(n / 2), points.end());
        break;
    case StartedAnywhere:
        std::rotate(points.begin(), points.begin() + std::ptrdiff_t(random() % n), points.end());
        break;
    case OverOneTurn:
        for (std::size_t i = 0, more = random() % n; i < more; ++i)
            points.push_back(points[i]);
        break;
    case Doubled:
    case WithNaN:
        for (const Vector2D<float> &p : points)
            result.insert(result.end(), {p, order == Doubled ? p : Vector2D<float>(nan, nan)});
        return result;
    }
    return points;
}

/// What a matcher tells: a motion, where it takes it for the right one.
using Told = std::optional<Transformation2D>;

static bool isNear(const Transformation2D &a, const Transformation2D &b, double metres, double radians) {
    const Transformation2D off = a.inverse() * b;
    return off.translation().norm() < metres && std::abs(off.alpha()) < radians;
}

/// All that matches scans, with two scans of a room.
struct Matchers {
    double fieldOfView;
    int rays;

    Told globally(PointSpan<float> fixed, PointSpan<float> moving) const {
        GlobalPairMatcher match;
        const GlobalPairMatch &found = match(fixed, moving);
        return found.isAccepted() ? Told(found.solutions[0].pose) : Told();
    }
    Told near(PointSpan<float> fixed, PointSpan<float> moving, const Transformation2D &expected) const {
        ScanPairMatcher match;
        match.extract.segment.settings = EarSettings::forScanner(fieldOfView, std::size_t(rays));
        const ScanPairMatch &found = match(fixed, moving, expected);
        return found.accepted ? Told(found.pose) : Told();
    }
    Told byMap(PointSpan<float> fixed, PointSpan<float> moving, const Transformation2D &expected) const {
        MapBuilder build;
        build.track.settings = TrackingSettings::forPoorExpectation();
        build.extract.segment.settings = EarSettings::forScanner(fieldOfView, std::size_t(rays));
        build.process(fixed, {});
        build.process(moving, expected.pose());
        return build.match().accepted ? Told(build.match().pose) : Told();
    }
    Told byRelations(PointSpan<float> fixed, PointSpan<float> moving) const {
        TypedSegmentExtractor extract;
        extract.setScanner(fieldOfView, std::size_t(rays));
        const std::vector<TypedSegment> reference = extract(fixed);
        RelationMatcher match;
        const RelationMatch &found = match(reference, extract(moving));
        return found.isMatched() ? Told(found.pose) : Told();
    }
    Told place(const std::vector<RandomRoom::Segment> &walls, PointSpan<float> scan) const {
        std::vector<MapEdge> edges;
        for (const RandomRoom::Segment &wall : walls)
            edges.emplace_back(std::int64_t(edges.size()), EdgeRaw2D(TlsSums(), wall, 0.01), 1);
        EdgeExtractor extract;
        extract.segment.settings = EarSettings::forScanner(fieldOfView, std::size_t(rays));
        PlaceSearch search;
        const Relocalized &found = search(edges, extract(scan), scan);
        return found.outcome == Relocalized::Outcome::Found ? Told(Transformation2D(found.places[0].pose))
                                                            : Told();
    }
};

/// Scans whose points do not come counter-clockwise, each once: the order itself, and what the matchers make
/// of such scans.
class TestScanOrder : public QObject {
    Q_OBJECT

    /// A full turn of 360 points about a room.
    static Points turn() {
        Points points;
        for (int i = 0; i < 360; ++i) {
            const double angle = -pi + 2 * pi * i / 360, range = 4 + std::sin(5 * angle);
            points.emplace_back(Vector2D<double>(std::cos(angle), std::sin(angle)) * range);
        }
        return points;
    }
    static Points points(PointSpan<float> span) { return {span.begin(), span.end()}; }

private Q_SLOTS:
    void anOrderedScanStaysAsItIs_data() {
        const Rows<int> row("order");
        row("as seen", int(AsSeen));
        row("started anywhere", int(StartedAnywhere));
        row("over one turn", int(OverOneTurn));
        row("every point twice", int(Doubled));
        row("every other point is none", int(WithNaN));
    }

    void anOrderedScanStaysAsItIs() {
        QFETCH(int, order);
        std::mt19937 random(1);
        const Points scan = inOrder(turn(), order, random);
        ScanOrder ordered;
        QCOMPARE(ordered(scan).begin(), PointSpan<float>(scan).begin());
        QCOMPARE(ordered(scan).size(), scan.size());
        for (std::size_t n = 0; n < 3; ++n)
            QCOMPARE(ordered({scan.data(), n}).begin(), scan.data());
    }

    void aClockwiseScanIsReversed() {
        std::mt19937 random(2);
        ScanOrder ordered;
        for (int order : {AsSeen, StartedAnywhere, OverOneTurn, Doubled}) {
            const Points scan = inOrder(turn(), order, random);
            QVERIFY(points(ordered(inOrder(scan, Clockwise, random))) == scan);
        }
        const Points gaps = inOrder(inOrder(turn(), WithNaN, random), Clockwise, random);
        QCOMPARE(points(ordered(gaps)).size(), gaps.size());
        QVERIFY(points(ordered(gaps))[0] == turn()[0]);
    }

    void aScanWithoutOrderIsSorted() {
        std::mt19937 random(newSeed());
        ScanOrder ordered;
        for (std::size_t n : {3, 10, 100, 300}) { // of a turn of 360: the widest gap is behind the last
            Points scan = turn();
            scan.resize(n);
            for (int i = 0; i < 20; ++i) {
                const Points shuffled = inOrder(scan, Shuffled, random);
                if (ordered(shuffled).begin() != shuffled.data())
                    QVERIFY(points(ordered(shuffled)) == scan);
                else
                    QVERIFY2(n < 10, saying(n)); // three points are in order or clockwise
            }
            Points spoilt = inOrder(scan, WithNaN, random);
            if (n >= 100)
                QVERIFY(points(ordered(inOrder(spoilt, Shuffled, random))) == scan);
        }
    }

    void matchersTellTheSame_data() {
        Rows<int, double>("order", "turn");
        const char *names[] = {"as seen",          "clockwise",     "shuffled", "half reversed",
                               "started anywhere", "over one turn", "doubled",  "NaN in between"};
        for (int order = AsSeen; order < All; ++order)
            for (double turn : {1.0, 0.5})
                if (turn == 1 ||
                    (order != StartedAnywhere && order != OverOneTurn)) // which only full turns do
                    QTest::addRow("%s, %g turns", names[order], turn) << order << turn;
    }

    void matchersTellTheSame() {
        FETCH(int, order, double, turn);
        std::mt19937 random(newSeed());
        const Matchers match{2 * pi * turn, int(720 * turn) + (turn < 1)};
        int told = 0, same = 0;
        for (int i = 0; i < 25; ++i) {
            const RandomRoom room(random());
            SimulatedScanner<double> scanner(random());
            scanner.rays = match.rays;
            scanner.fieldOfView = match.fieldOfView;
            const auto scan = [&](const Pose2D &pose) {
                Points result;
                for (const Vector2D<double> &p : scanner(room.edges, pose))
                    result.emplace_back(p);
                return result;
            };
            const Points first = scan(room.first), second = scan(room.second);
            const Points moving = inOrder(second, order, random);
            const Points fixed = random() % 2 ? first : inOrder(first, order, random);
            const Transformation2D motion =
                Transformation2D(room.first).inverse() * Transformation2D(room.second);
            const Transformation2D expected = motion * Transformation2D(0.08, -0.05, 0.04);
            const std::pair<Told, Told> results[] = {
                {match.globally(first, second), match.globally(fixed, moving)},
                {match.near(first, second, expected), match.near(fixed, moving, expected)},
                {match.byMap(first, second, expected), match.byMap(fixed, moving, expected)},
                {match.byRelations(first, second), match.byRelations(fixed, moving)},
                {match.place(room.edges, second), match.place(room.edges, moving)}};
            int number = 0;
            for (const auto &[ofOrdered, ofGiven] : results) {
                const QByteArray where = QByteArray::number(i) + ", matcher " + QByteArray::number(number++);
                told += bool(ofOrdered);
                same += ofOrdered && ofGiven && isNear(*ofOrdered, *ofGiven, 0.02, 0.005);
                if (ofGiven && !(ofOrdered && isNear(*ofOrdered, *ofGiven, 0.02, 0.005))) {
                    const Transformation2D truth = number == 5 ? Transformation2D(room.second) : motion;
                    QVERIFY2(isNear(*ofGiven, truth, 0.1, 0.035), where.constData());
                }
            }
        }
        qInfo("%d told of the ordered scan, the same of the given one %d", told, same);
        QVERIFY(told >= 100 && same >= told - 3);
    }

    void nothingIsFoundInNothing_data() {
        const Rows<int, int> row("count", "places");
        for (int count : {0, 1, 2, 720})
            QTest::addRow("%d points", count) << count << 1;
        row("720 points in two places", 720, 2);
        row("720 points that are none", 720, 0);
    }

    void nothingIsFoundInNothing() {
        FETCH(int, count, int, places);
        const RandomRoom room(3);
        SimulatedScanner<double> scanner(4);
        Points whole, few;
        for (const Vector2D<double> &p : scanner(room.edges, room.first))
            whole.emplace_back(p);
        const float nan = std::numeric_limits<float>::quiet_NaN();
        for (int i = 0; i < count; ++i)
            few.push_back(places > 0 ? whole[std::size_t(i % places * 200)] : Vector2D<float>(nan, nan));
        const Matchers match{2 * pi, 720};
        for (const auto &[fixed, moving] :
             {std::pair(whole, few), std::pair(few, whole), std::pair(few, few)}) {
            QVERIFY(!match.globally(fixed, moving));
            QVERIFY(!match.near(fixed, moving, {0.1, 0, 0.1}));
            QVERIFY(!match.byMap(fixed, moving, {0.1, 0, 0.1}));
            QVERIFY(!match.byRelations(fixed, moving));
        }
        QVERIFY(!match.place(room.edges, few));
    }

    void manyPointsTellTheSame() {
        std::mt19937 random(5);
        const RandomRoom room(6);
        const Matchers match{2 * pi, 100000};
        SimulatedScanner<double> scanner(7);
        scanner.rays = match.rays;
        Points scans[2];
        for (int i = 0; i < 2; ++i)
            for (const Vector2D<double> &p : scanner(room.edges, i == 0 ? room.first : room.second))
                scans[i].emplace_back(p);
        QVERIFY(scans[0].size() > 99000);
        const Transformation2D motion =
            Transformation2D(room.first).inverse() * Transformation2D(room.second);
        for (int order : {AsSeen, Clockwise, Shuffled}) {
            const Points moving = inOrder(scans[1], order, random);
            for (const Told &told :
                 {match.globally(scans[0], moving), match.near(scans[0], moving, motion),
                  match.byMap(scans[0], moving, motion), match.byRelations(scans[0], moving)})
                QVERIFY2(told && isNear(*told, motion, 0.02, 0.005), saying(order));
        }
    }

    // Two walls that meet in a corner, and a third one elsewhere that comes between them in the list.
    void segmentsOutOfOrderAreNotJoined() {
        std::vector<TypedSegment> segments(3);
        segments[0].segment = {{2, -1}, {2, 1}};
        segments[1].segment = {{2, 1}, {-1, 1}};
        segments[2].segment = {{-3, 1}, {-3, -2}};
        segments[0].joined = true;
        segments[0].end.type = segments[1].begin.type = EndType::Angle;
        RelationScan scan;
        scan.build(segments, RelationSettings());
        QVERIFY(scan.segments()[0].joined);
        std::swap(segments[1], segments[2]);
        scan.build(segments, RelationSettings());
        QVERIFY(!scan.segments()[0].joined);
    }

    void orderingAllocatesNothing() {
        std::mt19937 random(8);
        const Points clockwise = inOrder(turn(), Clockwise, random), none = inOrder(turn(), Shuffled, random);
        ScanOrder ordered;
        const std::size_t more = allocationsOnceGrown(2, [&] {
            ordered(clockwise);
            ordered(none);
        });
        QCOMPARE(more, std::size_t(0));
    }
};
