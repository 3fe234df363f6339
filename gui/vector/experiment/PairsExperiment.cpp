#include "gui/vector/experiment/PairsExperiment.h"

#include "vectorlib/io/Number.h"
#include "vectorlib/io/Svg.h"

#include <algorithm>
#include <chrono>

namespace hermes::vector {

using vectorlib::Transformation2D;

namespace {

using Points = std::vector<vectorlib::Vector2D<float>>;

Points pointsOf(const vectorlib::CarmenScan &scan) {
    Points points;
    scan.appendPoints(points);
    return points;
}

} // namespace

double PairResult::errorMetres(const Transformation2D &motion) const {
    return (motion.translation() - reference.translation()).norm();
}

double PairResult::errorDegrees(const Transformation2D &motion) const {
    return std::abs((reference.inverse() * motion).alpha()) * 180 / vectorlib::pi;
}

bool PairResult::isWithin(const Transformation2D &motion, double metres) const {
    return errorMetres(motion) <= metres && errorDegrees(motion) <= 2;
}

bool PairResult::isWrong() const {
    return errorMetres(match.pose) > 0.5 || errorDegrees(match.pose) > 10;
}

std::vector<PairResult> pairsExperiment(const vectorlib::CarmenLog &log, const PairsOptions &options) {
    using Clock = std::chrono::steady_clock;
    const std::size_t possible = log.scans.empty() ? 0 : (log.scans.size() - 1) / options.every;
    const std::size_t count = options.first > 0 ? std::min(options.first, possible) : possible;
    vectorlib::ScanPairMatcher match;
    std::vector<PairResult> results;
    for (std::size_t i = 0; i < count; ++i) {
        PairResult r;
        r.from = i * options.every;
        r.to = r.from + options.every;
        const vectorlib::CarmenScan &first = log.scans[r.from], &second = log.scans[r.to];
        const auto odometry = log.odometryMotion(r.from, r.to, vectorlib::CarmenOdometryKind::Corrected);
        r.expected = odometry.value_or(Transformation2D());
        r.reference = log.referenceMotion(r.from, r.to);
        match.settings =
            odometry ? vectorlib::ScanPairSettings() : vectorlib::ScanPairSettings::forPoorExpectation();
        match.extract.segment.settings = vectorlib::EarSettings::forScanner(
            first.angleStep * double(first.ranges.size()), first.ranges.size());
        const Points fixed = pointsOf(first), moving = pointsOf(second);
        const auto begin = Clock::now();
        const vectorlib::ScanPairMatch &found = match(fixed, moving, r.expected);
        r.microseconds = std::chrono::duration<double, std::micro>(Clock::now() - begin).count();
        r.match = found;
        results.push_back(r);
        if (options.progress)
            options.progress(i + 1, count);
    }
    return results;
}

nlohmann::ordered_json summaryOf(const std::vector<PairResult> &pairs) {
    if (pairs.empty())
        return {{"pairs", 0}};
    const auto share = [&](auto holds) {
        return double(std::count_if(pairs.begin(), pairs.end(), holds)) / double(pairs.size());
    };
    std::vector<double> times;
    for (const PairResult &p : pairs)
        times.push_back(p.microseconds);
    const auto middle = times.begin() + std::ptrdiff_t(times.size() / 2);
    std::nth_element(times.begin(), middle, times.end());
    return {{"pairs", pairs.size()},
            {"within_10cm_2deg", share([](const PairResult &p) { return p.isWithin(p.match.pose, 0.10); })},
            {"within_5cm_2deg", share([](const PairResult &p) { return p.isWithin(p.match.pose, 0.05); })},
            {"accepted", share([](const PairResult &p) { return p.match.accepted; })},
            {"accepted_wrong", share([](const PairResult &p) { return p.match.accepted && p.isWrong(); })},
            {"lines_do_not_suffice", share([](const PairResult &p) { return !p.match.linesSuffice; })},
            {"lines_alone_within_10cm_2deg",
             share([](const PairResult &p) { return p.isWithin(p.match.byLines, 0.10); })},
            {"odometry_within_10cm_2deg",
             share([](const PairResult &p) { return p.isWithin(p.expected, 0.10); })},
            {"searched_again", share([](const PairResult &p) { return p.match.searchedAgain; })},
            {"median_us", *middle}};
}

void writeCsv(std::ostream &out, const std::vector<PairResult> &pairs) {
    using vectorlib::Number;
    out << "from,to,error_m,error_deg,lines_error_m,lines_error_deg,odometry_error_m,odometry_error_deg,"
           "accepted,explained,contradicted,reliability,lines_suffice,searched_again,time_us\n";
    for (const PairResult &p : pairs) {
        out << p.from << ',' << p.to;
        for (const Transformation2D &motion : {p.match.pose, p.match.byLines, p.expected})
            out << ',' << Number(p.errorMetres(motion)) << ',' << Number(p.errorDegrees(motion));
        out << ',' << p.match.accepted << ',' << Number(p.match.agreement.explained()) << ','
            << Number(p.match.agreement.contradicted()) << ',' << Number(p.match.agreement.reliability())
            << ',' << p.match.linesSuffice << ',' << p.match.searchedAgain << ',' << Number(p.microseconds)
            << '\n';
    }
}

void draw(std::ostream &svg, const vectorlib::CarmenLog &log, const PairResult &pair) {
    const Points second = pointsOf(log.scans[pair.to]);
    const auto moved = [&](const Transformation2D &motion) {
        Points points;
        for (const auto &p : second)
            points.push_back(motion * p);
        return points;
    };
    const auto hundredths = [](double v) { return std::to_string(std::lround(100 * v)); };
    vectorlib::SvgPicture picture("scans " + std::to_string(pair.from) + " and " + std::to_string(pair.to) +
                                  ": " + hundredths(pair.errorMetres(pair.match.pose)) + " cm and " +
                                  hundredths(pair.errorDegrees(pair.match.pose)) +
                                  " hundredths of a degree from the reference");
    picture.points({vectorlib::colour::reference, 3, "second scan by the reference"}, moved(pair.reference));
    picture.points({vectorlib::colour::points, 3, "first scan"}, pointsOf(log.scans[pair.from]));
    picture.points({vectorlib::colour::estimate, 3, "second scan as matched"}, moved(pair.match.pose));
    picture.pose({vectorlib::colour::points, 2, ""}, {0, 0}, 0);
    picture.pose({vectorlib::colour::estimate, 2, ""}, {pair.match.pose.x(), pair.match.pose.y()},
                 pair.match.pose.alpha());
    picture.write(svg);
}

} // namespace hermes::vector
