#include "vectorlib/experiments/SearchStages.h"

#include "vectorlib/correspondence/PublishedSearch.h"
#include "vectorlib/experiments/ProcessorTime.h"
#include "vectorlib/io/Number.h"
#include "vectorlib/io/Svg.h"

#include <random>

namespace hermes::experiments {

namespace {

using vectorlib::Transformation2D;

constexpr double accuracies[] = {0.05, 0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0, 1.2, 1.5, 1.8, 2.4};
constexpr double anglePerMetre = 1.26 / 1.2; // appendices
constexpr std::uint64_t maxTried = 20000;    // a curve needs no more

// The scans as they lie when the second is expected at the truth but for an error.
ScanPair expectedWithin(const ScanPair &scans, const vectorlib::PermittedError &error,
                        std::mt19937_64 &random) {
    std::uniform_real_distribution<double> any(-1, 1);
    const double x = error.dx * any(random), y = error.dy * any(random), alpha = error.dalpha * any(random);
    const Transformation2D toExpected = (scans.truth * Transformation2D(x, y, alpha).inverse()).inverse();
    ScanPair result = scans;
    for (vectorlib::LineSegment2D<double> &segment : result.fixed.segments)
        segment = toExpected * segment;
    result.truth = toExpected * scans.truth;
    return result;
}

void add(SearchStages &row, const ScanPair &scans, vectorlib::PublishedSearch &search,
         vectorlib::CorrespondenceFinder &find) {
    const vectorlib::PublishedResult &found = search(scans.fixed.segments, scans.moving.segments);
    const PairCounts counts = scans.count({}, search.settings.permitted);
    ++row.searches;
    row.potentialPairs += static_cast<double>(found.search.potentialPairs);
    row.truePairs += counts.falseNegative; // no pair is chosen
    row.bundles += static_cast<double>(found.search.bundles);
    row.buckets += static_cast<double>(found.search.buckets);
    row.tried += static_cast<double>(found.search.combinations);
    row.solutions += static_cast<double>(found.found - found.parts);
    const double begin = processorMicroseconds();
    find(scans.fixed.segments, scans.moving.segments);
    row.microseconds += processorMicroseconds() - begin;
}

/// Of a search, beside that with other accuracies, about.
std::size_t workAt(double accuracy) {
    return 10 + static_cast<std::size_t>(25 * accuracy * accuracy);
}

SearchStages stagesAt(const SearchScene &scene, double accuracy, int runs, std::mt19937_64 &random,
                      const std::function<void()> &searched) {
    SearchStages row;
    row.scene = scene.name;
    row.accuracy = accuracy;
    row.angle = std::min(vectorlib::pi, accuracy * anglePerMetre);
    vectorlib::PublishedSearch search;
    search.settings.permitted = {row.accuracy, row.accuracy, row.angle};
    search.combine.keep = 1;
    search.combine.most = maxTried;
    vectorlib::CorrespondenceFinder find;
    find.settings.permitted = search.settings.permitted;
    for (const ScanPair &scans : scene.pairs)
        for (int run = 0; run < runs; ++run) {
            add(row, expectedWithin(scans, search.settings.permitted, random), search, find);
            searched();
        }
    for (double *sum : {&row.potentialPairs, &row.truePairs, &row.bundles, &row.buckets, &row.tried,
                        &row.solutions, &row.microseconds})
        *sum /= row.searches;
    return row;
}

} // namespace

World searchExample() {
    // Counter-clockwise along the walls: free space on the left.
    const std::vector<vectorlib::Vector2D<double>> corners = {{6.5, 0},   {6.5, 4},   {4, 4},   {4, 3.6},
                                                              {3.4, 3.6}, {3.4, 3.2}, {0, 3.2}, {0, 0}};
    const Transformation2D turn(0, 0, vectorlib::pi / 4);
    World world;
    world.name = "example";
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const auto a = turn * corners[i], b = turn * corners[(i + 1) % corners.size()];
        world.edges.push_back({a.x, a.y, b.x, b.y});
    }
    const double east = -vectorlib::pi / 4;
    for (const vectorlib::Pose2D &pose :
         {vectorlib::Pose2D{5.8, 0.9, east}, vectorlib::Pose2D{5.65, 1.1, east + 0.12}})
        world.poses.push_back((turn * Transformation2D(pose)).pose());
    return world;
}

