#pragma once

#include "vectorlib/edges/MapEdge.h"
#include "vectorlib/geometry/SegmentGrid.h"

#include <utility>
#include <vector>

namespace vectorlib {

/// When VectorMap makes one edge of several.
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

    /// Calls take(edge) for every edge of the map.
    template <typename Take>
    void forEach(Take take) const {
        for (const MapEdge &e : edges_)
            if (e.observations > 0)
                take(e);
    }
    /// Numbers of the edges near a box; sorted by number, so that results do not depend on hashing.
    const std::vector<int> &near(Vector2D<double> low, Vector2D<double> high) { return find(low, high); }

    /// The same of those that may lie within `margin` (metres) of a segment.
    const std::vector<int> &near(const LineSegment2D<double> &segment, double margin) {
        return find(segment, margin);
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
        take(target, joint, target.observations + observations);
        return true;
    }
    /// Joins the edge with others that lie on the same line and touch it; returns how many it took in.
    int consolidate(int number) {
        int joined = 0;
        for (bool again = true; again;) {
            again = false;
            for (int other : near(edges_[static_cast<std::size_t>(number)].segment, settings.joinGap))
                if (other != number && join(number, other)) {
                    again = true; // the edge grew: look around again
                    ++joined;
                    break;
                }
        }
        return joined;
    }
    /// Takes another edge in, wherever it lies: by its sums, or, where the points would no longer lie within
    /// maxSigma of one line, only by how far it reaches along this one's. `observations` are those of the
    /// wall that both are.
    void absorb(int number, int other, std::int64_t observations) {
        MapEdge &a = edges_[static_cast<std::size_t>(number)];
        const MapEdge &b = edges_[static_cast<std::size_t>(other)];
        EdgeRaw2D joint = merged(a, b);
        if (joint.sigma > settings.maxSigma) {
            const LineSegment2D<double> &s = a.segment;
            const double from = std::min({0.0, s.along(b.segment.begin()), s.along(b.segment.end())});
            const double to = std::max({s.length(), s.along(b.segment.begin()), s.along(b.segment.end())});
            joint = {a.sums, s.part(from, to), a.sigma};
        }
        take(a, joint, observations);
        remove(other);
    }
    /// Holds these edges instead, each under its own id; no two have one, and none is below 0.
    void assign(const std::vector<MapEdge> &edges) {
        for (const MapEdge &old : edges_)
            if (old.observations > 0)
                changed_.push_back(static_cast<int>(old.id));
        std::vector<int> changed = std::move(changed_);
        const std::size_t known = edges_.size();
        clear();
        for (std::size_t i = 0; i < known; ++i)
            edges_.emplace_back(std::int64_t(i), EdgeRaw2D(), 0);
        for (const MapEdge &e : edges) {
            while (edges_.size() <= static_cast<std::size_t>(e.id))
                edges_.emplace_back(std::int64_t(edges_.size()), EdgeRaw2D(), 0);
            take(edges_[static_cast<std::size_t>(e.id)], e, e.observations);
            ++alive_;
        }
        changed_.insert(changed_.end(), changed.begin(), changed.end());
    }
    /// Other ends on the same line; the sums stay.
    void reshape(int number, const LineSegment2D<double> &segment) {
        MapEdge &edge = edges_[static_cast<std::size_t>(number)];
        edge.segment = segment;
        grid_.insert(number, segment);
        changed_.push_back(number);
    }
    /// Another edge on the same wall; id and observations stay.
    void replace(int number, const EdgeRaw2D &edge) {
        MapEdge &known = edges_[static_cast<std::size_t>(number)];
        take(known, edge, known.observations);
    }
    /// Takes the edge of that number out of the map; its slot stays.
    void remove(int number) {
        edges_[static_cast<std::size_t>(number)].observations = 0;
        --alive_;
        changed_.push_back(number);
    }
    /// Numbers of edges that were added, merged or removed since the last call, for those who send changes.
    std::vector<int> takeChanges() {
        std::sort(changed_.begin(), changed_.end());
        changed_.erase(std::unique(changed_.begin(), changed_.end()), changed_.end());
        return std::exchange(changed_, {});
    }

private:
    template <typename Place, typename Size>
    const std::vector<int> &find(const Place &place, const Size &size) {
        found_.clear();
        grid_.query(place, size, [this](int number) {
            if (edges_[static_cast<std::size_t>(number)].observations > 0)
                found_.push_back(number);
        });
        std::sort(found_.begin(), found_.end());
        return found_;
    }
    bool join(int number, int other) {
        MapEdge &a = edges_[static_cast<std::size_t>(number)];
        const MapEdge &b = edges_[static_cast<std::size_t>(other)];
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
        take(a, joint, std::max(a.observations, b.observations));
        remove(other);
        return true;
    }
    void take(MapEdge &edge, const EdgeRaw2D &joint, std::int64_t observations) {
        static_cast<EdgeRaw2D &>(edge) = joint;
        edge.observations = observations;
        grid_.insert(static_cast<int>(edge.id), joint.segment);
        changed_.push_back(static_cast<int>(edge.id));
    }

    std::vector<MapEdge> edges_; // by number; an id is never used again
    SegmentGrid grid_;
    std::size_t alive_ = 0;
    std::vector<int> found_;
    std::vector<int> changed_;
};

} // namespace vectorlib
