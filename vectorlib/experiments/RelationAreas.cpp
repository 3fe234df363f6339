#include "vectorlib/experiments/RelationAreas.h"

#include "vectorlib/io/Number.h"
#include "vectorlib/relations/TypedSegmentExtractor.h"

#include <algorithm>
#include <map>

namespace hermes::experiments {

using vectorlib::Number;
using vectorlib::Transformation2D;
using TypedSegments = std::vector<vectorlib::TypedSegment>;

namespace {

std::vector<TypedSegments> segmentsOf(const std::vector<PosedScan> &scans) {
    vectorlib::TypedSegmentExtractor extract;
    extract.setScanner(vectorlib::pi, halfTurnRays);
    std::vector<TypedSegments> all;
    for (const PosedScan &scan : scans)
        all.push_back(extract(scan.points));
    return all;
}

/// Slope of the least squares line through the areas.
double slopeOf(const std::vector<DistanceArea> &rows, bool isAll) {
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (const DistanceArea &r : rows)
        if (r.isAll == isAll) {
            const double w = double(r.pairs);
            n += w;
            x += w * r.distance;
            y += w * r.area;
            xx += w * r.distance * r.distance;
            xy += w * r.distance * r.area;
        }
    const double spread = n * xx - x * x;
    return spread > 0 ? (n * xy - x * y) / spread : 0;
}

double meanOf(const std::vector<DistanceArea> &rows, bool isAll) {
    double n = 0, sum = 0;
    for (const DistanceArea &r : rows)
        if (r.isAll == isAll) {
            n += double(r.pairs);
            sum += double(r.pairs) * r.area;
        }
    return n > 0 ? sum / n : 0;
}

} // namespace

std::vector<InjectedError> injectedErrors(const World &world, std::uint64_t seed) {
    const TypedSegments scan =
        segmentsOf(scansAt(world, {world.poses.front()}, halfTurnScanner(seed))).front();
    std::vector<vectorlib::CorrespondencePair> pairs;
    for (std::size_t i = 0; i < scan.size(); ++i)
        pairs.push_back({int(i), int(i)});
    vectorlib::MatchErrors errors;
    std::vector<InjectedError> rows;
    for (int i = 0; i <= 60; ++i) {
        const double turn = 0.5 * i;
        rows.push_back(
            {true, turn,
             errors.area(pairs, scan, scan, Transformation2D(0, 0, turn * vectorlib::pi / 180)).error});
    }
    for (int i = 0; i <= 100; ++i)
        rows.push_back(
            {false, 0.01 * i, errors.area(pairs, scan, scan, Transformation2D(0.01 * i, 0, 0)).error});
    return rows;
}

nlohmann::ordered_json summaryOf(const std::vector<InjectedError> &rows) {
    const auto areaAt = [&](bool isRotation, double amount) {
        const auto row = std::find_if(rows.begin(), rows.end(), [&](const InjectedError &r) {
            return r.isRotation == isRotation && std::abs(r.amount - amount) < 1e-9;
        });
        return row != rows.end() ? nlohmann::ordered_json(row->area) : nlohmann::ordered_json();
    };
    bool grows = true;
    for (std::size_t i = 1; i < rows.size(); ++i)
        grows = grows && (rows[i].isRotation != rows[i - 1].isRotation || rows[i].area > rows[i - 1].area);
    return {{"area_at_10_deg_m2", areaAt(true, 10)},
            {"area_at_50_cm_m2", areaAt(false, 0.5)},
            {"grows_throughout", grows}};
}

void writeCsv(std::ostream &out, const std::vector<InjectedError> &rows) {
    out << "kind,amount,error_area_m2\n";
    for (const InjectedError &r : rows)
        out << (r.isRotation ? "rotation_deg" : "translation_m") << ',' << Number(r.amount) << ','
            << Number(r.area) << '\n';
}

std::vector<Plot> plotsOf(const std::vector<InjectedError> &rows) {
    Curve rotation{"", "#0072b2", {}}, translation{"", "#0072b2", {}};
    for (const InjectedError &r : rows)
        (r.isRotation ? rotation : translation).points.emplace_back(r.amount, r.area);
    return {{"rotation",
             "a scan on its copy, turned",
             "rotation [deg]",
             "error area [m^2]",
             false,
             false,
             {rotation}},
            {"translation",
             "a scan on its copy, moved",
             "translation [m]",
             "error area [m^2]",
             false,
             false,
             {translation}}};
}

ApproachResult approach(const World &world, std::uint64_t seed, std::size_t every,
                        const ProgressSink &progress) {
    const std::vector<PosedScan> scans = scansAt(world, posesAlong(world, 1480), halfTurnScanner(seed));
    const std::vector<TypedSegments> segments = segmentsOf(scans);
    vectorlib::RelationMatcher match;
    match.settings.leastSigns = 0; // the world is one corner
    vectorlib::MatchErrors errors;
    ApproachResult result;
    std::map<int, std::pair<double, std::size_t>> bins;
    std::size_t all = scans.size() - 1;
    for (std::size_t i = every; i < scans.size(); i += every)
        all += (scans.size() - 1 - i) / every;
    for (std::size_t i = 0; i < scans.size(); i += every) {
        for (std::size_t j = i + (i == 0 ? 1 : every); j < scans.size(); j += i == 0 ? 1 : every) {
            const vectorlib::RelationMatch &found = match(segments[i], segments[j]);
            ++result.pairs;
            if (!found.isMatched())
                continue;
            ++result.matched;
            const double area = errors.area(found.pairs, segments[i], segments[j], found.pose).error;
            const double distance =
                std::hypot(scans[j].pose.x - scans[i].pose.x, scans[j].pose.y - scans[i].pose.y);
            if (i == 0)
                result.rows.push_back({false, distance, area, 1});
            if (j % every != 0)
                continue; // of all pairs each counts as much, the first scan's no more than the others
            auto &bin = bins[int(distance * 100)];
            bin.first += area;
            ++bin.second;
        }
        if (progress)
            progress(result.pairs, all);
    }
    for (const auto &[centimetre, bin] : bins)
        result.rows.push_back({true, (centimetre + 0.5) / 100, bin.first / double(bin.second), bin.second});
    result.meanFirst = meanOf(result.rows, false);
    result.meanAll = meanOf(result.rows, true);
    result.slopeFirst = slopeOf(result.rows, false);
    result.slopeAll = slopeOf(result.rows, true);
    return result;
}

void writeCsv(std::ostream &out, const ApproachResult &result) {
    out << "pairs_of,distance_m,error_area_m2,pairs\n";
    for (const DistanceArea &r : result.rows)
        out << (r.isAll ? "all" : "first") << ',' << Number(r.distance) << ',' << Number(r.area) << ','
            << r.pairs << '\n';
}

std::vector<Plot> plotsOf(const ApproachResult &result) {
    Curve first{"", "#0072b2", {}}, all{"", "#0072b2", {}};
    for (const DistanceArea &r : result.rows)
        (r.isAll ? all : first).points.emplace_back(r.distance, r.area);
    return {{"first",
             "the first scan with all others",
             "distance [m]",
             "error area [m^2]",
             false,
             false,
             {first}},
            {"all", "all pairs, means of 1 cm", "distance [m]", "error area [m^2]", false, false, {all}}};
}

nlohmann::ordered_json summaryOf(const ApproachResult &result) {
    return {{"pairs", result.pairs},
            {"matched", result.matched},
            {"mean_area_first_m2", result.meanFirst},
            {"mean_area_all_m2", result.meanAll},
            {"slope_first_m2_per_m", result.slopeFirst},
            {"slope_all_m2_per_m", result.slopeAll}};
}

} // namespace hermes::experiments
