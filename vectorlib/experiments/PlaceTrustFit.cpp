#include "vectorlib/experiments/PlaceTrustFit.h"

#include "vectorlib/experiments/LogisticFit.h"

#include <map>

namespace hermes::experiments {

using vectorlib::PlaceTrust;

namespace {

// Constant, score, ahead, rival.
using Weights = Eigen::Vector4d;

constexpr double weightOfOthers = 6;
constexpr double pull = 1e-6; // of the weights towards 0: it keeps them finite

double weightOf(const PlaceTrial &trial) {
    return trial.hasPlace ? 1 : weightOfOthers;
}

// What may be right of a trial: its places, and last none of them. The logarithm of the odds of each to those
// of the first place is linear in the weights; these are its factors.
std::vector<Weights> alternativesOf(const PlaceTrial &trial, const PlaceTrust &trust) {
    std::vector<Weights> all{Weights::Zero()};
    for (std::size_t i = 1; i < trial.leads.size(); ++i)
        all.emplace_back(0, 0, 0, -trust.relativeLead(trial.score, trial.leads[i]));
    all.emplace_back(-1, -trial.score, -trust.clampedLead(trial.leads.front()), 0);
    return all;
}

Weights weightsOf(const PlaceTrust &trust) {
    return {trust.constant, trust.score, trust.ahead, trust.rival};
}

// The probability of each alternative.
std::vector<double> probabilitiesOf(const std::vector<Weights> &alternatives, const Weights &weights) {
    std::vector<double> p;
    double most = 0, sum = 0;
    for (const Weights &f : alternatives) {
        p.push_back(f.dot(weights));
        most = std::max(most, p.back());
    }
    for (double &each : p)
        sum += each = std::exp(each - most);
    for (double &each : p)
        each /= sum;
    return p;
}

double lossOf(const std::vector<PlaceTrial> &trials, const PlaceTrust &trust, const Weights &weights) {
    double loss = pull / 2 * weights.squaredNorm();
    for (const PlaceTrial &trial : trials)
        if (!trial.leads.empty()) {
            const std::vector<double> p = probabilitiesOf(alternativesOf(trial, trust), weights);
            loss -= weightOf(trial) * std::log(p[trial.right.value_or(p.size() - 1)]);
        }
    return loss;
}

// To the least loss, were it a parabola.
Weights newtonStep(const std::vector<PlaceTrial> &trials, const PlaceTrust &trust, const Weights &weights) {
    Eigen::Matrix4d h = pull * Eigen::Matrix4d::Identity();
    Weights g = -pull * weights;
    for (const PlaceTrial &trial : trials) {
        if (trial.leads.empty())
            continue;
        const std::vector<Weights> all = alternativesOf(trial, trust);
        const std::vector<double> p = probabilitiesOf(all, weights);
        Weights mean = Weights::Zero();
        for (std::size_t i = 0; i < all.size(); ++i)
            mean += p[i] * all[i];
        for (std::size_t i = 0; i < all.size(); ++i)
            h += weightOf(trial) * p[i] * (all[i] - mean) * (all[i] - mean).transpose();
        g += weightOf(trial) * (all[trial.right.value_or(all.size() - 1)] - mean);
    }
    return h.ldlt().solve(g);
}

nlohmann::ordered_json jsonOf(const PlaceTrustQuality &quality) {
    nlohmann::ordered_json json = {{"trials", quality.trials},
                                   {"loss", quality.loss},
                                   {"found", double(quality.found) / double(quality.trials)},
                                   {"found_wrong", double(quality.wrong) / double(quality.trials)},
                                   {"wrong", quality.wrong}};
    for (const CalibrationTenth &t : quality.tenths)
        json["tenths"].push_back({{"places", t.solutions}, {"told", t.told}, {"right", t.right}});
    return json;
}

nlohmann::ordered_json jsonOf(const PlaceTrust &trust) {
    return {
        {"constant", trust.constant}, {"score", trust.score}, {"ahead", trust.ahead}, {"rival", trust.rival}};
}

} // namespace

PlaceTrust fittedTrust(const std::vector<PlaceTrial> &trials, PlaceTrust trust) {
    const Weights weights = leastLoss(
        weightsOf(trust), [&](const Weights &w) { return lossOf(trials, trust, w); },
        [&](const Weights &w) { return newtonStep(trials, trust, w); });
    trust.constant = weights(0);
    trust.score = weights(1);
    trust.ahead = weights(2);
    trust.rival = weights(3);
    return trust;
}

PlaceTrustQuality qualityOf(const PlaceTrust &trust, const std::vector<PlaceTrial> &trials) {
    PlaceTrustQuality quality;
    const vectorlib::PlaceSearch search;
    double weight = 0;
    for (const PlaceTrial &trial : trials) {
        ++quality.trials;
        if (trial.leads.empty())
            continue;
        weight += weightOf(trial);
        const std::vector<double> p = probabilitiesOf(alternativesOf(trial, trust), weightsOf(trust));
        quality.loss -= weightOf(trial) * std::log(std::max(1e-12, p[trial.right.value_or(p.size() - 1)]));
        const bool isFound = trial.reliability >= search.minReliability && p[0] >= search.minProbability;
        quality.found += isFound;
        quality.wrong += isFound && !trial.isRight();
        add(quality.tenths, p[0], trial.isRight());
    }
    toMeans(quality.tenths);
    quality.loss /= std::max(1.0, weight);
    return quality;
}

nlohmann::ordered_json trustSummary(const std::vector<PlaceTrial> &trials) {
    std::vector<PlaceTrial> first, second;
    std::map<std::string, std::vector<PlaceTrial>> sets;
    for (const PlaceTrial &t : trials) {
        (t.isFirstHalf ? first : second).push_back(t);
        if (!t.isFirstHalf)
            sets[t.set].push_back(t);
    }
    const PlaceTrust present, fitted = fittedTrust(first, present);
    nlohmann::ordered_json json;
    for (const auto &[name, trust] : {std::pair("present", present), std::pair("fitted", fitted)}) {
        json[name] = {{"weights", jsonOf(trust)}, {"second_half", jsonOf(qualityOf(trust, second))}};
        for (const auto &[set, some] : sets) {
            nlohmann::ordered_json of = jsonOf(qualityOf(trust, some));
            of.erase("tenths");
            json[name]["sets"][set] = of;
        }
    }
    return json;
}

} // namespace hermes::experiments
