#pragma once

#include "common/world/World.h"
#include "vectorlib/experiments/PlaceTrial.h"
#include "vectorlib/experiments/VectorizationExperiment.h"
#include "vectorlib/observation/FloorPlan.h"
#include "vectorlib/observation/SimulatedScanner.h"

#include <ostream>

namespace hermes::experiments {

using Walls = std::vector<vectorlib::LineSegment2D<double>>;

Walls wallsIn(const World &world);
/// The same walls elsewhere, after those that are there.
void append(Walls &walls, const Walls &others, vectorlib::Vector2D<double> shift);
/// A map that knows walls exactly.
std::vector<vectorlib::MapEdge> mapOf(const Walls &walls);

/// Scans of simulated buildings, each at a place of its own, searched in maps: 1 cm of noise.
class DrawnPlaces {
public:
    enum class Scan {
        FullTurn,  ///< 720 rays
        HalfTurn,  ///< 361 rays over 180 degrees
        EdgesAlone ///< of a full turn, without its points
    };

    static constexpr int rooms = 20; ///< of a floor plan

    bool isOpen = false; ///< there may be no wall in some directions: as FloorPlan::placeAmong

    explicit DrawnPlaces(std::uint64_t seed);

    /// What comes is called so, and belongs to this half.
    void begin(const std::string &set, bool isFirstHalf = true);
    /// The map of the scans to come, as it is known.
    void setMap(const Walls &walls);
    /// Scans at so many places among walls, seen as they stand there now; they have their place in the map,
    /// or are of another building.
    void search(const Walls &walls, int places, bool hasPlace = true, Scan scan = Scan::FullTurn);
    const std::vector<PlaceTrial> &trials() const { return trials_.all; }
    /// Scans at so many places follow, whose progress is told.
    void expect(std::size_t places, ProgressSink progress) { trials_.expect(places, std::move(progress)); }

private:
    std::mt19937 random_;
    vectorlib::SimulatedScanner<float> scanner_;
    std::vector<vectorlib::MapEdge> map_;
    PlaceTrials trials_;
    std::string set_;
    bool isFirstHalf_ = true;
};

/// Steps that the progress of both experiments has.
std::size_t stepsOfDrawnPlaces(std::size_t worlds, int runs);
std::size_t stepsOfTowns(int runs);

/// The search in worlds, and in floor plans of 20 rooms, `runs` of them: 50 places each, 50 runs in a world.
std::vector<PlaceTrial> drawnPlacesExperiment(const std::vector<World> &worlds,
                                              const ExperimentOptions &options);
/// In towns of floor plans with 100 to 100,000 walls, whose number is the set; two places a run.
std::vector<PlaceTrial> townsExperiment(const ExperimentOptions &options);

/// A summary for each set.
nlohmann::ordered_json summaryBySet(const std::vector<PlaceTrial> &trials);
/// The slope of the median times over the walls of townsExperiment; least squares in logarithms.
double slopeOf(const std::vector<PlaceTrial> &towns);
/// A row a scan.
void writeCsv(std::ostream &out, const std::vector<PlaceTrial> &trials);

} // namespace hermes::experiments
