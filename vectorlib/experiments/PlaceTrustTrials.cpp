#include "vectorlib/experiments/PlaceTrustTrials.h"

#include "vectorlib/experiments/PairsExperiment.h"
#include "vectorlib/mapping/MapBuilder.h"

namespace hermes::experiments {

using vectorlib::CarmenLog;
using vectorlib::FloorPlan;
using vectorlib::Pose2D;
using vectorlib::Transformation2D;

namespace {

constexpr int fewPlaces = 20, placesOfWorld = 200;
constexpr std::size_t timeOfLogTrial = 6, timeOfPlanTrial = 7,
                      timeOfWorldTrial = 1; // of a search, beside each other, about

// A scan of a log in the map that is set.
void search(PlaceTrials &trials, const std::string &set, const CarmenLog &log, std::size_t i,
            const std::optional<Pose2D> &truth) {
    trials.extract.segment.settings = scannerOf(log.scans[i]);
    PlaceTrial &trial = trials.add(pointsOf(log.scans[i]), truth);
    trial.scan = i;
    trial.set = set;
    trial.isFirstHalf = i / 50 % 2 == 0;
}

// By odometry and matching alone: places are those beside the scan before, wherever the map took it.
void searchDriftedMap(PlaceTrials &trials, const CarmenLog &log) {
    vectorlib::MapBuilder build;
    std::vector<Pose2D> poses;
    for (std::size_t i = 0; i < log.scans.size(); i += 2) {
        Transformation2D expected;
        if (i > 0)
            expected = Transformation2D(poses.back()) *
                       log.odometryMotion(i - 2, i, vectorlib::CarmenOdometryKind::Corrected)
                           .value_or(Transformation2D());
        build.extract.segment.settings = scannerOf(log.scans[i]);
        poses.push_back(build.process(pointsOf(log.scans[i]), expected.pose()).pose);
    }
    trials.setMap(build.map.slots());
    for (std::size_t i = 1; i < log.scans.size(); i += 2)
        search(trials, "logs, map with drift", log, i,
               (Transformation2D(poses[i / 2]) * log.referenceMotion(i - 1, i)).pose());
}

void searchLogs(PlaceTrials &trials, const std::vector<CarmenLog> &logs, const CarmenLog *other) {
    for (const CarmenLog &log : logs) {
        const std::vector<vectorlib::MapEdge> map = mapOfHalf(log);
        trials.setMap(map);
        for (std::size_t i = 1; i < log.scans.size(); i += 2)
            search(trials, "logs", log, i, log.scans[i].laserPose);
        for (const CarmenLog &strange : logs)
            for (std::size_t i = 0; i < strange.scans.size() && &strange != &log; i += 3)
                search(trials, "logs, other building", strange, i, std::nullopt);
        for (std::size_t i = 0; other && i < other->scans.size(); i += 3)
            search(trials, "logs, other building", *other, i, std::nullopt);
        searchDriftedMap(trials, log);
    }
}

void searchPlans(DrawnPlaces &drawn, const ExperimentOptions &options) {
    for (int i = 0; i < 2 * options.runs; ++i) {
        const auto seed = unsigned(options.seed * 1000 + 500 + std::uint64_t(i));
        const bool isFirstHalf = i % 2 == 0;
        const FloorPlan plan(seed, DrawnPlaces::rooms), other(seed + 500000, DrawnPlaces::rooms);
        drawn.setMap(plan.walls());
        for (const int percent : {0, 10, 30, 60}) {
            drawn.begin("plans, " + std::to_string(percent) + " % refurnished", isFirstHalf);
            drawn.search(plan.refurnished(seed, percent / 100.0).walls(), fewPlaces);
        }
        drawn.begin("plans, other building", isFirstHalf);
        drawn.search(other.walls(), fewPlaces, false);
    }
}

void searchWorlds(DrawnPlaces &drawn, const std::vector<World> &worlds) {
    drawn.isOpen = true;
    for (const World &world : worlds) {
        drawn.setMap(wallsIn(world));
        for (const bool isFirstHalf : {true, false}) {
            drawn.begin("worlds", isFirstHalf);
            drawn.search(wallsIn(world), placesOfWorld);
            for (const World &other : worlds)
                if (&other != &world) {
                    drawn.begin("worlds, other world", isFirstHalf);
                    drawn.search(wallsIn(other), placesOfWorld / 10, false);
                }
        }
    }
}

// How many scans are searched.
std::size_t countOfLogs(const std::vector<CarmenLog> &logs, const CarmenLog *other) {
    const auto inOther = [](const CarmenLog &log) { return (log.scans.size() + 2) / 3; };
    std::size_t count = 0;
    for (const CarmenLog &log : logs) {
        count += log.scans.size() / 2 * 2; // in its own map and in the one with drift
        for (const CarmenLog &strange : logs)
            count += &strange == &log ? 0 : inOther(strange);
        count += other ? inOther(*other) : 0;
    }
    return count;
}

std::size_t countOfPlans(int runs) {
    return std::size_t(2 * runs) * 5 * fewPlaces;
}

std::size_t countOfWorlds(std::size_t worlds) {
    return 2 * worlds * (placesOfWorld + (worlds - 1) * (placesOfWorld / 10));
}

} // namespace

std::vector<PlaceTrial> placeTrustTrials(const std::vector<CarmenLog> &logs, const CarmenLog *other,
                                         const std::vector<World> &worlds, const ExperimentOptions &options) {
    const std::size_t searchesInLogs = countOfLogs(logs, other), searchesInPlans = countOfPlans(options.runs),
                      searchesInWorlds = countOfWorlds(worlds.size());
    ProgressParts parts(options.progress, {timeOfLogTrial * searchesInLogs, timeOfPlanTrial * searchesInPlans,
                                           timeOfWorldTrial * searchesInWorlds});
    PlaceTrials ofLogs;
    ofLogs.expect(searchesInLogs, parts.next());
    searchLogs(ofLogs, logs, other);
    DrawnPlaces drawn(options.seed);
    drawn.expect(searchesInPlans, parts.next());
    searchPlans(drawn, options);
    drawn.expect(searchesInWorlds, parts.next());
    searchWorlds(drawn, worlds);
    std::vector<PlaceTrial> all = std::move(ofLogs.all);
    all.insert(all.end(), drawn.trials().begin(), drawn.trials().end());
    return all;
}

} // namespace hermes::experiments
