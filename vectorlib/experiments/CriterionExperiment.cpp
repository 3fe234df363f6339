#include "vectorlib/experiments/CriterionExperiment.h"

#include "vectorlib/experiments/Timing.h"
#include "vectorlib/io/Number.h"
#include "vectorlib/io/Svg.h"
#include "vectorlib/similarity/EdgeSetComparator.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace hermes::experiments {

namespace {

using Segment = vectorlib::LineSegment2D<double>;
using vectorlib::Transformation2D;

const Segment fixedSegment({0, 0}, {1, 0});

std::vector<double> steps(double first, double last, int count) {
    std::vector<double> values;
    for (int i = 0; i <= count; ++i)
        values.push_back(first + (last - first) * i / count);
    return values;
}

// The criterion of the fixed segment and moving(x, y) for all x and y of the grid.
template <typename Moving>
Surface surface(const SegmentCriterion &criterion, Surface s, Moving moving) {
    s.zAxis = std::string("criterion [") + criterion.unit + ']';
    s.title = std::string(criterion.title) + ": " + s.title;
    for (const double y : s.y)
        for (const double x : s.x)
            s.z.push_back(criterion.of(fixedSegment, moving(x, y)));
    return s;
}

std::vector<vectorlib::SegmentPair> randomPairs(std::size_t count, std::mt19937_64 &random) {
    std::uniform_real_distribution<double> position(-5, 5);
    const auto point = [&] { return vectorlib::Vector2D<double>(position(random), position(random)); };
    std::vector<vectorlib::SegmentPair> pairs;
    for (std::size_t i = 0; i < count; ++i)
        pairs.push_back({Segment(point(), point()), Segment(point(), point()), 1});
    return pairs;
}

} // namespace

std::vector<Surface> criterionSurfaces(const SegmentCriterion &criterion) {
    const std::vector<double> shifts = steps(0, 2, 20), angles = steps(0, 2 * vectorlib::pi, 36),
                              lengths = steps(0.01, 2, 20), small = steps(0.001, 0.05, 20);
    const auto shifted = [](double x) { return Transformation2D(x, 0, 0); };
    const auto turned = [](double theta) { return Transformation2D(0, 0, theta); };
    const auto scaled = [](double length) { return Segment({0, 0}, {length, 0}); };
    const auto shiftedAndTurned = [&](double x, double theta) {
        return turned(theta) * (shifted(x) * fixedSegment);
    };
    const auto scaledAndTurned = [&](double l, double theta) { return turned(theta) * scaled(l); };
    const auto turnedAndShifted = [&](double x, double theta) {
        return shifted(x) * (turned(theta) * fixedSegment);
    };
    const auto scaledAndShifted = [&](double x, double l) {
        return shifted(x) * (turned(vectorlib::pi / 4) * scaled(l));
    };
    const std::string shift = "shift [m]", angle = "angle [rad]", length = "length [m]";
    const auto of = [&](const char *name, const char *title, const std::string &x, const std::string &y,
                        const std::vector<double> &xs, const std::vector<double> &ys, auto moving) {
        return surface(criterion, {name, title, x, y, "", xs, ys, {}}, moving);
    };
    return {of("shift-turn", "shifted, then turned, as in figure 7.3", shift, angle, shifts, angles,
               shiftedAndTurned),
            of("scale-turn", "scaled, then turned, as in figure 7.4", length, angle, lengths, angles,
               scaledAndTurned),
            of("scale-turn-small", "small lengths, as in the sub-plot of 7.4", length, angle, small, angles,
               scaledAndTurned),
            of("turn-shift", "turned, then shifted, as in figure 7.5", shift, angle, shifts, angles,
               turnedAndShifted),
            of("scale-shift", "scaled, turned by 45 degrees, shifted, as in figure 7.6", shift, length,
               shifts, lengths, scaledAndShifted)};
}

std::vector<CriterionTime> criterionTimes(const ExperimentOptions &options) {
    constexpr std::size_t pairCounts[] = {1, 3, 10, 30, 100, 300, 1000};
    constexpr std::size_t counts[] = {1, 2, 3, 5, 10, 20, 30, 50, 100, 300, 1000};
    std::mt19937_64 random(options.seed);
    std::uniform_real_distribution<double> any(-1, 1);
    std::vector<CriterionTime> times;
    for (const std::size_t pairCount : pairCounts) {
        const std::vector<vectorlib::SegmentPair> pairs = randomPairs(pairCount, random);
        std::vector<Transformation2D> transformations;
        for (const std::size_t count : counts) {
            while (transformations.size() < count)
                transformations.emplace_back(any(random), any(random), 3 * any(random));
            CriterionTime time{pairCount, count, 0, 0};
            volatile double result = 0; // so that nothing is left out
            time.pairByPair = timeOf([&] {
                double sum = 0;
                for (const Transformation2D &t : transformations)
                    for (const vectorlib::SegmentPair &p : pairs)
                        sum += vectorlib::areaCriterion(p.fixed, t * p.moving);
                result = sum;
            });
            time.fromSums = timeOf([&] {
                vectorlib::EdgeSetComparator criterion;
                criterion.add(pairs);
                double sum = 0;
                for (const Transformation2D &t : transformations)
                    sum += criterion(t);
                result = sum;
            });
            times.push_back(time);
            if (options.progress)
                options.progress(times.size(), std::size(pairCounts) * std::size(counts));
        }
    }
    return times;
}