ScanSettings searchExampleScans() {
    ScanSettings settings;
    settings.noise = 0.003;
    settings.sigma = 0.01;
    return settings;
}

SearchScene searchScene(const World &world, std::uint64_t seed, ScanSettings settings) {
    SearchScene scene{world.name, {}};
    for (std::size_t i = 0; i + 1 < world.poses.size(); ++i) {
        settings.seed = seed * 1000003 + i;
        scene.pairs.push_back(scanPair(edgesOf(world), world.poses[i], world.poses[i + 1], settings));
    }
    return scene;
}

std::vector<SearchStages> searchStages(const std::vector<SearchScene> &scenes,
                                       const ExperimentOptions &options) {
    std::vector<SearchStages> rows;
    std::mt19937_64 random(options.seed);
    std::size_t done = 0, all = 0;
    for (const SearchScene &scene : scenes)
        for (const double accuracy : accuracies)
            all += workAt(accuracy) * scene.pairs.size() * std::size_t(options.runs);
    for (const SearchScene &scene : scenes)
        for (const double accuracy : accuracies)
            rows.push_back(stagesAt(scene, accuracy, options.runs, random, [&] {
                done += workAt(accuracy);
                if (options.progress)
                    options.progress(done, all);
            }));
    return rows;
}

void writeCsv(std::ostream &out, const std::vector<SearchStages> &rows) {
    using vectorlib::Number;
    out << "scene,accuracy_m,accuracy_rad,searches,potential_pairs,true_pairs,bundles,buckets,bundles_tried,"
           "solutions,finder_us\n";
    for (const SearchStages &r : rows)
        out << r.scene << ',' << Number(r.accuracy) << ',' << Number(r.angle) << ',' << r.searches << ','
            << Number(r.potentialPairs) << ',' << Number(r.truePairs) << ',' << Number(r.bundles) << ','
            << Number(r.buckets) << ',' << Number(r.tried) << ',' << Number(r.solutions) << ','
            << Number(r.microseconds) << '\n';
}

std::vector<Plot> plotsOf(const std::vector<SearchStages> &rows) {
    std::vector<Plot> plots;
    const auto add = [&](const char *name, const char *title, const char *axis, bool isLogarithmic,
                         auto quantity) {
        Plot plot{name,          title, "accuracy of the expected pose [m], with 1.05 rad each", axis, false,
                  isLogarithmic, {}};
        for (const SearchStages &r : rows) {
            if (plot.curves.empty() || plot.curves.back().label != r.scene)
                plot.curves.push_back({r.scene, vectorlib::colour::distinct(plot.curves.size()), {}});
            plot.curves.back().points.emplace_back(r.accuracy, quantity(r));
        }
        plots.push_back(std::move(plot));
    };
    add("number", "figure 7.17: potential pairs by accuracy", "potential pairs", false,
        [](const SearchStages &r) { return r.potentialPairs; });
    add("of-one", "potential pairs for each true one", "potential pairs", false,
        [](const SearchStages &r) { return r.pairsOfOne(); });
    add("bundles", "bundles by accuracy, published rules", "bundles", false,
        [](const SearchStages &r) { return r.bundles; });
    add("solutions", "reliable, unambiguous combinations, published rules", "combinations", false,
        [](const SearchStages &r) { return r.solutions; });
    add("tried", "what it costs to find them all", "bundles tried", true,
        [](const SearchStages &r) { return r.tried; });
    add("time", "processor time of the finder", "time [us]", true,
        [](const SearchStages &r) { return r.microseconds; });
    return plots;
}

} // namespace hermes::experiments
