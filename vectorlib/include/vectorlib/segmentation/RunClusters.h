#pragma once

#include "vectorlib/simd/Simd.h"

#include <algorithm>
#include <cstring>
#include <vector>

namespace vectorlib {

/// Clusters of an ordered scan as unions of runs. A run is a stretch of points of which each is near its
/// direct predecessor: nearly all points need no further comparison. Only where a run begins, its first K
/// points are compared with those of earlier runs among their K predecessors, as long as these belong to
/// another cluster. The clusters are exactly those of comparing every point with all its K predecessors.
/// Keeps its buffers.
class RunClusters {
public:
    /// `Nearness` has flag() and near(later, earlier). `closed`: the last points precede the first ones.
    template <typename Nearness>
    void find(const Nearness &nearness, std::size_t count, std::size_t reach, bool closed,
              simd::Level level) {
        begins_.clear();
        parent_.clear();
        count_ = count;
        if (count == 0)
            return;
        flags_.resize(count + 8);
        flags_[0] = 0;
        nearness.flag(count, level, flags_.data());
        std::memset(flags_.data() + count, 1, 8);
        splitIntoRuns();
        for (std::size_t r = 1; r + 1 < begins_.size(); ++r)
            joinBackwards(nearness, r, reach);
        if (closed)
            close(nearness, reach);
    }

    std::size_t runs() const { return parent_.size(); }
    /// Where a run begins; the number of points for run runs().
    std::size_t begin(std::size_t run) const { return begins_[run]; }
    std::size_t length(std::size_t run) const { return begins_[run + 1] - begins_[run]; }
    /// The first run of the cluster.
    std::size_t root(std::size_t run) {
        while (parent_[run] != run)
            run = parent_[run] = parent_[parent_[run]];
        return run;
    }

private:
    // Eight flags at a time: nearly always all are set.
    void splitIntoRuns() {
        constexpr std::uint64_t all = 0x0101010101010101;
        for (std::size_t i = 0; i < count_; i += 8) {
            std::uint64_t eight;
            std::memcpy(&eight, flags_.data() + i, 8);
            if (eight != all)
                for (std::size_t k = i; k < i + 8; ++k)
                    if (!flags_[k])
                        begins_.push_back(k);
        }
        parent_.resize(begins_.size());
        for (std::size_t r = 0; r < parent_.size(); ++r)
            parent_[r] = r;
        begins_.push_back(count_);
    }
    template <typename Nearness>
    void joinBackwards(const Nearness &nearness, std::size_t run, std::size_t reach) {
        const std::size_t begin = begins_[run], end = std::min(begins_[run + 1], begin + reach);
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t earliest = i > reach ? i - reach : 0;
            bool others = false;
            for (std::size_t r = run; r-- > 0 && begins_[r + 1] > earliest;)
                if (root(r) != root(run)) {
                    if (nearAny(nearness, i, std::max(earliest, begins_[r]), begins_[r + 1]))
                        join(r, run);
                    else
                        others = true;
                }
            if (!others)
                return; // later points of the run see no further runs
        }
    }
    template <typename Nearness>
    static bool nearAny(const Nearness &nearness, std::size_t i, std::size_t first, std::size_t end) {
        for (std::size_t j = end; j-- > first;)
            if (nearness.near(i, j))
                return true;
        return false;
    }
    // The first points are examined again, with the last ones as their predecessors.
    template <typename Nearness>
    void close(const Nearness &nearness, std::size_t reach) {
        std::size_t run = 0;
        for (std::size_t i = 0; i < std::min(reach, count_); ++i) {
            run += i == begins_[run + 1];
            std::size_t other = runs() - 1;
            for (std::size_t back = i + 1; back <= reach && back < count_; ++back) {
                const std::size_t j = count_ + i - back;
                while (begins_[other] > j)
                    --other;
                if (root(run) != root(other) && nearness.near(i, j))
                    join(run, other);
            }
        }
    }
    // The earlier root stays, so that clusters are numbered by their first point.
    void join(std::size_t a, std::size_t b) {
        a = root(a);
        b = root(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

    std::size_t count_ = 0;
    std::vector<std::uint8_t> flags_; // whether each point is near its predecessor
    std::vector<std::size_t> begins_;
    std::vector<std::size_t> parent_;
};

} // namespace vectorlib
