#include "daemons/scanmatcher/MapHistory.h"

#include <algorithm>
#include <utility>

namespace hermes::scanmatcher {

std::size_t MapHistory::add(Step step) {
    std::vector<Step> gone = std::exchange(redone_, {});
    undone_.push_back(std::move(step));
    if (undone_.size() > maxSteps) {
        gone.push_back(std::move(undone_.front()));
        undone_.erase(undone_.begin());
    }
    return std::size_t(
        std::count_if(gone.begin(), gone.end(), [](const Step &s) { return s.map && !s.map->isEmpty(); }));
}

std::size_t MapHistory::addReplay(vectorlib::VectorMap map) {
    std::vector<Step> redone = std::exchange(redone_, {});
    const std::size_t gone = add({"replay", std::move(map), false, {}, {}});
    redone_ = std::move(redone);
    return gone;
}

void MapHistory::keepMap(const vectorlib::VectorMap &map) {
    if (!undone_.empty() && !undone_.back().map)
        undone_.back().map = map;
}

void MapHistory::move(const vectorlib::Transformation2D &moved) {
    const auto move = [&moved](vectorlib::Pose2D &pose) {
        pose = (moved * vectorlib::Transformation2D(pose)).pose();
    };
    for (std::vector<Step> *steps : {&undone_, &redone_})
        for (auto step = steps->rbegin(); step != steps->rend(); ++step) {
            move(step->told);
            if (step->map) // what was before lies in that one
                break;
            move(step->before);
        }
}

std::optional<MapHistory::Step> MapHistory::take(bool again) {
    std::vector<Step> &steps = again ? redone_ : undone_;
    if (steps.empty())
        return std::nullopt;
    Step step = std::move(steps.back());
    steps.pop_back();
    return step;
}

void MapHistory::put(Step back, bool again) {
    if (back.map && !back.isPose) // where the sensor is in the map that is back is not known
        for (Step &older : again ? redone_ : undone_)
            older.place = vectorlib::PlaceState::Sought;
    (again ? undone_ : redone_).push_back(std::move(back));
}

} // namespace hermes::scanmatcher
