#pragma once

#include <QJsonObject>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace hermes {

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

    /// {count, mean_s, p99_s, worst_s}; of no firing only the count.
    QJsonObject toJson() const {
        if (values_.empty())
            return {{"count", 0}};
        std::vector<double> sorted = values_;
        std::sort(sorted.begin(), sorted.end());
        const auto p99 = std::size_t(std::ceil(0.99 * double(sorted.size()))) - 1;
        return {{"count", int(sorted.size())},
                {"mean_s", std::accumulate(sorted.begin(), sorted.end(), 0.0) / double(sorted.size())},
                {"p99_s", sorted[p99]},
                {"worst_s", sorted.back()}};
    }

private:
    static constexpr std::size_t size = 1000;
    std::vector<double> values_;
    std::size_t next_ = 0;
};

} // namespace hermes
