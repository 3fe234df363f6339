#include "tests/experiments/ExperimentFiles.h"
#include "vectorlib/experiments/CriterionExperiment.h"

using namespace hermes::experiments;

// hermes-vector experiment criterion, criterion-time and hausdorff-criteria.
class TestCriteria : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void criterionLooksAsInItsFigures() {
        QTemporaryDir folder;
        QCOMPARE(runExperiment({"criterion", "--out", folder.path()}), 0);
        QVERIFY(lines(folder.filePath("criterion.tex")).last() == "\\end{document}");
        QMap<QByteArray, int> rows;
        QMap<double, double> byTurn, byLength; // the criterion where nothing is shifted
        for (const auto &row : table(folder.filePath("criterion.csv"))) {
            const double x = row["x"].toDouble(), y = row["y"].toDouble(),
                         value = row["criterion_m4"].toDouble();
            ++rows[row["figure"]];
            if (row["figure"] == "shift-turn" && (y == 0 || std::abs(y - M_PI) < 1e-9))
                QVERIFY(value < 1e-12); // on the line, however far
            if (row["figure"] == "shift-turn" && std::abs(y - M_PI / 2) < 1e-9)
                QVERIFY(std::abs(value - (1 + (1 + 2 * x) * (1 + 2 * x))) < 1e-9);
            if (row["figure"] == "turn-shift") // a shift along the line changes nothing
                QVERIFY(std::abs(value - (x == 0 ? byTurn[y] = value : byTurn[y])) < 1e-12);
            if (row["figure"] == "scale-shift") { // nor here; by the square of the length
                QVERIFY(std::abs(value - (x == 0 ? byLength[y] = value : byLength[y])) < 1e-12);
                QVERIFY(std::abs(value - y * y) < 1e-12);
            }
        }
        QCOMPARE(rows.keys(), QList<QByteArray>({"scale-shift", "scale-turn", "scale-turn-small",
                                                 "shift-turn", "turn-shift"}));
        QCOMPARE(rows["shift-turn"], 21 * 37);
    }

    void otherCriteriaLackWhatTheAreaHolds_data() { // thesis 7.1.4
        const Rows<QByteArray> row("holders");      // a sign for each of segmentCriteria(): + always, - not
        row("zero for any two segments on one line", "++-++");
        row("above zero for all others", "+++-+");
        row("sliding along the static line changes nothing", "+--+-");
        row("moving both segments changes nothing", "+++++");
        row("a shift aside, a turn and a length change it", "+----");
        row("grows with the angle", "+++++");
        row("grows with the length", "+----");
        row("keeps its shape at small lengths", "+--++");
        row("smooth, without conditions", "+----");
        row("a set of pairs takes constant time, by sums", "+--+-");
        row("the same when the two are exchanged", "-++++");
    }

    void otherCriteriaLackWhatTheAreaHolds() {
        QFETCH(QByteArray, holders);
        for (const CriterionProperty &property : properties_)
            if (property.what == QTest::currentDataTag())
                for (int i = 0; i < holders.size(); ++i)
                    QVERIFY2((property.shares[std::size_t(i)] == 1) == (holders[i] == '+'),
                             saying("%1: %2, seed %3", segmentCriteria()[std::size_t(i)].name,
                                    property.shares[std::size_t(i)], seed_));
    }

    void hausdorffCriteriaAreDrawnAlike() {
        QCOMPARE(properties_.size(), std::size_t(11));
        QTemporaryDir folder;
        QCOMPARE(runExperiment({"hausdorff-criteria", "--out", folder.path()}), 0);
        QMap<QByteArray, int> rows;
        for (const auto &row : table(folder.filePath("hausdorff-criteria.csv"))) {
            ++rows[row["figure"]];
            const double y = row["y"].toDouble(), value = row["criterion"].toDouble();
            if (row["figure"] == "modified-shift-turn") // (7.3) knows the angle alone
                QVERIFY(std::abs(value - std::abs(std::sin(y))) < 1e-9);
        }
        QCOMPARE(rows.size(), 5 * 5);
        QVERIFY(lines(folder.filePath("hausdorff-criteria.tex")).last() == "\\end{document}");
    }

    void sumsArePaidBackByManyTransformations() {
        QTemporaryDir folder;
        QCOMPARE(runExperiment({"criterion-time", "--out", folder.path()}), 0);
        const auto rows = table(folder.filePath("criterion-time.csv"));
        QCOMPARE(rows.size(), 7 * 11);
        for (const auto &row : rows) {
            const double speedUp = row["speed_up"].toDouble();
            QVERIFY(speedUp > 0);
            if (row["pairs"] == "100" && row["transformations"] == "1000")
                QVERIFY2(speedUp > 10, row["speed_up"].constData());
        }
    }

    void breakEvenLiesBetweenTheMeasured() {
        // pairs, transformations, times pair by pair and from sums
        const auto found = breakEvens({{1, 1, 1, 4}, {1, 4, 4, 1}, {2, 1, 3, 1}, {3, 1, 1, 2}, {3, 9, 1, 2}});
        QCOMPARE(found.size(), std::size_t(3));
        QVERIFY(std::abs(found[0].transformations - 2) < 1e-9); // as far below 1 as above
        QCOMPARE(found[1].transformations, 1.0);
        QCOMPARE(found[2].transformations, 0.0); // never
    }

private:
    const std::uint64_t seed_ = std::random_device()();
    const std::vector<CriterionProperty> properties_ = criterionProperties(seed_, 200);
};
