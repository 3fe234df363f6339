#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace vectorlib {

/// Things ordered by a parameter in bins as wide as a window: all that lie within the window of a value are
/// in one range of the bins around it. Built in linear time; keeps its buffers.
template <typename Thing>
class BinnedOrder {
public:
    /// key(thing) in units of the window, 0 and above; what lies beyond the last bin shares it.
    template <typename Key>
    void build(const std::vector<Thing> &things, int bins, Key key) {
        bins_ = bins;
        starts_.assign(static_cast<std::size_t>(bins) + 1, 0);
        for (const Thing &t : things)
            ++starts_[bin(key(t)) + 1];
        for (std::size_t i = 1; i < starts_.size(); ++i)
            starts_[i] += starts_[i - 1];
        next_.assign(starts_.begin(), starts_.end() - 1);
        things_.resize(things.size());
        for (const Thing &t : things)
            things_[next_[bin(key(t))]++] = t;
    }
    /// Calls take(thing) for all whose key is within 1 of this one, and for some a little farther.
    template <typename Take>
    void near(double key, Take take) const {
        visit(bin(key - 1), bin(key + 1) + 1, take);
    }
    /// The same where the last bin is followed by the first.
    template <typename Take>
    void nearAround(double key, Take take) const {
        const int from = static_cast<int>(std::floor(key)) - 1;
        for (int i = from; i <= from + 2; ++i) {
            const auto b = static_cast<std::size_t>((i + bins_) % bins_);
            visit(b, b + 1, take);
        }
    }

private:
    std::size_t bin(double key) const {
        return static_cast<std::size_t>(std::clamp(key, 0.0, double(bins_ - 1)));
    }
    template <typename Take>
    void visit(std::size_t from, std::size_t to, Take take) const {
        for (std::size_t i = starts_[from], end = starts_[to]; i < end; ++i)
            take(things_[i]);
    }

    int bins_ = 1;
    std::vector<std::size_t> starts_, next_;
    std::vector<Thing> things_;
};

} // namespace vectorlib
