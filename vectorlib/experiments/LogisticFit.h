#pragma once

#include <Eigen/Cholesky>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace hermes::experiments {

/// The weights of the least loss, by Newton's method: `loss` of weights, `step` from them to the least loss,
/// were it a parabola. A step too far is halved until the loss is no greater.
template <typename Weights, typename Loss, typename Step>
Weights leastLoss(Weights weights, Loss loss, Step step) {
    double least = loss(weights);
    for (int steps = 0; steps < 100; ++steps) {
        Weights next = step(weights);
        double there = loss(weights + next);
        while (!(there <= least) && next.norm() > 1e-9) {
            next /= 2;
            there = loss(weights + next);
        }
        if (!(there <= least))
            break;
        weights += next;
        least = there;
    }
    return weights;
}

/// What tells whether something is right, and whether it is.
template <std::size_t Count>
struct LogisticCase {
    std::array<double, Count> features;
    bool right;
};

/// Mean of -ln of the probability that is told of what was the case; 0 of no cases. `probability` is that of
/// features.
template <std::size_t Count, typename Probability>
double logisticLoss(const std::vector<LogisticCase<Count>> &cases, Probability probability) {
    double sum = 0;
    for (const LogisticCase<Count> &c : cases) {
        const double p = probability(c.features);
        sum -= std::log(std::max(1e-12, c.right ? p : 1 - p));
    }
    return cases.empty() ? 0 : sum / double(cases.size());
}

/// The likeliest weights of the features in a logistic function below a ceiling, by Fisher's scoring, with a
/// weak pull towards 0 that keeps them finite.
template <std::size_t Count>
std::array<double, Count> logisticFit(const std::vector<LogisticCase<Count>> &cases, double ceiling) {
    constexpr double pull = 1e-3;
    using Weights = Eigen::Matrix<double, int(Count), 1>;
    using Matrix = Eigen::Matrix<double, int(Count), int(Count)>;
    const auto featuresOf = [](const LogisticCase<Count> &c) {
        return Eigen::Map<const Weights>(c.features.data());
    };
    const auto sigmoid = [](double sum) { return 1 / (1 + std::exp(-sum)); };
    const auto loss = [&](const Weights &weights) {
        const auto probability = [&](const std::array<double, Count> &f) {
            return ceiling * sigmoid(weights.dot(Eigen::Map<const Weights>(f.data())));
        };
        return double(cases.size()) * logisticLoss(cases, probability) + pull / 2 * weights.squaredNorm();
    };
    const auto step = [&](const Weights &weights) -> Weights {
        Matrix h = pull * Matrix::Identity();
        Weights g = -pull * weights;
        for (const LogisticCase<Count> &c : cases) {
            const double s = sigmoid(weights.dot(featuresOf(c))), p = ceiling * s;
            const double slope = p * (1 - s), spread = std::max(1e-12, p * (1 - p));
            g += slope * (c.right - p) / spread * featuresOf(c);
            h += slope * slope / spread * featuresOf(c) * featuresOf(c).transpose();
        }
        return h.ldlt().solve(g);
    };
    std::array<double, Count> fitted;
    Eigen::Map<Weights>(fitted.data()) = leastLoss<Weights>(Weights::Zero(), loss, step);
    return fitted;
}

} // namespace hermes::experiments
