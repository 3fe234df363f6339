#include "vectorlib/experiments/PlaceTrial.h"

#include "vectorlib/experiments/ProcessorTime.h"

#include <algorithm>

namespace hermes::experiments {

using vectorlib::Place;
using vectorlib::Pose2D;
using Outcome = vectorlib::Relocalized::Outcome;

namespace {

double metresOf(const Pose2D &off) {
    return std::hypot(off.x, off.y);
}

double degreesOf(const Pose2D &off) {
    return std::abs(off.theta) * 180 / vectorlib::pi;
}

void compare(PlaceTrial &trial, const std::vector<Place> &places, const Pose2D &truth) {
    for (std::size_t i = places.size(); i-- > 0;) {
        const Pose2D off = truth.inverse() * places[i].pose;
        trial.metres = metresOf(off);
        trial.degrees = degreesOf(off);
        if (trial.metres <= 0.5 && trial.degrees <= 10)
            trial.right = i;
    }
}

} // namespace

void PlaceTrials::expect(std::size_t trials, ProgressSink progress) {
    before_ = all.size();
    expected_ = trials;
    progress_ = std::move(progress);
}

void PlaceTrials::setMap(const std::vector<vectorlib::MapEdge> &slots) {
    slots_ = &slots;
    search_.index().clear();
    search_.index().follow(slots);
}

PlaceTrial &PlaceTrials::add(vectorlib::PointSpan<float> points, const std::optional<Pose2D> &truth,
                             bool byEdges) {
    PlaceTrial trial;
    const std::vector<vectorlib::EdgeRaw2D> &edges = extract(points);
    const double begin = processorMicroseconds();
    const vectorlib::Relocalized &found =
        search_(*slots_, edges, byEdges ? vectorlib::PointSpan<float>() : points);
    trial.milliseconds = (processorMicroseconds() - begin) / 1000;
    trial.outcome = found.outcome;
    trial.hasPlace = truth.has_value();
    for (const Place &place : found.places)
        trial.leads.push_back(place.lead);
    if (!found.places.empty()) {
        trial.score = found.places.front().score;
        trial.probability = found.places.front().probability;
        trial.reliability = found.places.front().reliability;
    }
    if (truth)
        compare(trial, found.places, *truth);
    all.push_back(trial);
    if (progress_)
        progress_(all.size() - before_, expected_);
    return all.back();
}

nlohmann::ordered_json summaryOf(const std::vector<PlaceTrial> &all) {
    nlohmann::ordered_json json = {{"scans", all.size()}};
    if (all.empty())
        return json;
    const auto share = [&](auto holds) {
        return double(std::count_if(all.begin(), all.end(), holds)) / double(all.size());
    };
    const auto outcome = [&](Outcome which) {
        return share([which](const PlaceTrial &t) { return t.outcome == which; });
    };
    if (std::any_of(all.begin(), all.end(), [](const PlaceTrial &t) { return t.hasPlace; })) {
        json["first_right"] = share([](const PlaceTrial &t) { return t.isRight(); });
        json["first_within_10cm_2deg"] = share([](const PlaceTrial &t) { return t.isNear(); });
        json["found_right"] = share([](const PlaceTrial &t) { return t.isFound() && t.isRight(); });
        json["found_within_10cm_2deg"] = share([](const PlaceTrial &t) { return t.isFound() && t.isNear(); });
    }
    json["found_wrong"] = share([](const PlaceTrial &t) { return t.isFound() && !t.isRight(); });
    json["ambiguous"] = outcome(Outcome::Ambiguous);
    json["nowhere"] = outcome(Outcome::Nowhere);
    json["too_little"] = outcome(Outcome::TooLittle);
    json["unfinished"] = outcome(Outcome::Unfinished);
    std::vector<double> times;
    for (const PlaceTrial &t : all)
        times.push_back(t.milliseconds);
    std::sort(times.begin(), times.end());
    json["median_ms"] = times[times.size() / 2];
    json["p99_ms"] = times[times.size() * 99 / 100];
    json["longest_ms"] = times.back();
    return json;
}

} // namespace hermes::experiments
