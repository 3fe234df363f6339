#pragma once

#include "vectorlib/tls/TlsFit.h"
#include "vectorlib/vectorization/PrefixSums.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vectorlib {

/// The constrained integer Nelder-Mead search of thesis 6.4 for the break points with the least error E
/// (6.27). A vertex holds b_1 .. b_{L-1}, where b_i is the index of the first point of line i + 1. Every
/// vertex is trimmed so that each line has at least two points (erratum 4). Stops when the simplex has
/// collapsed into one point, or after `rounds` times its dimension. Never worse than where it starts.
class BreakPointSimplex {
public:
    int tau = 10;    ///< the first simplex: how many points earlier each break point is tried (6.30)
    int rounds = 60; ///< iterations, at most, for each break point

    /// Moves `cuts` (0, b_1 .. b_{L-1}, number of points) to better places and returns the sum of squares
    /// there: E N.
    double operator()(const PrefixSums &sums, std::vector<std::size_t> &cuts) {
        dimension_ = cuts.size() - 2;
        count_ = static_cast<long>(cuts.back());
        sums_ = &sums;
        start(cuts);
        for (int i = 0; i < rounds * static_cast<int>(dimension_) && !hasCollapsed(); ++i)
            iterate();
        const Vertex &best = simplex_[order_.front()];
        for (std::size_t i = 0; i < dimension_; ++i)
            cuts[i + 1] = static_cast<std::size_t>(best.at[i]);
        return best.value;
    }

private:
    struct Vertex {
        std::vector<long> at;
        double value = 0;
    };

    // (6.29), (6.30).
    void start(const std::vector<std::size_t> &cuts) {
        if (simplex_.size() < dimension_ + 1)
            simplex_.resize(dimension_ + 1);
        order_.resize(dimension_ + 1);
        const long step = std::max(1L, std::min<long>(tau, static_cast<long>(cuts[1]) - 1));
        for (std::size_t v = 0; v <= dimension_; ++v) {
            Vertex &vertex = simplex_[v];
            vertex.at.resize(dimension_);
            for (std::size_t i = 0; i < dimension_; ++i)
                vertex.at[i] = static_cast<long>(cuts[i + 1]) - (v == i + 1 ? step : 0);
            evaluate(vertex);
            order_[v] = v;
        }
        for (Vertex *vertex : {&reflected_, &tried_})
            vertex->at.resize(dimension_);
        middle_.resize(dimension_);
        sort();
    }
    void iterate() {
        Vertex &worst = simplex_[order_.back()];
        const double best = simplex_[order_.front()].value, second = simplex_[order_[dimension_ - 1]].value;
        for (std::size_t i = 0; i < dimension_; ++i) {
            middle_[i] = 0;
            for (std::size_t v = 0; v < dimension_; ++v)
                middle_[i] += static_cast<double>(simplex_[order_[v]].at[i]);
            middle_[i] /= static_cast<double>(dimension_);
        }
        along(worst, -1, reflected_);
        if (reflected_.value < best) {
            along(worst, -2, tried_);
            std::swap(worst, tried_.value < reflected_.value ? tried_ : reflected_);
        } else if (reflected_.value < second) {
            std::swap(worst, reflected_);
        } else {
            const bool outside = reflected_.value < worst.value;
            along(worst, outside ? -0.5 : 0.5, tried_);
            if (tried_.value < std::min(worst.value, reflected_.value))
                std::swap(worst, tried_);
            else
                shrink();
        }
        sort();
    }
    // The vertex at middle + k (from - middle), rounded.
    void along(const Vertex &from, double k, Vertex &to) {
        for (std::size_t i = 0; i < dimension_; ++i)
            to.at[i] = std::lround(middle_[i] + k * (static_cast<double>(from.at[i]) - middle_[i]));
        evaluate(to);
    }
    void shrink() {
        const Vertex &best = simplex_[order_.front()];
        for (std::size_t v = 1; v <= dimension_; ++v) {
            Vertex &vertex = simplex_[order_[v]];
            for (std::size_t i = 0; i < dimension_; ++i) // towards the best, never away from it
                vertex.at[i] = best.at[i] + (vertex.at[i] - best.at[i]) / 2;
            evaluate(vertex);
        }
    }
    // Trims from the end to the beginning and sums the squares (6.27).
    void evaluate(Vertex &vertex) const {
        long next = count_;
        vertex.value = 0;
        for (std::size_t i = dimension_; i > 0; --i) {
            long &at = vertex.at[i - 1];
            at = std::min(std::max(at, 2 * static_cast<long>(i)), next - 2);
            vertex.value += squares(at, next);
            next = at;
        }
        vertex.value += squares(0, next);
    }
    double squares(long first, long end) const {
        return sumOfSquares(sums_->sums(static_cast<std::size_t>(first), static_cast<std::size_t>(end)));
    }
    void sort() {
        std::sort(order_.begin(), order_.end(), [this](std::size_t a, std::size_t b) {
            return simplex_[a].value != simplex_[b].value ? simplex_[a].value < simplex_[b].value : a < b;
        });
    }
    bool hasCollapsed() const {
        for (const std::size_t v : order_)
            if (simplex_[v].at != simplex_[order_.front()].at)
                return false;
        return true;
    }

    std::size_t dimension_ = 0;
    long count_ = 0;
    const PrefixSums *sums_ = nullptr;
    std::vector<Vertex> simplex_;
    std::vector<std::size_t> order_; // of the vertices, best first
    std::vector<double> middle_;     // of all vertices but the worst
    Vertex reflected_, tried_;
};

} // namespace vectorlib
