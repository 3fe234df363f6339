#pragma once

#include "tests/bench/PairRows.h"
#include "tests/vectorlib/PlaceCase.h"
#include <vectorlib/observation/FloorPlan.h>

#include <vectorlib/edges/EdgeExtractor.h>
#include <vectorlib/observation/SimulatedScanner.h>
#include <vectorlib/places/PlaceSearch.h>

namespace bench {

/// Floor plans at random side by side, as many as it takes for so many walls, and scans of a full turn with
/// 720 rays and 1 cm of noise from places in some of them. The same size gives the same town.
class Town {
public:
    struct Scan {
        Points points;
        vectorlib::Pose2D pose;
    };

    Town(std::size_t walls, std::size_t scans) {
        const int rooms = int(std::clamp<std::size_t>(walls / 25, 4, 20));
        const auto side = unsigned(std::ceil(std::sqrt(double(walls) / (25 * rooms))));
        std::vector<vectorlib::FloorPlan> plans;
        for (unsigned seed = 1; walls_.size() < walls; ++seed) {
            plans.emplace_back(seed, rooms);
            corners_.emplace_back(80.0 * (seed % side), 20.0 * (seed / side));
            for (const auto &wall : plans.back().walls())
                walls_.emplace_back(wall.begin() + corners_.back(), wall.end() + corners_.back());
        }
        for (std::size_t i = 0; i < scans; ++i) {
            const std::size_t k = i * plans.size() / scans;
            add(plans[k], corners_[k]);
        }
    }
    const Walls &walls() const { return walls_; }
    const std::vector<Scan> &scans() const { return scans_; }

private:
    void add(vectorlib::FloorPlan &plan, vectorlib::Vector2D<double> corner) {
        std::vector<vectorlib::LineSegment2D<float>> world;
        for (const auto &wall : plan.walls())
            world.emplace_back(wall);
        const vectorlib::Pose2D pose = plan.place();
        scans_.push_back({scan_(world, pose), {pose.x + corner.x, pose.y + corner.y, pose.theta}});
    }

    vectorlib::SimulatedScanner<float> scan_{7};
    Walls walls_;
    std::vector<vectorlib::Vector2D<double>> corners_; // of the floor plans
    std::vector<Scan> scans_;
};

/// One iteration searches the places of all scans, from the points; the index is there. Counters as those of
/// the pairs.
inline void searchPlaces(benchmark::State &state) {
    const Town town(std::size_t(state.range(0)), casesOf(24));
    const std::vector<vectorlib::MapEdge> map = mapOf(town.walls());
    vectorlib::EdgeExtractor extract;
    vectorlib::PlaceSearch search;
    search.maxSeconds = 60;
    search.index().follow(map);
    std::vector<double> times;
    double found = 0, wrong = 0;
    for (auto _ : state)
        for (const Town::Scan &scan : town.scans()) {
            const double begin = processorMicroseconds();
            const vectorlib::Relocalized &result = search(map, extract(scan.points), scan.points);
            times.push_back(processorMicroseconds() - begin);
            const bool isRight =
                !result.places.empty() && isNear(result.places[0].pose, scan.pose, 0.1, 0.035);
            found += result.isFound() && isRight;
            wrong += result.isFound() && !isRight;
        }
    std::sort(times.begin(), times.end());
    state.counters["walls"] = double(map.size());
    state.counters["median_us"] = times[times.size() / 2];
    state.counters["slowest_us"] = times.back();
    state.counters["found"] = found / double(times.size());
    state.counters["wrong"] = wrong / double(times.size());
}

inline void makeIndex(benchmark::State &state) {
    const Town town(std::size_t(state.range(0)), 0);
    const std::vector<vectorlib::MapEdge> map = mapOf(town.walls());
    vectorlib::PlaceIndex index;
    for (auto _ : state) {
        index.clear();
        index.follow(map);
        benchmark::DoNotOptimize(index.size());
    }
    state.counters["walls"] = double(map.size());
}

/// Rows "place of a scan" and "index of a map" of maps of growing size.
inline void addPlaceRows() {
    for (const std::int64_t walls : {100, 1000, 10000, 100000}) {
        benchmark::RegisterBenchmark("place of a scan", searchPlaces)->Arg(walls)->Iterations(1);
        benchmark::RegisterBenchmark("index of a map", makeIndex)->Arg(walls);
    }
}

} // namespace bench
