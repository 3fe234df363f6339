#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace hermes::vector {

/// The least value that more than this share, 0 to under 1, of all are not above; 0 of none.
inline double quantile(std::vector<double> values, double share) {
    if (values.empty())
        return 0;
    const auto at = values.begin() + std::ptrdiff_t(double(values.size()) * share);
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

inline double median(std::vector<double> values) {
    return quantile(std::move(values), 0.5);
}

} // namespace hermes::vector
