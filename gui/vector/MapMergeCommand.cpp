#include "common/progress/Progress.h"
#include "gui/vector/Failure.h"
#include "gui/vector/MapFiles.h"
#include "gui/vector/Options.h"
#include "vectorlib/mapping/MapAligner.h"

#include <nlohmann/json.hpp>

namespace hermes::vector {

namespace {

using vectorlib::MapAlignment;

class MapMergeCommand {
public:
    std::string first, second, at, out, summary;
    bool force = false;

    void run() const {
        OutputSet files(force);
        MapFile mapFile(files, out);
        std::ostream &summaryFile = files.open(summary);
        vectorlib::VectorMap map;
        for (const vectorlib::MapEdge &edge : loadMap(first))
            map.add(edge, edge.observations);
        const std::vector<vectorlib::MapEdge> added = loadMap(second);

        const MapAlignment found = at.empty() ? align(map, added) : refine(map, added);
        const vectorlib::MapOverlap &overlap = found.overlap;
        if (overlap.length < leastOverlap || overlap.reliability < leastReliability)
            throw Failure(refused("walls of " + std::to_string(overlap.length) +
                                  " m lie on each other with directions of reliability " +
                                  std::to_string(overlap.reliability)) +
                          ", expected at least 5 m and 0.02");
        vectorlib::mergeMap(map, added, overlap.motion);
        vectorlib::MapDrawing drawing;
        drawing.title = first + " and " + second;
        map.forEach([&](const vectorlib::MapEdge &edge) { drawing.segments.push_back(edge); });
        mapFile.write(drawing);
        nlohmann::ordered_json json = summaryOf(found, added);
        json["segments"] = drawing.segments.size();
        summaryFile << json.dump(2) << '\n';
        files.commit();
    }

private:
    static constexpr double leastOverlap = 5, leastReliability = 0.02; // metres, none
    static constexpr double farthestMove = 0.5, farthestTurn = 0.15; // from what --at tells; metres, radians

    MapAlignment align(vectorlib::VectorMap &map, const std::vector<vectorlib::MapEdge> &added) const {
        vectorlib::MapAligner aligner;
        Progress progress("searching, place");
        aligner.progress = [&](std::size_t done, std::size_t all) {
            progress.update(double(done), double(all));
        };
        const MapAlignment found = aligner(map, added);
        const auto count = [](std::size_t n) { return std::to_string(n); };
        const std::string of = count(found.places) + " places of the second map ";
        switch (found.outcome) {
        case MapAlignment::Outcome::Found:
            break;
        case MapAlignment::Outcome::Nowhere:
            throw Failure(refused("of " + of + count(found.found) + " were found in the first and " +
                                  count(found.agree) + " agree, expected at least " +
                                  count(aligner.leastAgree) + "; --at x,y,theta tells the motion"));
        case MapAlignment::Outcome::Ambiguous:
            throw Failure(refused("of " + of + count(found.agree) + " agree on one motion and " +
                                  count(found.rival) +
                                  " on another, expected less than half; --at x,y,theta tells the motion"));
        case MapAlignment::Outcome::Contradicted:
            throw Failure(refused("of " + of + count(found.agree) + " agree, but " + count(found.against) +
                                  " would be looked at through walls of the first, expected less than half"));
        }
        return found;
    }
    MapAlignment refine(vectorlib::VectorMap &map, const std::vector<vectorlib::MapEdge> &added) const {
        const vectorlib::Transformation2D told(parsePose(at));
        MapAlignment given = vectorlib::MapAligner().confirm(map, added, told);
        const vectorlib::Transformation2D off = told.inverse() * given.overlap.motion;
        if (std::abs(off.alpha()) > farthestTurn || off.translation().norm() > farthestMove)
            throw Failure(refused("walls lie on each other " + std::to_string(off.translation().norm()) +
                                  " m and " + std::to_string(std::abs(off.alpha())) +
                                  " rad from --at, expected at most 0.5 m and 0.15 rad"));
        if (given.outcome == MapAlignment::Outcome::Contradicted)
            throw Failure(
                refused("at --at, " + std::to_string(given.agree) + " of " + std::to_string(given.places) +
                        " places of the second map agree, but " + std::to_string(given.against) +
                        " would be looked at through walls of the first, expected less than half as many"));
        return given;
    }
    std::string refused(const std::string &why) const {
        return first + " and " + second + ": not joined: " + why;
    }
    nlohmann::ordered_json summaryOf(const MapAlignment &found,
                                     const std::vector<vectorlib::MapEdge> &added) const {
        const vectorlib::Pose2D motion = found.overlap.motion.pose();
        double length = 0;
        for (const vectorlib::MapEdge &edge : added)
            length += edge.segment.length();
        nlohmann::ordered_json json;
        json["transformation"] = {{"x", motion.x}, {"y", motion.y}, {"theta", motion.theta}};
        json["overlap_m"] = found.overlap.length;
        json["overlap_share"] = found.overlap.length / std::max(1e-9, length);
        json["residual_rms_m"] = found.overlap.rms;
        json["reliability"] = found.overlap.reliability;
        json["places"] = found.places;
        json["places_agree"] = found.agree;
        json["places_against"] = found.against;
        if (at.empty()) {
            json["places_found"] = found.found;
            json["places_rival"] = found.rival;
        }
        return json;
    }
};

} // namespace

void addMapMergeCommand(CLI::App &app) {
    const auto [sub, command] = addCommand<MapMergeCommand>(
        app, "map-merge", "Join two maps where they show the same place (the motion between them as JSON)",
        "hermes-vector map-merge monday.csv tuesday.csv --out both.csv");
    sub->add_option("A", command->first, "A map (CSV by map --out-map); the result has its frame")
        ->required();
    sub->add_option("B", command->second, "The map that is moved onto it")->required();
    addOption(*sub, "--out FILE", command->out, MapFile::knownName(),
              "The map of both; its kind follows from the extension: csv, svg, geojson, dxf, pgm")
        ->required();
    addOption(*sub, "--at X,Y,THETA", command->at, poseText(),
              "Where B's frame lies in A's, to within 0.5 m and 0.15 rad; not given: it is searched");
    addOption(*sub, "--summary FILE", command->summary,
              "The motion and how sure it is; standard output when not given");
    sub->add_flag("--force", command->force, "Overwrite files that exist");
}

} // namespace hermes::vector
