#include "vectorlib/experiments/DrawnPlaces.h"

#include "vectorlib/io/Number.h"

#include <algorithm>
#include <numeric>

namespace hermes::experiments {

using vectorlib::FloorPlan;
using Point = vectorlib::Vector2D<double>;

namespace {

constexpr int rooms = DrawnPlaces::rooms, placesOfPlan = 50;
constexpr std::size_t setsOfWorld = 2, setsOfPlan = 16;                              // see below
constexpr std::size_t wallsOfTowns[] = {100, 300, 1000, 3000, 10000, 30000, 100000}; // walls, at least
// Time of a search, as measured: tenths of a millisecond; in a town it grows with the walls.
constexpr std::size_t timeInWorld = 4, timeInPlan = 30, wallsOfTime = 20;
constexpr std::size_t searchesOfTown = 2; // that take as long as to make a town and its index

std::size_t inWorlds(std::size_t worlds, int runs) {
    return setsOfWorld * worlds * std::size_t(placesOfPlan * runs);
}

std::size_t inPlans(int runs) {
    return setsOfPlan * std::size_t(placesOfPlan * runs);
}

std::vector<std::string> namesOf(const std::vector<PlaceTrial> &trials) {
    std::vector<std::string> names;
    for (const PlaceTrial &t : trials)
        if (std::find(names.begin(), names.end(), t.set) == names.end())
            names.push_back(t.set);
    return names;
}

std::vector<PlaceTrial> setOf(const std::vector<PlaceTrial> &trials, const std::string &name) {
    std::vector<PlaceTrial> some;
    std::copy_if(trials.begin(), trials.end(), std::back_inserter(some),
                 [&name](const PlaceTrial &t) { return t.set == name; });
    return some;
}

void searchWorlds(DrawnPlaces &drawn, const std::vector<World> &worlds, int runs) {
    drawn.isOpen = true;
    for (const World &world : worlds) {
        const Walls walls = wallsIn(world);
        drawn.setMap(walls);
        drawn.begin(world.name);
        drawn.search(walls, placesOfPlan * runs);
        drawn.begin(world.name + ", half turns");
        drawn.search(walls, placesOfPlan * runs, true, DrawnPlaces::Scan::HalfTurn);
    }
    drawn.isOpen = false;
}

void searchPlan(DrawnPlaces &drawn, unsigned seed) {
    const FloorPlan plan(seed, rooms);
    drawn.setMap(plan.walls());
    drawn.begin("plans");
    drawn.search(plan.walls(), placesOfPlan);
    drawn.begin("plans, half turns");
    drawn.search(plan.walls(), placesOfPlan, true, DrawnPlaces::Scan::HalfTurn);
    drawn.begin("plans, edges alone");
    drawn.search(plan.walls(), placesOfPlan, true, DrawnPlaces::Scan::EdgesAlone);
    drawn.begin("plans, other building");
    drawn.search(FloorPlan(seed + 500000, rooms).walls(), placesOfPlan, false);
}

void searchRefurnished(DrawnPlaces &drawn, unsigned seed) {
    for (const auto &[kind, name] : {std::pair(FloorPlan::Rooms::Different, std::string("plans")),
                                     std::pair(FloorPlan::Rooms::Alike, std::string("rooms alike"))}) {
        const FloorPlan plan(seed, rooms, kind);
        drawn.setMap(plan.walls());
        for (const int percent : {0, 10, 30, 60}) {
            if (percent == 0 && kind == FloorPlan::Rooms::Different)
                continue; // searchPlan
            drawn.begin(name + (percent == 0 ? "" : ", " + std::to_string(percent) + " % refurnished"));
            drawn.search(plan.refurnished(seed, percent / 100.0).walls(), placesOfPlan);
        }
        if (kind == FloorPlan::Rooms::Alike) {
            drawn.begin(name + ", other building");
            drawn.search(FloorPlan(seed + 500000, rooms, kind).walls(), placesOfPlan, false);
        }
    }
}

// Wings of two rooms that are the same; later ones have some of the furniture elsewhere.
void searchCopies(DrawnPlaces &drawn, unsigned seed) {
    for (const int copies : {2, 4})
        for (const int percent : {0, 60}) {
            const FloorPlan wing(seed, 2);
            Walls walls;
            for (int i = 0; i < copies; ++i)
                append(walls, wing.walls(), {30.0 * i, 0});
            drawn.setMap(walls);
            drawn.begin(std::to_string(copies) + " wings alike" +
                        (percent == 0 ? "" : ", " + std::to_string(percent) + " % refurnished"));
            drawn.search(wing.refurnished(seed, percent / 100.0).walls(), placesOfPlan);
        }
}

} // namespace

Walls wallsIn(const World &world) {
    Walls walls;
    for (const World::Edge &e : world.edges)
        walls.emplace_back(Point(e.x1, e.y1), Point(e.x2, e.y2));
    return walls;
}

void append(Walls &walls, const Walls &others, Point shift) {
    for (const auto &wall : others)
        walls.emplace_back(wall.begin() + shift, wall.end() + shift);
}

std::vector<vectorlib::MapEdge> mapOf(const Walls &walls) {
    std::vector<vectorlib::MapEdge> map;
    for (const auto &wall : walls)
        map.emplace_back(std::int64_t(map.size()), vectorlib::EdgeRaw2D({}, wall, 0), 1);
    return map;
}

DrawnPlaces::DrawnPlaces(std::uint64_t seed)
    : random_(static_cast<std::mt19937::result_type>(seed))
    , scanner_(seed) {}

void DrawnPlaces::begin(const std::string &set, bool isFirstHalf) {
    set_ = set;
    isFirstHalf_ = isFirstHalf;
}

void DrawnPlaces::setMap(const Walls &walls) {
    map_ = mapOf(walls);
    trials_.setMap(map_);
}

void DrawnPlaces::search(const Walls &walls, int places, bool hasPlace, Scan scan) {
    scanner_.rays = scan == Scan::HalfTurn ? 361 : 720;
    scanner_.fieldOfView = scan == Scan::HalfTurn ? vectorlib::pi : 2 * vectorlib::pi;
    trials_.extract.segment.settings =
        vectorlib::EarSettings::forScanner(scanner_.fieldOfView, std::size_t(scanner_.rays));
    std::vector<vectorlib::LineSegment2D<float>> world;
    for (const auto &wall : walls)
        world.emplace_back(wall);
    for (int i = 0; i < places; ++i) {
        const vectorlib::Pose2D pose = FloorPlan::placeAmong(walls, random_, isOpen);
        PlaceTrial &trial = trials_.add(scanner_(world, pose), hasPlace ? std::optional(pose) : std::nullopt,
                                        scan == Scan::EdgesAlone);
        trial.set = set_;
        trial.isFirstHalf = isFirstHalf_;
        trial.scan = trials_.all.size() - 1;
    }
}

std::size_t stepsOfDrawnPlaces(std::size_t worlds, int runs) {
    return inWorlds(worlds, runs) * timeInWorld + inPlans(runs) * timeInPlan;
}

std::size_t stepsOfTowns(int runs) {
    return std::accumulate(std::begin(wallsOfTowns), std::end(wallsOfTowns), std::size_t(0)) / wallsOfTime *
           (2 * std::size_t(runs) + searchesOfTown);
}

std::vector<PlaceTrial> drawnPlacesExperiment(const std::vector<World> &worlds,
                                              const ExperimentOptions &options) {
    DrawnPlaces drawn(options.seed);
    const std::size_t first = inWorlds(worlds.size(), options.runs), second = inPlans(options.runs);
    ProgressParts parts(options.progress, {first * timeInWorld, second * timeInPlan});
    drawn.expect(first, parts.next());
    searchWorlds(drawn, worlds, options.runs);
    drawn.expect(second, parts.next());
    for (int i = 0; i < options.runs; ++i) {
        const auto seed = unsigned(options.seed * 1000 + std::uint64_t(i));
        searchPlan(drawn, seed);
        searchRefurnished(drawn, seed);
        searchCopies(drawn, seed);
    }
    return drawn.trials();
}

std::vector<PlaceTrial> townsExperiment(const ExperimentOptions &options) {
    DrawnPlaces drawn(options.seed);
    ProgressParts parts(options.progress, {std::begin(wallsOfTowns), std::end(wallsOfTowns)});
    for (const std::size_t least : wallsOfTowns) {
        const ProgressSink tell = parts.next();
        Walls town, first;
        const int perPlan = std::min<int>(rooms, int(least) / 25),
                  columns = int(std::sqrt(least / 2000.0)) + 1;
        for (int i = 0; town.size() < least; ++i) {
            const FloorPlan plan(unsigned(options.seed * 100000 + std::uint64_t(i)), perPlan);
            append(town, plan.walls(), {70.0 * (i % columns), 20.0 * (i / columns)});
            if (i == 0)
                first = plan.walls();
        }
        drawn.setMap(town);
        drawn.begin(std::to_string(town.size()));
        drawn.expect(2 * std::size_t(options.runs), [&tell](std::size_t done, std::size_t all) {
            tell(done + searchesOfTown, all + searchesOfTown);
        });
        drawn.search(first, 2 * options.runs);
    }
    return drawn.trials();
}

nlohmann::ordered_json summaryBySet(const std::vector<PlaceTrial> &trials) {
    nlohmann::ordered_json json;
    for (const std::string &name : namesOf(trials))
        json[name] = summaryOf(setOf(trials, name));
    return json;
}

double slopeOf(const std::vector<PlaceTrial> &towns) {
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (const std::string &walls : namesOf(towns)) {
        const double x = std::log(std::stod(walls)),
                     y = std::log(summaryOf(setOf(towns, walls))["median_ms"].get<double>());
        n += 1;
        sx += x;
        sy += y;
        sxx += x * x;
        sxy += x * y;
    }
    return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

void writeCsv(std::ostream &out, const std::vector<PlaceTrial> &trials) {
    using vectorlib::Number;
    out << "set,has_place,outcome,right,places,score,probability,reliability,least_lead,error_m,error_deg,"
           "time_ms\n";
    for (const PlaceTrial &t : trials)
        out << '"' << t.set << "\"," << t.hasPlace << ',' << vectorlib::name(t.outcome) << ',' << t.isRight()
            << ',' << t.leads.size() << ',' << Number(t.score) << ',' << Number(t.probability) << ','
            << Number(t.reliability) << ',' << Number(t.leads.empty() ? 0 : t.leads.front()) << ','
            << Number(t.metres) << ',' << Number(t.degrees) << ',' << Number(t.milliseconds) << '\n';
}

} // namespace hermes::experiments
