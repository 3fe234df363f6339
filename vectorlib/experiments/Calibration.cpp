#include "vectorlib/experiments/Calibration.h"

#include "vectorlib/experiments/LogisticFit.h"
#include "vectorlib/io/Number.h"

namespace hermes::experiments {

using vectorlib::GlobalPairSolution;
using vectorlib::MatchProbability;

namespace {

bool isRight(const GlobalPairResult &pair, const GlobalPairSolution &s) {
    return pair.isWithin(s.pose, 0.10);
}

/// What tells of a pair with solutions whether the right one is among them, and whether it is.
using AnyCase = LogisticCase<std::tuple_size<MatchProbability::Features>::value>;

std::vector<AnyCase> anyCases(const std::vector<GlobalPairResult> &pairs) {
    std::vector<AnyCase> cases;
    for (const GlobalPairResult &pair : pairs) {
        const auto &solutions = pair.match.solutions;
        if (solutions.empty())
            continue;
        cases.push_back({MatchProbability::features(pair.match),
                         std::any_of(solutions.begin(), solutions.end(),
                                     [&](const auto &s) { return isRight(pair, s); })});
    }
    return cases;
}

/// The likeliest weights and ceiling.
void fitAny(const std::vector<GlobalPairResult> &pairs, MatchProbability &fitted) {
    const std::vector<AnyCase> cases = anyCases(pairs);
    double least = 1e300;
    for (int thousandths = 900; thousandths <= 1000; thousandths += 2) {
        MatchProbability candidate = fitted;
        candidate.ceiling = thousandths / 1000.0;
        candidate.weights = logisticFit(cases, candidate.ceiling);
        const double loss =
            logisticLoss(cases, [&](const MatchProbability::Features &f) { return candidate.ofAny(f); });
        if (loss < least) {
            least = loss;
            fitted = candidate;
        }
    }
}

/// With which the right solutions have the greatest share of the powers of all fits.
double fittedSharpness(const std::vector<GlobalPairResult> &pairs) {
    double best = 1, most = -1e300;
    for (double sharpness = 4; sharpness < 400; sharpness *= 1.02) {
        double sum = 0;
        for (const GlobalPairResult &pair : pairs) {
            double right = 0, all = 0;
            for (const GlobalPairSolution &s : pair.match.solutions) {
                const double power = std::exp(sharpness * MatchProbability::fit(s));
                all += power;
                right += isRight(pair, s) ? power : 0;
            }
            if (right > 0)
                sum += std::log(right / all);
        }
        if (sum > most) {
            most = sum;
            best = sharpness;
        }
    }
    return best;
}

nlohmann::ordered_json jsonOf(const CalibrationTenths &tenths) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const CalibrationTenth &t : tenths)
        list.push_back({{"solutions", t.solutions}, {"told", t.told}, {"right", t.right}});
    return list;
}

} // namespace

void add(CalibrationTenths &tenths, double probability, bool right) {
    CalibrationTenth &t = tenths[std::size_t(std::clamp(probability * 10, 0.0, 9.0))];
    ++t.solutions;
    t.told += probability;
    t.right += right;
}

void toMeans(CalibrationTenths &tenths) {
    for (CalibrationTenth &t : tenths)
        if (t.solutions > 0) {
            t.told /= double(t.solutions);
            t.right /= double(t.solutions);
        }
}

Calibration calibrationOf(const std::vector<GlobalPairResult> &pairs) {
    Calibration c;
    for (const GlobalPairResult &pair : pairs)
        for (const GlobalPairSolution &s : pair.match.solutions) {
            add(c.all, s.probability, isRight(pair, s));
            if (&s == &pair.match.solutions[0])
                add(c.best, s.probability, isRight(pair, s));
        }
    toMeans(c.best);
    toMeans(c.all);
    fitAny(pairs, c.fitted);
    c.fitted.sharpness = fittedSharpness(pairs);
    return c;
}

nlohmann::ordered_json summaryOf(const Calibration &calibration) {
    return {{"best", jsonOf(calibration.best)},
            {"all", jsonOf(calibration.all)},
            {"fitted_weights", calibration.fitted.weights},
            {"fitted_ceiling", calibration.fitted.ceiling},
            {"fitted_sharpness", calibration.fitted.sharpness}};
}

void writeCsv(std::ostream &out, const Calibration &calibration) {
    using vectorlib::Number;
    out << "of,from,solutions,told,right\n";
    const auto write = [&out](const char *of, const CalibrationTenths &tenths) {
        for (std::size_t i = 0; i < tenths.size(); ++i)
            out << of << ',' << Number(double(i) / 10) << ',' << tenths[i].solutions << ','
                << Number(tenths[i].told) << ',' << Number(tenths[i].right) << '\n';
    };
    write("best", calibration.best);
    write("all", calibration.all);
}

Plot plotOf(const Calibration &calibration) {
    const auto curve = [](const char *label, const char *colour, const CalibrationTenths &tenths) {
        Curve c{label, colour, {}};
        for (const CalibrationTenth &t : tenths)
            if (t.solutions >= 20)
                c.points.emplace_back(t.told, t.right);
        return c;
    };
    return {"diagram",
            "matches without estimate: probability told, and share that is right",
            "probability told",
            "share within 10 cm and 2 degrees",
            false,
            false,
            {{"as it should be", "#999999", {{0, 0}, {1, 1}}},
             curve("best solutions", "#1b2a41", calibration.best),
             curve("all solutions", "#009e73", calibration.all)}};
}

} // namespace hermes::experiments