void writeCsv(std::ostream &out, const std::vector<Surface> &surfaces, const std::string &value) {
    using vectorlib::Number;
    out << "figure,x,y," << value << '\n';
    for (const Surface &s : surfaces)
        for (std::size_t i = 0; i < s.z.size(); ++i)
            out << s.name << ',' << Number(s.x[i % s.x.size()]) << ',' << Number(s.y[i / s.x.size()]) << ','
                << Number(s.z[i]) << '\n';
}

void writeCsv(std::ostream &out, const std::vector<CriterionTime> &times) {
    using vectorlib::Number;
    out << "pairs,transformations,pair_by_pair_us,from_sums_us,speed_up\n";
    for (const CriterionTime &t : times)
        out << t.pairs << ',' << t.transformations << ',' << Number(t.pairByPair) << ',' << Number(t.fromSums)
            << ',' << Number(t.speedUp()) << '\n';
}

std::vector<BreakEven> breakEvens(const std::vector<CriterionTime> &times) {
    std::vector<BreakEven> found;
    for (std::size_t i = 0; i < times.size(); ++i) {
        const bool isFirst = i == 0 || times[i - 1].pairs != times[i].pairs;
        if (isFirst)
            found.push_back({times[i].pairs, 0});
        if (found.back().transformations > 0 || times[i].speedUp() < 1)
            continue;
        const double high = double(times[i].transformations);
        found.back().transformations = high;
        if (!isFirst) { // between two measured, in logarithms
            const double low = double(times[i - 1].transformations),
                         before = std::log(times[i - 1].speedUp());
            const double share = before / (before - std::log(times[i].speedUp()));
            found.back().transformations = low * std::pow(high / low, share);
        }
    }
    return found;
}

nlohmann::ordered_json summaryOf(const std::vector<CriterionTime> &times) {
    nlohmann::ordered_json json;
    for (const BreakEven &b : breakEvens(times))
        json["break_even_transformations"][std::to_string(b.pairs) + " pairs"] =
            b.transformations > 0 ? nlohmann::ordered_json(b.transformations) : nlohmann::ordered_json();
    for (const CriterionTime &t : times)
        if (t.transformations == 1)
            json["speed_up_of_1_transformation"][std::to_string(t.pairs) + " pairs"] = t.speedUp();
    json["largest_speed_up"] =
        std::max_element(times.begin(), times.end(), [](const CriterionTime &a, const CriterionTime &b) {
            return a.speedUp() < b.speedUp();
        })->speedUp();
    return json;
}

std::vector<Plot> plotsOf(const std::vector<CriterionTime> &times) {
    std::vector<Plot> plots;
    const auto add = [&](const char *name, const char *title, const char *axis, auto quantity) {
        Plot plot{name, title, "transformations", axis, true, true, {}};
        for (const CriterionTime &t : times) {
            const std::string label = std::to_string(t.pairs) + (t.pairs == 1 ? " pair" : " pairs");
            if (plot.curves.empty() || plot.curves.back().label != label)
                plot.curves.push_back({label, vectorlib::colour::distinct(plot.curves.size()), {}});
            plot.curves.back().points.emplace_back(t.transformations, quantity(t));
        }
        plots.push_back(std::move(plot));
    };
    add("pair-by-pair", "figure 7.7: pair by pair", "time [us]",
        [](const CriterionTime &t) { return t.pairByPair; });
    add("from-sums", "figure 7.8: from sums", "time [us]", [](const CriterionTime &t) { return t.fromSums; });
    add("speed-up", "figure 7.9: speed-up", "times as fast",
        [](const CriterionTime &t) { return t.speedUp(); });
    Plot even{"break-even",
              "from how many transformations on the sums pay (published: 1)",
              "pairs",
              "transformations",
              true,
              true,
              {{"", vectorlib::colour::estimate, {}}}};
    for (const BreakEven &b : breakEvens(times))
        even.curves[0].points.emplace_back(double(b.pairs), b.transformations);
    plots.push_back(std::move(even));
    return plots;
}

} // namespace hermes::experiments
