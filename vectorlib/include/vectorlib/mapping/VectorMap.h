#pragma once

#include "vectorlib/edges/MapEdge.h"
#include "vectorlib/geometry/SegmentGrid.h"

#include <utility>
#include <vector>

namespace vectorlib {

struct VectorMapSettings {
    double maxSigma = 0.05; ///< edges are merged only while the points stay within this of one line; metres
    double joinDistance =
        0.06;                ///< collinear edges join when their lines are no farther apart than this; metres
    double joinAngle = 0.06; ///< and no more turned than this; radians
    double joinGap = 0.10;   ///< and their ends no farther apart than this along the line; metres
};

/// A map of line segments that grows by merging: a matched edge of a scan is added to its map edge by its
/// transformed sums, so that the line is the exact total least squares line of all points ever seen on it.
/// Map frame: metres.
class VectorMap {
public:
    VectorMapSettings settings;

    /// The edges; those of observations == 0 were merged into others and are to be skipped.
    const std::vector<MapEdge> &slots() const { return edges_; }
    std::size_t size() const { return alive_; }
    bool isEmpty() const { return alive_ == 0; }
    void clear() {
        edges_.clear();
        grid_.clear();
        alive_ = 0;
        changed_.clear();
    }

    template <typename Take>
    void forEach(Take take) const {
        for (const MapEdge &e : edges_)
            if (e.observations > 0)
                take(e);
    }
    /// Numbers of the edges near a box; sorted by number, so that results do not depend on hashing.
    const std::vector<int> &near(Vector2D<double> low, Vector2D<double> high) {
        found_.clear();
        grid_.query(low, high, [this](int number) {
            if (edges_[static_cast<std::size_t>(number)].observations > 0)
                found_.push_back(number);
        });
        std::sort(found_.begin(), found_.end());
        return found_;
    }

    /// Adds an edge seen for the first time (or read from a file); returns its number.
    int add(const EdgeRaw2D &edge, std::int64_t observations = 1) {
        const int number = static_cast<int>(edges_.size());
        edges_.emplace_back(number, edge, observations);
        grid_.insert(number, edge.segment);
        ++alive_;
        changed_.push_back(number);
        return number;
    }
    /// Merges an edge (map frame) into the map's edge of that number; false, and nothing changed, when the
    /// points would no longer lie within maxSigma of one line, or another edge has taken that one in.
    bool merge(int number, const EdgeRaw2D &edge, std::int64_t observations = 1) {
        MapEdge &target = edges_[static_cast<std::size_t>(number)];
        const EdgeRaw2D joint = merged(target, edge);
        if (target.observations == 0 || joint.sigma > settings.maxSigma)
            return false;
        static_cast<EdgeRaw2D &>(target) = joint;
        target.observations += observations;
        grid_.insert(number, joint.segment);
        changed_.push_back(number);
        return true;
    }
    /// Joins the edge with others that lie on the same line and touch it; returns how many it took in.
    int consolidate(int number) {
        int joined = 0;
        for (bool again = true; again;) {
            const LineSegment2D<double> s = edges_[static_cast<std::size_t>(number)].segment;
            const double g = settings.joinGap;
            const Vector2D<double> low(std::min(s.begin().x, s.end().x) - g,
                                       std::min(s.begin().y, s.end().y) - g);
            const Vector2D<double> high(std::max(s.begin().x, s.end().x) + g,
                                        std::max(s.begin().y, s.end().y) + g);
            again = false;
            for (int other : near(low, high))
                if (other != number && join(number, other)) {
                    again = true; // the edge grew: look around again
                    ++joined;
                    break;
                }
        }
        return joined;
    }
    /// Numbers of edges that were added, merged or removed since the last call, for those who send changes.
    std::vector<int> takeChanges() {
        std::sort(changed_.begin(), changed_.end());
        changed_.erase(std::unique(changed_.begin(), changed_.end()), changed_.end());
        return std::exchange(changed_, {});
    }

private:
    bool join(int number, int other) {
        MapEdge &a = edges_[static_cast<std::size_t>(number)], &b = edges_[static_cast<std::size_t>(other)];
        const LineSegment2D<double> &s = a.segment, &o = b.segment;
        if (s.direction().dot(o.direction()) < std::cos(settings.joinAngle))
            return false;
        const double t0 = s.along(o.begin()), t1 = s.along(o.end());
        if (std::max(t0, t1) < -settings.joinGap || std::min(t0, t1) > s.length() + settings.joinGap)
            return false;
        if (std::abs(s.across(o.begin())) > settings.joinDistance ||
            std::abs(s.across(o.end())) > settings.joinDistance)
            return false;
        const EdgeRaw2D joint = merged(a, b);
        if (joint.sigma > settings.maxSigma)
            return false;
        static_cast<EdgeRaw2D &>(a) = joint;
        a.observations = std::max(a.observations, b.observations);
        b.observations = 0;
        --alive_;
        grid_.insert(number, joint.segment);
        changed_.push_back(number);
        changed_.push_back(other);
        return true;
    }

    std::vector<MapEdge> edges_; // by number; an id is never used again
    SegmentGrid grid_;
    std::size_t alive_ = 0;
    std::vector<int> found_;
    std::vector<int> changed_;
};

} // namespace vectorlib
