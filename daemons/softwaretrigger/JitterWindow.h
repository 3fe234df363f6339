#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

namespace hermes::softwaretrigger {

/// How late firings were.
struct Jitter {
    int count = 0;
    std::optional<double> mean_s, p99_s, worst_s; ///< of some
};

/// How late the last 1000 firings were.
class JitterWindow {
public:
    void add(double late_s) {
        if (values_.size() < size)
            values_.push_back(late_s);
        else
            values_[next_] = late_s;
        next_ = (next_ + 1) % size;
    }

    Jitter summary() const {
        if (values_.empty())
            return {};
        std::vector<double> sorted = values_;
        std::sort(sorted.begin(), sorted.end());
        const auto p99 = std::size_t(std::ceil(0.99 * double(sorted.size()))) - 1;
        return {int(sorted.size()),
                std::accumulate(sorted.begin(), sorted.end(), 0.0) / double(sorted.size()), sorted[p99],
                sorted.back()};
    }

private:
    static constexpr std::size_t size = 1000;
    std::vector<double> values_;
    std::size_t next_ = 0;
};

} // namespace hermes::softwaretrigger
