#pragma once

#include <cstddef>
#include <functional>
#include <numeric>
#include <utility>
#include <vector>

namespace hermes::vector {

/// Takes how many steps of some work are done, and of how many.
using ProgressSink = std::function<void(std::size_t done, std::size_t all)>;

/// Work in parts that follow each other, as one work for its sink: each part counts its own steps.
class ProgressParts {
public:
    /// sizes: steps of each part for the sink. They should take about the same time each.
    ProgressParts(ProgressSink sink, std::vector<std::size_t> sizes)
        : sink_(std::move(sink))
        , sizes_(std::move(sizes))
        , all_(std::accumulate(sizes_.begin(), sizes_.end(), std::size_t(0))) {}

    /// For the next part; to be used while this lives.
    ProgressSink next() {
        const std::size_t before = std::exchange(before_, before_ + sizes_.at(part_)), size = sizes_[part_++];
        return [this, before, size](std::size_t done, std::size_t all) {
            if (sink_ && all > 0)
                sink_(before + size * done / all, all_);
        };
    }

private:
    ProgressSink sink_;
    std::vector<std::size_t> sizes_;
    std::size_t all_, before_ = 0, part_ = 0;
};

} // namespace hermes::vector
