#pragma once

#include "vectorlib/segmentation/Comparison.h"

#include <vector>

namespace vectorlib {

/// Clusters of an ordered scan as unions of runs. A run is a stretch of points of which each is near its
/// direct predecessor: nearly all points need no further comparison. Two runs are compared only as far as
/// points of one are among the K predecessors of points of the other, and only while they belong to different
/// clusters. The clusters are exactly those of comparing every point with all its K predecessors. Keeps its
/// buffers.
class RunClusters {
public:
    /// Finds the runs; each is a cluster of its own.
    template <typename Nearness>
    void split(const Comparison<Nearness> &points) {
        count_ = points.count();
        begins_.clear();
        words_.resize(count_ ? (count_ - 1 + NearWord::bits - 1) / NearWord::bits : 0);
        if (count_ > 0) {
            points.withPredecessors(words_.data());
            begins_.push_back(0);
        }
        for (std::size_t w = 0; w < words_.size(); ++w)
            for (std::uint64_t apart = ~words_[w].near; apart != 0; apart &= apart - 1) {
                const std::size_t at = w * NearWord::bits + trailingZeros(apart) + 1;
                if (at >= count_)
                    break;
                begins_.push_back(at);
            }
        root_.resize(begins_.size());
        for (std::size_t r = 0; r < root_.size(); ++r)
            root_[r] = r;
        begins_.push_back(count_);
    }
    /// Joins the runs that belong together; the last points precede the first ones if `closed`.
    template <typename Nearness>
    void join(const Comparison<Nearness> &points, std::size_t reach, bool closed) {
        for (std::size_t later = 1; later < runs(); ++later)
            if (length(later) == 1)
                joinPoint(points, later, reach);
            else
                for (std::size_t r = later; r-- > 0 && begins_[r + 1] + reach > begins_[later];)
                    joinIfNear(points, later, r, 0, reach);
        for (std::size_t later = 0; closed && later < runs() && begins_[later] < reach; ++later)
            for (std::size_t r = runs(); --r > later && begins_[r + 1] + reach > begins_[later] + count_;)
                joinIfNear(points, later, r, count_, reach);
        for (std::size_t &r : root_) // none is later than its run
            r = root_[r];
    }

    std::size_t runs() const { return root_.size(); }
    /// Where a run begins; the number of points for run runs().
    std::size_t begin(std::size_t run) const { return begins_[run]; }
    /// How many points a run has.
    std::size_t length(std::size_t run) const { return begins_[run + 1] - begins_[run]; }
    /// The first run of the cluster, after join().
    std::size_t root(std::size_t run) const { return root_[run]; }
    /// The widest gap between a point i > 0 and its predecessor is at most this, if both are in one run.
    double widestNear(std::size_t i) const { return words_[(i - 1) / NearWord::bits].widest; }

private:
    // The points of `later` count as if they came `turn` points later.
    template <typename Nearness>
    void joinIfNear(const Comparison<Nearness> &points, std::size_t later, std::size_t earlier,
                    std::size_t turn, std::size_t reach) {
        const std::size_t a = findRoot(later), b = findRoot(earlier);
        if (a != b && anyNear(points, later, earlier, turn, reach))
            unite(a, b);
    }
    // A run of one point: all its predecessors at once.
    template <typename Nearness>
    void joinPoint(const Comparison<Nearness> &points, std::size_t run, std::size_t reach) {
        const std::size_t i = begins_[run];
        std::size_t root = run, other = run;
        points.eachNear(i > reach ? i - reach : 0, i, i, true, [&](std::size_t j) {
            while (begins_[other] > j)
                --other;
            root = unite(root, findRoot(other));
            return true;
        });
    }
    // Clusters are numbered by their first points.
    std::size_t unite(std::size_t a, std::size_t b) {
        root_[std::max(a, b)] = std::min(a, b);
        return std::min(a, b);
    }
    // Point by point of that run of which fewer points matter.
    template <typename Nearness>
    bool anyNear(const Comparison<Nearness> &points, std::size_t later, std::size_t earlier, std::size_t turn,
                 std::size_t reach) const {
        const std::size_t first = begins_[later], end = begins_[earlier + 1];
        const auto predecessors = [&](std::size_t i) { // from which one on
            return std::max(begins_[earlier], i + turn > reach ? i + turn - reach : 0);
        };
        const auto successors = [&](std::size_t j) { // up to which one
            return std::min(begins_[later + 1], j + reach + 1 - turn);
        };
        if (successors(end - 1) - first <= end - predecessors(first)) {
            for (std::size_t i = first; i < successors(end - 1); ++i)
                if (points.nearAny(predecessors(i), end, i, true))
                    return true;
        } else {
            for (std::size_t j = end; j-- > predecessors(first);)
                if (points.nearAny(first, successors(j), j, false))
                    return true;
        }
        return false;
    }
    std::size_t findRoot(std::size_t run) {
        while (root_[run] != run)
            run = root_[run] = root_[root_[run]];
        return run;
    }
    static std::size_t trailingZeros(std::uint64_t bits) {
#if defined(__GNUC__)
        return static_cast<std::size_t>(__builtin_ctzll(bits));
#else
        std::size_t n = 0;
        while (!(bits >> n & 1))
            ++n;
        return n;
#endif
    }

    std::size_t count_ = 0;
    std::vector<NearWord> words_;
    std::vector<std::size_t> begins_;
    std::vector<std::size_t> root_; // an earlier run of the same cluster, or the run itself
};

} // namespace vectorlib
