#include "vectorlib/experiments/RelationRun.h"

#include "gui/vector/Quantile.h"
#include "vectorlib/io/Number.h"
#include "vectorlib/relations/LocalMap.h"
#include "vectorlib/relations/TypedSegmentExtractor.h"

#include <algorithm>
#include <chrono>
#include <limits>

namespace hermes::experiments {

using vector::median;

using vectorlib::Pose2D;
using vectorlib::Transformation2D;

namespace {

constexpr double degrees = 180 / vectorlib::pi;

double mean(const std::vector<double> &values) {
    double sum = 0;
    for (double v : values)
        sum += v;
    return values.empty() ? 0 : sum / double(values.size());
}

/// One run while it goes on.
struct Runner {
    vectorlib::TypedSegmentExtractor extract;
    vectorlib::RelationMatcher match;
    vectorlib::LocalMap map;
    vectorlib::MatchErrors errors;
    std::vector<vectorlib::TypedSegment> reference;
    Pose2D referenceEstimate, referenceTruth;
    int lostInARow = 0;

    RelationStep first(const PosedScan &scan) {
        RelationStep step;
        step.estimate = step.truth = scan.pose;
        keep(extract(scan.points), step, {});
        return step;
    }
    RelationStep next(const PosedScan &scan) {
        using Clock = std::chrono::steady_clock;
        RelationStep step;
        step.truth = scan.pose;
        const std::vector<vectorlib::TypedSegment> &current = extract(scan.points);
        step.segments = current.size();
        const auto begin = Clock::now();
        const vectorlib::RelationMatch &found = match(reference, current);
        step.microseconds = std::chrono::duration<double, std::micro>(Clock::now() - begin).count();
        step.outcome = found.outcome;
        if (!found.isMatched()) {
            step.estimate = referenceEstimate;
            if (++lostInARow > 10)
                keep(current, step, {});
            return step;
        }
        step.estimate = (Transformation2D(referenceEstimate) * found.pose).pose();
        step.pairs = found.pairs.size();
        step.area = errors.area(found.pairs, reference, current, found.pose);
        const Transformation2D motion =
            Transformation2D(referenceTruth).inverse() * Transformation2D(step.truth);
        step.error = vectorlib::MatchErrors::ofMotion(found.pose, motion);
        step.publishedError =
            vectorlib::MatchErrors::ofStep(referenceEstimate, step.estimate, referenceTruth, step.truth);
        keep(current, step, found.pairs);
        return step;
    }
    void keep(const std::vector<vectorlib::TypedSegment> &current, const RelationStep &step,
              const std::vector<vectorlib::CorrespondencePair> &pairs) {
        map.update(pairs, current, Transformation2D(step.estimate));
        reference = current;
        referenceEstimate = step.estimate;
        referenceTruth = step.truth;
        lostInARow = 0;
    }
};

/// A figure of every matched step but the first.
template <typename Take>
std::vector<double> ofMatched(const RelationRun &run, Take take) {
    std::vector<double> values;
    for (std::size_t i = 1; i < run.steps.size(); ++i)
        if (run.steps[i].outcome == vectorlib::RelationOutcome::Matched)
            values.push_back(take(run.steps[i]));
    return values;
}

Plot errorPlot(const RelationRun &run, const std::string &name, const std::string &title,
               const std::string &unit, double (*take)(const RelationStep &)) {
    Curve curve{"", "#0072b2", {}};
    for (std::size_t i = 1; i < run.steps.size(); ++i)
        curve.points.emplace_back(double(i), run.steps[i].outcome == vectorlib::RelationOutcome::Matched
                                                 ? take(run.steps[i])
                                                 : std::numeric_limits<double>::quiet_NaN());
    return {name, title, "scan", unit, false, false, {curve}};
}

} // namespace

std::size_t RelationRun::lost() const {
    return std::size_t(std::count_if(steps.begin(), steps.end(), [](const RelationStep &s) {
        return s.outcome != vectorlib::RelationOutcome::Matched;
    }));
}

std::size_t RelationRun::wrong() const {
    return std::size_t(std::count_if(steps.begin(), steps.end(), [](const RelationStep &s) {
        return s.error.translation > 0.5 || s.error.rotation * degrees > 10;
    }));
}

RelationRun relationRun(const std::vector<PosedScan> &scans, const RelationRunOptions &options) {
    RelationRun run;
    Runner runner;
    runner.extract.setScanner(options.fieldOfView, options.rays);
    for (std::size_t i = 0; i < scans.size(); ++i) {
        RelationStep step = i == 0 ? runner.first(scans[i]) : runner.next(scans[i]);
        step.globalError = vectorlib::MatchErrors::ofPose(step.estimate, step.truth);
        if (i > 0)
            run.length +=
                std::hypot(scans[i].pose.x - scans[i - 1].pose.x, scans[i].pose.y - scans[i - 1].pose.y);
        run.steps.push_back(step);
        if (options.progress)
            options.progress(i + 1, scans.size());
    }
    runner.map.map().forEach([&](const vectorlib::MapEdge &edge) { run.map.push_back(edge.segment); });
    return run;
}

nlohmann::ordered_json summaryOf(const RelationRun &run, const nlohmann::ordered_json &published) {
    const auto metres = ofMatched(run, [](const RelationStep &s) { return s.error.translation; });
    const auto turns = ofMatched(run, [](const RelationStep &s) { return s.error.rotation * degrees; });
    const auto times = ofMatched(run, [](const RelationStep &s) { return s.microseconds; });
    const auto percents = ofMatched(run, [](const RelationStep &s) { return s.area.percent(); });
    const auto most = [](const std::vector<double> &v) { return *std::max_element(v.begin(), v.end()); };
    // Of no scan that matched there is no error: null.
    const auto told = [](const std::vector<double> &v, auto take) {
        return v.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(take(v));
    };
    nlohmann::ordered_json result = {{"scans", run.steps.size()},
                                     {"length_m", run.length},
                                     {"matched", times.size()},
                                     {"lost", run.lost()},
                                     {"wrong", run.wrong()},
                                     {"mean_error_m", told(metres, mean)},
                                     {"median_error_m", told(metres, median)},
                                     {"largest_error_m", told(metres, most)},
                                     {"mean_error_deg", told(turns, mean)},
                                     {"median_error_deg", told(turns, median)},
                                     {"largest_error_deg", told(turns, most)},
                                     {"mean_error_area_percent", told(percents, mean)},
                                     {"median_us", told(times, median)},
                                     {"mean_us", told(times, mean)},
                                     {"map_segments", run.map.size()}};
    if (!run.steps.empty()) {
        const RelationStep &last = run.steps.back();
        result["last_error_x_m"] = last.estimate.x - last.truth.x;
        result["last_error_y_m"] = last.estimate.y - last.truth.y;
        result["last_error_deg"] = vectorlib::wrapAngle(last.estimate.theta - last.truth.theta) * degrees;
    }
    if (!published.empty())
        result["published"] = published;
    return result;
}

void writeCsv(std::ostream &out, const RelationRun &run) {
    using vectorlib::Number;
    out << "scan,matched,x,y,theta_deg,true_x,true_y,true_theta_deg,error_m,error_deg,published_error_m,"
           "global_error_m,global_error_deg,error_area_m2,error_area_percent,segments,pairs,time_us\n";
    for (std::size_t i = 0; i < run.steps.size(); ++i) {
        const RelationStep &s = run.steps[i];
        out << i << ',' << (s.outcome == vectorlib::RelationOutcome::Matched);
        for (const Pose2D &p : {s.estimate, s.truth})
            out << ',' << Number(p.x) << ',' << Number(p.y) << ',' << Number(p.theta * degrees);
        for (double v :
             {s.error.translation, s.error.rotation * degrees, s.publishedError.translation,
              s.globalError.translation, s.globalError.rotation * degrees, s.area.error, s.area.percent()})
            out << ',' << Number(v);
        out << ',' << s.segments << ',' << s.pairs << ',' << Number(s.microseconds) << '\n';
    }
}

vectorlib::SvgPicture pictureOfWays(const RelationRun &run) {
    namespace colour = vectorlib::colour;
    vectorlib::SvgPicture picture("map and ways");
    picture.segments({colour::map, 1.5, "map"}, run.map);
    std::vector<vectorlib::Vector2D<double>> truth, estimate;
    for (const RelationStep &step : run.steps) {
        truth.emplace_back(step.truth.x, step.truth.y);
        estimate.emplace_back(step.estimate.x, step.estimate.y);
    }
    picture.path({colour::reference, 2, "true way"}, truth);
    picture.path({colour::estimate, 1.2, "estimated way"}, estimate);
    return picture;
}

std::vector<Plot> plotsOf(const RelationRun &run) {
    return {errorPlot(run, "rotation", "rotational error of consecutive scans", "error [deg]",
                      [](const RelationStep &s) { return s.error.rotation * degrees; }),
            errorPlot(run, "translation", "translational error of consecutive scans", "error [m]",
                      [](const RelationStep &s) { return s.error.translation; }),
            errorPlot(run, "global-rotation", "global rotational error", "error [deg]",
                      [](const RelationStep &s) { return s.globalError.rotation * degrees; }),
            errorPlot(run, "global-translation", "global translational error", "error [m]",
                      [](const RelationStep &s) { return s.globalError.translation; }),
            errorPlot(run, "area", "error area percentage", "error area [%]",
                      [](const RelationStep &s) { return s.area.percent(); })};
}

} // namespace hermes::experiments
