#include "gui/vector/MatchMethods.h"
#include "gui/vector/Options.h"
#include "gui/vector/SearchOptions.h"
#include "gui/vector/SegmentSet.h"
#include "vectorlib/io/Svg.h"

#include <nlohmann/json.hpp>

#include <iostream>

namespace hermes::vector {

namespace {

using Json = nlohmann::ordered_json;
using Segments = std::vector<vectorlib::LineSegment2D<double>>;
using vectorlib::Solution;
using vectorlib::Transformation2D;

Json jsonOf(const Segments &segments) {
    Json list = Json::array();
    for (const vectorlib::LineSegment2D<double> &s : segments)
        list.push_back({s.begin().x, s.begin().y, s.end().x, s.end().y});
    return list;
}

Json jsonOf(const std::optional<Eigen::Matrix3d> &matrix) {
    if (!matrix)
        return nullptr;
    Json rows = Json::array();
    for (int r = 0; r < 3; ++r)
        rows.push_back({(*matrix)(r, 0), (*matrix)(r, 1), (*matrix)(r, 2)});
    return rows;
}

struct MatchCommand {
    std::string fixedPath, movingPath, expected, method;
    std::optional<double> deviationXY, deviationAlpha;
    bool isMap = false;
    SegmentSetSettings reading;
    SearchOptions search;
    OutputOptions output;

    void run() const {
        Outputs files(output);
        const SegmentSet fixed = loadSegmentSet(fixedPath, reading),
                         moving = loadSegmentSet(movingPath, reading);
        if (isMap && fixed.kind == SegmentSet::Kind::Points)
            throw CLI::ValidationError("--map", "found points in " + fixedPath + ", expected segments");

        const Transformation2D around =
            expected.empty() ? Transformation2D() : Transformation2D(parsePose(expected));
        const Matched result = match(fixed, moving, around);
        write(files.out, result, fixed, moving);
        if (result.solutions.empty())
            std::cerr << "hermes-vector: no solution: " << result.text() << '\n';
        files.draw([&] {
            return pictureOf(result, fixed, moving,
                             expected.empty() && result.method != "finder" ? std::nullopt
                                                                           : std::make_optional(around));
        });
        files.commit();
    }

    Matched match(const SegmentSet &fixed, const SegmentSet &moving, const Transformation2D &around) const {
        const bool inMap = isMap || fixed.kind == SegmentSet::Kind::Map;
        const bool areScans =
            fixed.kind == SegmentSet::Kind::Points && moving.kind == SegmentSet::Kind::Points;
        if ((method == "global" || method == "relations") && (inMap || !expected.empty()))
            throw CLI::ValidationError("--method", method + (inMap ? " finds no place in a map: take finder"
                                                                   : " takes no --expected motion"));
        if ((method == "global" || method == "relations") && search.isGiven())
            throw CLI::ValidationError("--method",
                                       method + " has no use for options of the search: take finder");
        if (method == "relations")
            return matchByRelations(fixed, moving);
        const bool wantsFinder = method == "finder" || (method.empty() && (inMap || search.isGiven()));
        if (wantsFinder || (!expected.empty() && !areScans))
            return matchByFinder(fixed, moving, searchSettings(), around, inMap);
        if (!expected.empty())
            return matchTracking(fixed, moving,
                                 {around, deviationXY.value_or(0.15), deviationAlpha.value_or(0.10)},
                                 reading.segmentation(fixed.points.size()), reading.noise);
        const Matched anywhere = matchGlobally(fixed, moving, reading.noise);
        const bool mayTryLines = method.empty() && !areScans && anywhere.solutions.empty();
        return mayTryLines ? matchByFinder(fixed, moving, searchSettings(), around, false) : anywhere;
    }
    // Three standard deviations of the expected motion are permitted, where they are told.
    vectorlib::SearchSettings searchSettings() const {
        vectorlib::SearchSettings settings;
        if (deviationXY)
            settings.permitted.dx = settings.permitted.dy = 3 * *deviationXY;
        if (deviationAlpha)
            settings.permitted.dalpha = std::min(vectorlib::pi, 3 * *deviationAlpha);
        return search.over(settings);
    }

    static void write(std::ostream &out, const Matched &result, const SegmentSet &fixed,
                      const SegmentSet &moving) {
        Json json = {{"method", result.method},
                     {"outcome", name(result.outcome)},
                     {"text", result.text()},
                     {"potential_pairs", result.potentialPairs},
                     {"combinations", result.combinations},
                     {"solutions", Json::array()}};
        for (const MatchedSolution &m : result.solutions) {
            const Solution &s = m.solution;
            Json pairs = Json::array();
            for (const vectorlib::CorrespondencePair &p : s.pairs)
                pairs.push_back({p.fixed, p.moving});
            json["solutions"].push_back(
                {{"pose", {{"x", s.pose.x()}, {"y", s.pose.y()}, {"alpha", s.pose.alpha()}}},
                 {"covariance", jsonOf(m.covariance)},
                 {"accepted", s.accepted},
                 {"verdict", m.verdict},
                 {"probability", m.probability ? Json(*m.probability) : Json(nullptr)},
                 {"reliability", s.reliability},
                 {"ambiguity", s.ambiguity},
                 {"discrepancy", s.view.discrepancy},
                 {"common_area", s.view.common},
                 {"shared_angle", s.view.angle},
                 {"matched_share", s.matchedShare},
                 {"score", s.score},
                 {"pairs", pairs}});
        }
        if (fixed.kind == SegmentSet::Kind::Points)
            json["static"] = jsonOf(fixed.segments());
        if (moving.kind == SegmentSet::Kind::Points)
            json["dynamic"] = jsonOf(moving.segments());
        out << json.dump(2) << '\n';
    }

