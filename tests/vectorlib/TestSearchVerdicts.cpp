#include "RoomScans.h"

#include "tests/support/RandomRoom.h"
#include "vectorlib/correspondence/CorrespondenceFinder.h"

using namespace vectorlib;

/// What the search for corresponding segments says when it finds nothing, or nothing that is sure.
class TestSearchVerdicts : public QObject {
    Q_OBJECT

private Q_SLOTS:
    void boundOnCombinationsIsReported() {
        const RandomRoom made(4);
        CorrespondenceFinder find;
        find.settings.maxCombinations = 3;
        const auto &result = find(seenFrom(made.edges, made.first), seenFrom(made.edges, made.second));
        QVERIFY(result.outcome == SearchOutcome::Cut);
        QCOMPARE(result.combinations, std::uint64_t(3));
        QVERIFY(QByteArray(describe(result.outcome)).contains("bound"));
        find.settings.maxCombinations = 100000;
        QVERIFY(find(seenFrom(made.edges, made.first), seenFrom(made.edges, made.second)).outcome ==
                SearchOutcome::Complete);
    }

    void saysWhyThereIsNothing_data() {
        const Rows<int, int> row("which", "outcome");
        const char *names[] = {"nothing static",
                               "nothing dynamic",
                               "only bad segments",
                               "too far apart",
                               "one wall",
                               "corridor",
                               "other angle between the walls",
                               "NaN threshold",
                               "negative threshold",
                               "no solution wanted",
                               "infinite reach",
                               "NaN pose",
                               "too many pairs",
                               "too many near each other"};
        const SearchOutcome outcomes[] = {
            SearchOutcome::NothingFixed,    SearchOutcome::NothingMoving, SearchOutcome::NothingMoving,
            SearchOutcome::NoPotentialPair, SearchOutcome::OneDirection,  SearchOutcome::OneDirection,
            SearchOutcome::NoCombination,   SearchOutcome::BadSettings,   SearchOutcome::BadSettings,
            SearchOutcome::BadSettings,     SearchOutcome::BadSettings,   SearchOutcome::BadSettings,
            SearchOutcome::TooManyPairs,    SearchOutcome::TooManyPairs};
        for (int i = 0; i < 14; ++i)
            row(names[i], i, static_cast<int>(outcomes[i]));
    }

    void saysWhyThereIsNothing() {
        FETCH(int, which, int, outcome);
        const double nan = std::numeric_limits<double>::quiet_NaN();
        CorrespondenceFinder find;
        Segments fixed = room(), moving = room();
        Transformation2D expected;
        switch (which) {
        case 0:
            fixed.clear();
            break;
        case 1:
            moving.clear();
            break;
        case 2:
            moving = {Segment({nan, 0}, {1, 1}), Segment({1, 1}, {1, 1})};
            break;
        case 3:
            expected = Transformation2D(100, 0, 0);
            break;
        case 4:
            moving = {Segment({2, -1}, {2, 1})};
            fixed = moving;
            break;
        case 5:
            fixed = moving = {Segment({2, -1}, {2, 1}), Segment({-2, 3}, {-2, -3})};
            break;
        case 6:
            fixed = {Segment({2, -1}, {2, 1}), Segment({2, 1}, {-2, 1})};
            moving = {Segment({2, -1}, {2, 1}), Segment({1.5, 1}, {-1.5, 3})};
            break;
        case 7:
            find.settings.ambiguity = nan;
            break;
        case 8:
            find.settings.permitted.dx = -1;
            break;
        case 9:
            find.settings.maxSolutions = 0;
            break;
        case 10:
            find.settings.permitted.dy = noHit;
            break;
        case 11:
            expected = Transformation2D(nan, 0, 0);
            break;
        case 12:
            find.settings.maxPairs = 3;
            break;
        case 13:
            find.settings.maxCompared = 3;
            break;
        }
        const auto &result = find(fixed, moving, expected);
        QCOMPARE(QByteArray(describe(result.outcome)), QByteArray(describe(SearchOutcome(outcome))));
        QVERIFY(result.solutions.empty());
    }

    void viewThatSeesNothingIsNoEvidence() {
        // An outer corner fits upside down as well, from where it would be seen from behind.
        const Segments corner = {Segment({1, 1}, {1, -1}).reversed(), Segment({1, 1}, {-1, 1})};
        const Segments other = {Segment({-3, -3}, {-3, -3.8}), Segment({-3.8, -3}, {-3, -3})};
        ExpectedViewTest test;
        test.setFixed(other);
        test.setMoving(corner);
        QVERIFY(test(Transformation2D()).angle == 0);
        QVERIFY(test(Transformation2D()).discrepancy == 0);
        CorrespondenceFinder find;
        find.settings.permitted = {9, 9, 1};
        for (const Solution &s :
             find(moved({5, 5, 0}, {corner[0].reversed(), corner[1].reversed()}), corner).solutions)
            QVERIFY(!s.accepted || s.view.angle > 0);
        find.settings.sharedView = find.settings.matchedShare = 0;
        find.settings.permitted = {9, 9, 3.2};
        for (const Solution &s :
             find(moved({-1, -1, pi}, {corner[0].reversed(), corner[1].reversed()}), corner).solutions)
            QVERIFY(s.view.angle > 0 || (!s.accepted && s.score == 0));
    }

    void tellsTheFaultOfASolution() {
        Segments moving = room();
        moving[0] = Segment(moving[0].begin() + Point(0, 0.02), moving[0].end()); // as noise does
        const auto fault = [&](auto change) {
            CorrespondenceFinder find;
            change(find.settings);
            const auto &solutions = find(room(), moving).solutions;
            if (solutions.empty() || solutions[0].accepted != (solutions[0].fault == Fault::None))
                qFatal("no solution, or one that is accepted and has a fault");
            return solutions[0].fault;
        };
        QVERIFY(fault([](SearchSettings &) {}) == Fault::None);
        QVERIFY(fault([](SearchSettings &s) { s.matchedShare = 1.1; }) == Fault::MatchedShare);
        QVERIFY(fault([](SearchSettings &s) { s.sharedView = 2; }) == Fault::NoEvidence);
        QVERIFY(fault([](SearchSettings &s) { s.discrepancy = s.discrepancyShare = 0; }) ==
                Fault::Discrepancy);
    }

    void thresholdsOfZeroAcceptNothing_data() {
        QTest::addColumn<int>("which");
        for (int i = 0; i < 6; ++i)
            QTest::addRow("threshold %d", i) << i;
    }

    void thresholdsOfZeroAcceptNothing() {
        QFETCH(int, which);
        CorrespondenceFinder find;
        SearchSettings &s = find.settings;
        double *thresholds[] = {&s.permitted.dx, &s.permitted.dalpha, &s.reliability,
                                &s.ambiguity,    &s.discrepancy,      &s.stiffness.alpha};
        *thresholds[which] = 0;
        s.discrepancyShare = 0;
        Segments moving;
        std::mt19937 random(5);
        std::normal_distribution<double> noise(0, 0.02);
        for (const Segment &edge : room()) {
            const Segment there = Transformation2D(-0.3, 0.1, 0.2) * edge;
            moving.emplace_back(there.begin() + Point(noise(random), noise(random)),
                                there.end() + Point(noise(random), noise(random)));
        }
        const bool mayAccept = thresholds[which] == &s.reliability || thresholds[which] == &s.stiffness.alpha;
        for (const Solution &solution : find(room(), moving).solutions) {
            QVERIFY(mayAccept || !solution.accepted);
            QVERIFY(solution.pose.isFinite() && solution.score >= 0 && solution.score <= 1);
        }
    }
};
