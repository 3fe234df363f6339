#include "vectorlib/experiments/ThresholdExperiment.h"

#include "vectorlib/vectorization/AftlsVectorizer.h"
#include "vectorlib/vectorization/IncVectorizer.h"
#include "vectorlib/vectorization/OptimalVectorizer.h"

#include <random>

namespace hermes::experiments {

namespace {

using vectorlib::Number;
using ExactPoint = vectorlib::Vector2D<double>;

// The free side of both edges is on their left: the corner is as a scanner in a room sees it.
ExactPoint cornerPoint(std::size_t i) {
    const double step = 1.0 / static_cast<double>(ThresholdExperiment::corner);
    return i < ThresholdExperiment::corner
               ? ExactPoint(1, -1 + step * static_cast<double>(i))
               : ExactPoint(1 - step * static_cast<double>(i - ThresholdExperiment::corner), 0);
}

std::vector<double> errorsOf(const std::vector<ExactPoint> &points) {
    vectorlib::PrefixSums sums;
    sums.assign(vectorlib::PointSpan<double>(points));
    std::vector<double> errors;
    for (std::size_t n = 2; n <= points.size(); ++n)
        errors.push_back(std::sqrt(vectorlib::fitLine(sums.sums(0, n)).variance));
    return errors;
}

// How often the error falls although a point of the first edge was added.
std::size_t fallsBeforeCorner(const std::vector<double> &errors) {
    std::size_t falls = 0;
    for (std::size_t n = 3; n <= ThresholdExperiment::corner; ++n)
        falls += errors[n - 2] < errors[n - 3];
    return falls;
}

bool growsAfterCorner(const std::vector<double> &errors) {
    for (std::size_t n = ThresholdExperiment::corner + 2; n <= 2 * ThresholdExperiment::corner; ++n)
        if (errors[n - 2] <= errors[n - 3])
            return false;
    return true;
}

// The most points of which the error keeps the threshold.
std::size_t longest(const std::vector<double> &errors) {
    std::size_t n = errors.size() + 1;
    while (n > 2 && errors[n - 2] > ThresholdExperiment::threshold)
        --n;
    return n;
}

} // namespace

ThresholdExperiment::ThresholdExperiment(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal(0, noise);
    for (std::size_t i = 0; i < 2 * corner; ++i) {
        precise_.push_back(cornerPoint(i));
        const double x = normal(random), y = normal(random);
        noised_.push_back(precise_.back() + ExactPoint(x, y));
    }
    preciseErrors_ = errorsOf(precise_);
    noisedErrors_ = errorsOf(noised_);
    const auto add = [this](const char *name, auto &vectorize) {
        Vectorization v{name, {}, 0, 0, 0};
        double squares = 0;
        for (const vectorlib::VectorizedLine &line : vectorize(noised_)) {
            v.segments.push_back(line.segment);
            if (v.segments.size() == 2)
                v.breakPoint = line.first;
            squares += vectorlib::sumOfSquares(line.sums);
        }
        const ExactPoint first = v.segments.front().direction();
        v.turned = std::abs(std::atan2(first.x, first.y)) * 180 / vectorlib::pi;
        v.rms = std::sqrt(squares / static_cast<double>(noised_.size()));
        vectorizations_.push_back(v);
    };
    const vectorlib::VectorizerSettings settings{threshold, 5 * threshold, true};
    vectorlib::IncVectorizer<double> inc;
    vectorlib::FtlsVectorizer<double> ftls;
    vectorlib::AftlsVectorizer<double> aftls;
    vectorlib::OptimalVectorizer<double> optimal;
    inc.settings = ftls.settings = aftls.settings = optimal.settings = settings;
    optimal.lines = 2;
    add("INC", inc);
    add("FTLS", ftls);
    add("AFTLS", aftls);
    add("optimum", optimal);
}

void ThresholdExperiment::writeCsv(std::ostream &out) const {
    out << "points,sigma_precise_m,sigma_noised_m\n";
    for (std::size_t i = 0; i < preciseErrors_.size(); ++i)
        out << i + 2 << ',' << Number(preciseErrors_[i]) << ',' << Number(noisedErrors_[i]) << '\n';
}

Plot ThresholdExperiment::errorPlot() const {
    Plot plot{"error", "sigma of the first points from their line", "points", "sigma [cm]", false, false, {}};
    Curve precise{"precise corner", "#000000", {}}, noised{"with noise", "#2e9e3f", {}},
        limit{"threshold", "#d62828", {}};
    for (std::size_t i = 0; i < preciseErrors_.size(); ++i) {
        const double n = static_cast<double>(i + 2);
        precise.points.emplace_back(n, 100 * preciseErrors_[i]);
        noised.points.emplace_back(n, 100 * noisedErrors_[i]);
        limit.points.emplace_back(n, 100 * threshold);
    }
    plot.curves = {precise, noised, limit};
    return plot;
}

vectorlib::SvgPicture ThresholdExperiment::pictureOfClouds() const {
    vectorlib::SvgPicture picture("a sharp corner of " + std::to_string(precise_.size()) +
                                  " points, precise and with noise");
    picture.points({"#000000", 5, "precise"}, precise_);
    picture.points({"#2e9e3f", 5, "with noise of 2 cm in both coordinates"}, noised_);
    return picture;
}

vectorlib::SvgPicture ThresholdExperiment::pictureOfLines() const {
    vectorlib::SvgPicture picture("the corner with noise, vectorized with a threshold of 4 cm");
    picture.points({vectorlib::colour::points, 5, "points"}, noised_);
    picture.segments({"#000000", 2.5, "suboptimal: INC"}, vectorizations_.front().segments);
    picture.segments({"#2e9e3f", 2.5, "optimal: least error of two lines"}, vectorizations_.back().segments);
    return picture;
}

nlohmann::ordered_json ThresholdExperiment::summary() const {
    nlohmann::ordered_json json;
    json["corner_point"] = corner;
    for (const auto &[name, errors] :
         {std::pair("precise", &preciseErrors_), std::pair("noised", &noisedErrors_)})
        json[name] = {{"sigma_at_corner_m", (*errors)[corner - 2]},
                      {"falls_before_corner", fallsBeforeCorner(*errors)},
                      {"grows_after_corner", growsAfterCorner(*errors)},
                      {"points_within_threshold", longest(*errors)}};
    for (const Vectorization &v : vectorizations_)
        json["vectorizations"][v.name] = {{"lines", v.segments.size()},
                                          {"break_point", v.breakPoint},
                                          {"rms_m", v.rms},
                                          {"first_line_turned_deg", v.turned}};
    return json;
}

} // namespace hermes::experiments