    static vectorlib::SvgPicture pictureOf(const Matched &result, const SegmentSet &fixed,
                                           const SegmentSet &moving,
                                           const std::optional<Transformation2D> &around) {
        const Solution *best = result.solutions.empty() ? nullptr : &result.solutions[0].solution;
        const Transformation2D pose = best ? best->pose : around.value_or(Transformation2D());
        std::vector<vectorlib::Vector2D<double>> points;
        for (const vectorlib::Vector2D<float> &p : moving.points)
            points.push_back(pose * vectorlib::Vector2D<double>(p));
        Segments before, after, links;
        for (const vectorlib::LineSegment2D<double> &s : moving.segments()) {
            if (around)
                before.push_back(*around * s);
            after.push_back(pose * s);
        }
        vectorlib::SvgPicture picture(!best            ? "No match: " + result.text()
                                      : best->accepted ? "Match"
                                                       : "Not accepted: " + result.solutions[0].verdict);
        picture.segments({vectorlib::colour::map, 4, "static set"}, near(fixed.segments(), moving, pose));
        if (around)
            picture.segments({vectorlib::colour::before, 1.5, "dynamic set where expected", true}, before);
        if (best) {
            for (const vectorlib::CorrespondencePair &p : best->pairs)
                if (around)
                    links.emplace_back(fixed.segments()[std::size_t(p.fixed)].middle(),
                                       before[std::size_t(p.moving)].middle());
            if (!points.empty())
                picture.points({vectorlib::colour::points, 2, "its points"}, points);
            picture.segments({vectorlib::colour::estimate, 1.5, "dynamic set moved onto the static one"},
                             after);
            if (around)
                picture.segments({vectorlib::colour::reference, 1, "correspondences"}, links);
        }
        picture.pose({vectorlib::colour::estimate, 2, "sensor"}, pose.translation(), pose.alpha());
        return picture;
    }
    // Of a large map what lies about the sensor and its scan.
    static Segments near(const Segments &fixed, const SegmentSet &moving, const Transformation2D &pose) {
        double reach = 10; // metres
        for (const vectorlib::LineSegment2D<double> &s : moving.segments())
            reach = std::max({reach, 1.5 * s.begin().norm(), 1.5 * s.end().norm()});
        vectorlib::SegmentMap map;
        for (const vectorlib::LineSegment2D<double> &s : fixed)
            map.add(s);
        Segments result;
        for (int number : map.near(pose.translation(), reach))
            result.push_back(map[number]);
        return result;
    }
};

} // namespace

void addMatchCommand(CLI::App &app) {
    const auto [sub, command] = addCommand<MatchCommand>(
        app, "match",
        "Find the motion between two scans, or the place of a scan in a map, without known partners (JSON). "
        "Both must show the same place: scans of different places that look alike match, too",
        "hermes-vector match first.csv second.csv --svg match.svg");
    const std::string kinds = "points (CSV x,y or ascii PCD), segments (CSV x1,y1,x2,y2)";
    sub->add_option("STATIC", command->fixedPath, "A scan: " + kinds + "; or a map by hermes-vector map")
        ->required();
    sub->add_option("DYNAMIC", command->movingPath, "A scan: " + kinds)->required();
    CLI::Option *expected =
        addOption(*sub, "--expected X,Y,ALPHA", command->expected, poseText(),
                  "Where the dynamic scan is expected in the static one's frame; metres, radians. Without it "
                  "nothing is known of the motion; the finder then looks about 0,0,0");
    addOption(*sub, "--deviation-xy M", command->deviationXY, aboveZero(),
              "How wrong that may be: standard deviation, metres (0.15)")
        ->needs(expected);
    addOption(*sub, "--deviation-alpha RAD", command->deviationAlpha, aboveZero(), "The same, radians (0.1)")
        ->needs(expected);
    sub->add_option("--method", command->method,
                    "global: any motion, by points or by what a scanner would see of segments; finder: every "
                    "combination of segments over a permitted set of motions; relations: any motion, by "
                    "relations of segments (finder in a map and with options of the search, else global)")
        ->check(CLI::IsMember({"global", "finder", "relations"}));
    sub->add_flag("--map", command->isMap,
                  "The static segments were seen from many places: what they do not show hides nothing");
    addOption(*sub, "--sigma M", command->reading.sigma, aboveZero(),
              "Largest standard deviation of points from their line, metres")
        ->capture_default_str();
    addOption(*sub, "--noise M", command->reading.noise, aboveZero(),
              "For the covariance: standard deviation of points, or of the ends of segments, metres (points: "
              "as they scatter; segments: 0.01)");
    command->search.addTo(*sub, "0.2");
    command->reading.segment.addTo(*sub, "defaults by the number of points");
    command->output.addTo(*sub, true);
}

} // namespace hermes::vector
