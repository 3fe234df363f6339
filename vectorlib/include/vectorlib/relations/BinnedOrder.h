#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace vectorlib {

/// Things ordered by a parameter in bins as wide as a window: all that lie within the window of a value are
/// in the three bins around it. The last bin is followed by the first, so that no value is too large and
/// those of a circle meet. Built in linear time; keeps its buffers.
template <typename Thing>
class BinnedOrder {
public:
    /// key(thing) in units of the window, 0 and above; at least three bins.
    template <typename Key>
    void build(const std::vector<Thing> &things, int bins, Key key) {
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
    /// Calls take(thing) for all whose key is within 1 of this one, and for others of the same bins; returns
    /// for how many.
    template <typename Take>
    std::size_t near(double key, Take take) const {
        std::size_t visited = 0;
        const std::size_t last = starts_.size() - 2, middle = bin(key);
        for (const std::size_t b : {middle > 0 ? middle - 1 : last, middle, middle < last ? middle + 1 : 0}) {
            for (std::size_t i = starts_[b]; i < starts_[b + 1]; ++i)
                take(things_[i]);
            visited += starts_[b + 1] - starts_[b];
        }
        return visited;
    }

private:
    std::size_t bin(double key) const {
        constexpr double most = 1e9; // what lies beyond shares a bin
        const std::size_t bins = starts_.size() - 1;
        const auto number = static_cast<std::size_t>(std::min(key, most));
        return number < bins ? number : number % bins;
    }

    std::vector<std::size_t> starts_, next_;
    std::vector<Thing> things_;
};

} // namespace vectorlib
