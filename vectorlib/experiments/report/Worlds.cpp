#include "vectorlib/experiments/report/Worlds.h"

#include "common/world/World.h"
#include "gui/vector/Failure.h"
#include "gui/vector/Input.h"

#include <map>

namespace hermes::experiments {

using vector::Failure;
using vector::Input;
using vector::valueOrFail;
using vector::worldFile;

namespace {

struct KnownWorld {
    std::string description;
    double discrepancy;                          ///< threshold of the appendices; m^2
    std::string publishedCase, publishedOverall; ///< their figures
};

// clang-format off
const std::map<std::string, KnownWorld> known = {
    {"pillars", {"Four walls and eight pillars. The robot drives behind the pillars, which hide much of the walls: few "
                 "edges are seen whole, and the pillars look alike.", 0.2,
                 "Published (appendix A): 87 potential pairs, 22 of them true; 15 solutions, the first accepted.",
                 "Published (appendix B): a true solution accepted in 32 of 38 cases, none in 5, only a wrong one in 1; "
                 "wrong solutions accepted: 7, all with a discrepancy of 0."}},
    {"quadratic", {"Three walls and a fourth of stairs whose depth grows quadratically. The first steps are lower than "
                   "the noise, the last ones are easily told apart.", 0.5,
                   "Published (appendix C): 202 potential pairs, 23 of them true; 6 solutions, the first accepted.",
                   "Published (appendix D): a reasonable solution accepted in all 25 cases; further ones accepted: 8; "
                   "wrong pairs in the first-ranked solutions: 82, 0 to 11 a case."}},
    {"cutsquare", {"A square room with one corner cut off: few edges, all of them long. Between some scans the robot "
                   "turns by more than is permitted.", 0.2, "", ""}},
    {"oblique", {"A room whose walls all have directions of their own. Between two scans the robot turns by more than "
                 "is permitted.", 0.2, "", ""}}};
// clang-format on

} // namespace

ReportWorld findWorld(const std::string &name) {
    Input input(worldFile(name));
    World world = valueOrFail(parseWorld(input.readAll(), input.name()));
    if (world.poses.size() < 2)
        throw Failure(input.name() + ": found " + std::to_string(world.poses.size()) +
                      " poses, a report needs two or more");
    const auto found = known.find(world.name);
    if (found == known.end())
        return {std::move(world), "A world of line segments.", "", ""};
    const KnownWorld &of = found->second;
    return {std::move(world), of.description, of.publishedCase, of.publishedOverall};
}

ReportSettings settingsFor(const std::string &name) {
    ReportSettings settings;
    if (const auto found = known.find(name); found != known.end())
        settings.search.discrepancy = found->second.discrepancy;
    return settings;
}

} // namespace hermes::experiments
