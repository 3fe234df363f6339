#include "vectorlib/experiments/GlobalPairsExperiment.h"

#include "vectorlib/experiments/ProcessorTime.h"
#include "vectorlib/io/Number.h"

#include <algorithm>

namespace hermes::experiments {

using vector::quantile;

using vectorlib::GlobalPairVerdict;
using vectorlib::Transformation2D;

Transformation2D GlobalPairResult::best() const {
    return match.solutions.empty() ? Transformation2D() : match.solutions[0].pose;
}

double GlobalPairResult::probability() const {
    return match.solutions.empty() ? 0 : match.solutions[0].probability;
}

std::vector<GlobalPairResult> globalPairsExperiment(const vectorlib::CarmenLog &log,
                                                    const PairsOptions &options) {
    const std::vector<std::size_t> pairs = options.pairsOf(log);
    vectorlib::GlobalPairMatcher match;
    std::vector<GlobalPairResult> results;
    for (const std::size_t from : pairs) {
        GlobalPairResult r;
        r.from = from;
        r.to = from + options.every;
        r.reference = log.referenceMotion(r.from, r.to);
        const ScanPoints fixed = pointsOf(log.scans[r.from]), moving = pointsOf(log.scans[r.to]);
        const double begin = processorMicroseconds();
        const vectorlib::GlobalPairMatch &found = match(fixed, moving);
        r.microseconds = processorMicroseconds() - begin;
        r.match = found;
        results.push_back(std::move(r));
        if (options.progress)
            options.progress(results.size(), pairs.size());
    }
    return results;
}

nlohmann::ordered_json summaryOf(const std::vector<GlobalPairResult> &pairs) {
    if (pairs.empty())
        return {{"pairs", 0}};
    const auto count = [&](auto holds) { return double(std::count_if(pairs.begin(), pairs.end(), holds)); };
    const auto share = [&](auto holds) { return count(holds) / double(pairs.size()); };
    const auto verdicts = [&](GlobalPairVerdict verdict) {
        return share([verdict](const GlobalPairResult &p) { return p.match.verdict == verdict; });
    };
    const double right = count([](const GlobalPairResult &p) { return p.isRight(); });
    const double rightAccepted =
        count([](const GlobalPairResult &p) { return p.isRight() && p.match.isAccepted(); });
    std::vector<double> times;
    for (const GlobalPairResult &p : pairs)
        times.push_back(p.microseconds);
    return {{"pairs", pairs.size()},
            {"within_10cm_2deg", right / double(pairs.size())},
            {"within_5cm_2deg", share([](const GlobalPairResult &p) { return p.isWithin(p.best(), 0.05); })},
            {"accepted", verdicts(GlobalPairVerdict::Found)},
            {"accepted_wrong",
             share([](const GlobalPairResult &p) { return p.match.isAccepted() && p.isWrong(p.best()); })},
            {"accepted_of_right", right > 0 ? rightAccepted / right : 0},
            {"wrong", share([](const GlobalPairResult &p) { return p.isWrong(p.best()); })},
            {"ambiguous", verdicts(GlobalPairVerdict::Ambiguous)},
            {"open_direction", verdicts(GlobalPairVerdict::OpenDirection)},
            {"searched_widely", share([](const GlobalPairResult &p) { return p.match.searchedWidely; })},
            {"median_us", quantile(times, 0.5)},
            {"percentile_99_us", quantile(times, 0.99)}};
}

void writeCsv(std::ostream &out, const std::vector<GlobalPairResult> &pairs) {
    using vectorlib::Number;
    out << "from,to,error_m,error_deg,accepted,verdict,solutions,probability,score,explained,contradicted,"
           "reliability,slide_loss,length_m,searched_widely,time_us\n";
    for (const GlobalPairResult &p : pairs) {
        const vectorlib::SurfaceAgreement agreement =
            p.match.solutions.empty() ? vectorlib::SurfaceAgreement() : p.match.solutions[0].agreement;
        out << p.from << ',' << p.to << ',' << Number(p.errorMetres(p.best())) << ','
            << Number(p.errorDegrees(p.best())) << ',' << p.match.isAccepted() << ",\""
            << describe(p.match.verdict) << "\"," << p.match.solutions.size() << ','
            << Number(p.probability()) << ',' << Number(agreement.score()) << ','
            << Number(agreement.explained()) << ',' << Number(agreement.contradicted()) << ','
            << Number(agreement.walls().reliability()) << ',' << Number(p.match.slideLoss) << ','
            << Number(agreement.length()) << ',' << p.match.searchedWidely << ',' << Number(p.microseconds)
            << '\n';
    }
}

} // namespace hermes::experiments
