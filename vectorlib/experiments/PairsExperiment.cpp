#include "vectorlib/experiments/PairsExperiment.h"

#include "vectorlib/io/Number.h"
#include "vectorlib/io/Svg.h"

#include <algorithm>
#include <chrono>
#include <iomanip>
#include <sstream>

namespace hermes::experiments {

using vector::quantile;

using vectorlib::Transformation2D;

std::vector<std::size_t> PairsOptions::pairsOf(const vectorlib::CarmenLog &log) const {
    const std::size_t possible = log.scans.empty() ? 0 : (log.scans.size() - 1) / every;
    const std::size_t count = first > 0 ? std::min(first, possible) : possible;
    std::vector<std::size_t> list;
    for (std::size_t i = 0; i < count; ++i) {
        const PairHalf own = i / 50 % 2 == 0 ? PairHalf::First : PairHalf::Second;
        if (half == PairHalf::Both || half == own)
            list.push_back(i * every);
    }
    return list;
}

double LogPair::errorMetres(const Transformation2D &motion) const {
    return (motion.translation() - reference.translation()).norm();
}

double LogPair::errorDegrees(const Transformation2D &motion) const {
    return std::abs((reference.inverse() * motion).alpha()) * 180 / vectorlib::pi;
}

bool LogPair::isWithin(const Transformation2D &motion, double metres) const {
    return errorMetres(motion) <= metres && errorDegrees(motion) <= 2;
}

bool LogPair::isWrong(const Transformation2D &motion) const {
    return errorMetres(motion) > 0.5 || errorDegrees(motion) > 10;
}

ScanPoints pointsOf(const vectorlib::CarmenScan &scan) {
    ScanPoints points;
    scan.appendPoints(points);
    return points;
}

std::vector<PairResult> pairsExperiment(const vectorlib::CarmenLog &log, const PairsOptions &options) {
    using Clock = std::chrono::steady_clock;
    const std::vector<std::size_t> pairs = options.pairsOf(log);
    vectorlib::ScanPairMatcher match;
    std::vector<PairResult> results;
    for (const std::size_t from : pairs) {
        PairResult r;
        r.from = from;
        r.to = from + options.every;
        const vectorlib::CarmenScan &first = log.scans[r.from], &second = log.scans[r.to];
        const auto odometry = log.odometryMotion(r.from, r.to, vectorlib::CarmenOdometryKind::Corrected);
        r.expected = odometry.value_or(Transformation2D());
        r.reference = log.referenceMotion(r.from, r.to);
        match.settings =
            odometry ? vectorlib::ScanPairSettings() : vectorlib::ScanPairSettings::forPoorExpectation();
        match.extract.segment.settings = vectorlib::EarSettings::forScanner(
            first.angleStep * double(first.ranges.size()), first.ranges.size());
        const ScanPoints fixed = pointsOf(first), moving = pointsOf(second);
        const auto begin = Clock::now();
        const vectorlib::ScanPairMatch &found = match(fixed, moving, r.expected);
        r.microseconds = std::chrono::duration<double, std::micro>(Clock::now() - begin).count();
        r.match = found;
        results.push_back(r);
        if (options.progress)
            options.progress(results.size(), pairs.size());
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
    return {{"pairs", pairs.size()},
            {"within_10cm_2deg", share([](const PairResult &p) { return p.isWithin(p.match.pose, 0.10); })},
            {"within_5cm_2deg", share([](const PairResult &p) { return p.isWithin(p.match.pose, 0.05); })},
            {"accepted", share([](const PairResult &p) { return p.match.accepted; })},
            {"accepted_wrong",
             share([](const PairResult &p) { return p.match.accepted && p.isWrong(p.match.pose); })},
            {"lines_do_not_suffice", share([](const PairResult &p) { return !p.match.linesSuffice; })},
            {"lines_alone_within_10cm_2deg",
             share([](const PairResult &p) { return p.isWithin(p.match.byLines, 0.10); })},
            {"odometry_within_10cm_2deg",
             share([](const PairResult &p) { return p.isWithin(p.expected, 0.10); })},
            {"searched_again", share([](const PairResult &p) { return p.match.searchedAgain; })},
            {"median_us", quantile(std::move(times), 0.5)}};
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
            << Number(p.match.agreement.contradicted()) << ','
            << Number(p.match.agreement.walls().reliability()) << ',' << p.match.linesSuffice << ','
            << p.match.searchedAgain << ',' << Number(p.microseconds) << '\n';
    }
}

void draw(std::ostream &svg, const vectorlib::CarmenLog &log, const LogPair &pair,
          const Transformation2D &found) {
    const ScanPoints second = pointsOf(log.scans[pair.to]);
    const auto moved = [&](const Transformation2D &motion) {
        ScanPoints points;
        for (const auto &p : second)
            points.push_back(motion * p);
        return points;
    };
    const auto rounded = [](double v, int digits) {
        std::ostringstream text;
        text << std::fixed << std::setprecision(digits) << v;
        return text.str();
    };
    vectorlib::SvgPicture picture("scans " + std::to_string(pair.from) + " and " + std::to_string(pair.to) +
                                  ": " + rounded(100 * pair.errorMetres(found), 0) + " cm and " +
                                  rounded(pair.errorDegrees(found), 1) + " degrees from the reference");
    picture.points({vectorlib::colour::reference, 3, "second scan by the reference"}, moved(pair.reference));
    picture.points({vectorlib::colour::points, 3, "first scan"}, pointsOf(log.scans[pair.from]));
    picture.points({vectorlib::colour::estimate, 3, "second scan as matched"}, moved(found));
    picture.pose({vectorlib::colour::points, 2, ""}, {0, 0}, 0);
    picture.pose({vectorlib::colour::estimate, 2, ""}, {found.x(), found.y()}, found.alpha());
    picture.write(svg);
}

} // namespace hermes::experiments
