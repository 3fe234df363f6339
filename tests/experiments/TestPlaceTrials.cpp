#include "vectorlib/experiments/DrawnPlaces.h"
#include "vectorlib/experiments/PlaceTrustFit.h"

#include "common/world/World.h"

using namespace hermes;
using namespace hermes::experiments;

/// What the experiments on the search of places measure, and the fit of its trust.
class TestPlaceTrials : public QObject {
    Q_OBJECT

private Q_SLOTS:
    void fitFindsTheWeights_data() { rowsOfSeeds<unsigned>(1, 3); }

    void fitFindsTheWeights() {
        QFETCH(unsigned, seed);
        vectorlib::PlaceTrust truth;
        truth.constant = -6;
        truth.score = 8;
        truth.ahead = 40;
        truth.rival = 12;
        const vectorlib::PlaceTrust found = fittedTrust(drawn(truth, seed, 20000), {});
        QVERIFY2(std::abs(found.constant - truth.constant) < 0.5, saying(found.constant));
        QVERIFY2(std::abs(found.score - truth.score) < 0.7, saying(found.score));
        QVERIFY2(std::abs(found.ahead - truth.ahead) < 5, saying(found.ahead));
        QVERIFY2(std::abs(found.rival - truth.rival) < 1.5, saying(found.rival));
    }

    void reliabilityOfTheTrueWeights() {
        const PlaceTrustQuality quality = qualityOf({}, drawn({}, 4, 20000));
        for (const CalibrationTenth &t : quality.tenths)
            if (t.solutions > 400)
                QVERIFY2(std::abs(t.told - t.right) < 0.08, saying(t.told));
        QVERIFY(quality.found > quality.trials / 10 && quality.wrong < quality.found / 20);
    }

    void judgesOnTheOtherHalf() {
        std::vector<PlaceTrial> trials = drawn({}, 5, 2000);
        for (PlaceTrial &t : trials)
            if (!t.isFirstHalf)
                t.right.reset(); // what is told of it does not change the fit
        const nlohmann::ordered_json summary = trustSummary(trials);
        QCOMPARE(summary["fitted"]["second_half"]["trials"].get<int>(), 1000);
        QVERIFY(summary["fitted"]["second_half"]["wrong"].get<int>() > 20);
        QCOMPARE(qualityOf({}, drawn({}, 5, 2000)).trials, std::size_t(2000));
        QVERIFY(summary["fitted"]["weights"]["rival"].get<double>() > 8);
    }

    void searchesDrawnPlaces() {
        auto world =
            readWorld(qEnvironmentVariable("HERMES_SOURCE").toStdString() + "/deploy/worlds/pillars.json");
        QVERIFY(world);
        world->name = "pillars";
        ExperimentOptions options;
        options.runs = 1;
        options.seed = 7;
        nlohmann::ordered_json sets = summaryBySet(drawnPlacesExperiment({*world}, options));
        for (const char *name : {"pillars", "plans", "plans, edges alone"}) {
            QVERIFY2(sets[name]["found_right"].get<double>() >= 0.9, name);
            QCOMPARE(sets[name]["found_wrong"].get<double>(), 0.0);
        }
        for (const char *name : {"2 wings alike", "4 wings alike"}) {
            QCOMPARE(sets[name]["found_right"].get<double>() + sets[name]["found_wrong"].get<double>(), 0.0);
            QVERIFY2(sets[name]["ambiguous"].get<double>() >= 0.8, name);
        }
        QVERIFY(!sets["plans, other building"].contains("first_right"));
        QCOMPARE(sets["plans, other building"]["found_wrong"].get<double>(), 0.0);
    }

    void measuresTowns() {
        ExperimentOptions options;
        options.runs = 1;
        const std::vector<PlaceTrial> towns = townsExperiment(options);
        QCOMPARE(towns.size(), std::size_t(14));
        QVERIFY(std::stoi(towns.front().set) >= 100 && std::stoi(towns.back().set) >= 100000);
        std::vector<PlaceTrial> made;
        for (const double walls : {10.0, 100.0, 1000.0}) {
            made.emplace_back();
            made.back().set = std::to_string(int(walls));
            made.back().milliseconds = 0.01 * std::pow(walls, 0.75);
        }
        QVERIFY(std::abs(slopeOf(made) - 0.75) < 1e-9);
    }

private:
    // Trials of which one place, or none, is right as often as some weights say.
    static std::vector<PlaceTrial> drawn(const vectorlib::PlaceTrust &trust, unsigned seed, int count) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> unit;
        std::vector<PlaceTrial> trials;
        for (int i = 0; i < count; ++i) {
            PlaceTrial trial;
            trial.reliability = 1;
            trial.score = unit(random);
            trial.leads.push_back(1);
            std::vector<double> odds{1};
            for (int rivals = 3; rivals > 0; --rivals) {
                trial.leads.push_back(0.15 * unit(random));
                trial.leads.front() = std::min(trial.leads.front(), trial.leads.back());
                odds.push_back(trust.oddsOfRival(trial.score, trial.leads.back()));
            }
            odds.push_back(trust.oddsOfNone(trial.score, trial.leads.front()));
            const auto which = std::size_t(std::discrete_distribution<int>(odds.begin(), odds.end())(random));
            if (which + 1 < odds.size())
                trial.right = which;
            trial.isFirstHalf = i % 2 == 0;
            trials.push_back(trial);
        }
        return trials;
    }
};
