#pragma once

#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/observation/Ray.h"

#include <algorithm>
#include <vector>

namespace vectorlib {

/// A part of an edge of the world that is seen.
template <typename Scalar = float>
struct VisiblePart {
    LineSegment2D<Scalar> segment; ///< in the sensor's frame, free space on the left
    std::size_t edge = 0;          ///< its number in the world
};

/// What a sensor at a pose would see of a world of directed segments: the nearest edge in every direction. An
/// edge seen from its right side hides what is behind it and is not itself seen. Thesis 7.4.2, expected view.
/// O(n^2) of the number of edges; owns its buffers and allocates only while they grow.
template <typename Scalar = float>
class Observer {
public:
    using Segment = LineSegment2D<Scalar>;

    double fieldOfView = 2 * pi; ///< radians, half of it to each side of the heading
    double maxRange = noHit;     ///< metres; what lies beyond is cut off

    /// The visible parts counter-clockwise from the right limit of the field of view; valid until the next
    /// call. Edges and poses that are not finite see and are seen nowhere.
    const std::vector<VisiblePart<Scalar>> &operator()(const std::vector<Segment> &world,
                                                       const Pose2D &pose) {
        parts_.clear();
        place(world, pose);
        collectAngles();
        for (std::size_t i = 1; i < angles_.size(); ++i)
            look(angles_[i - 1], angles_[i]);
        closeTurn();
        clip();
        return parts_;
    }

private:
    using Vector = Vector2D<double>;
    /// An edge in the sensor's frame.
    struct Edge {
        Vector begin;
        Vector end;
        std::size_t number;
    };
    static constexpr double leastAngle = 1e-12; ///< radians; narrower sectors are rounding

    void place(const std::vector<Segment> &world, const Pose2D &pose) {
        const Transformation2D toSensor = Transformation2D(pose).inverse();
        edges_.clear();
        for (std::size_t i = 0; i < world.size(); ++i) {
            const Edge edge{toSensor * Vector(world[i].begin()), toSensor * Vector(world[i].end()), i};
            if (edge.begin.isFinite() && edge.end.isFinite())
                edges_.push_back(edge);
        }
    }

    /// The directions between which the nearest edge cannot change: to ends and crossings of edges.
    void collectAngles() {
        const double limit = std::min(fieldOfView / 2, pi);
        angles_.assign({-limit, limit});
        const auto add = [&](Vector p) {
            const double angle = std::atan2(p.y, p.x);
            if (angle > -limit && angle < limit)
                angles_.push_back(angle);
        };
        for (std::size_t i = 0; i < edges_.size(); ++i) {
            add(edges_[i].begin);
            add(edges_[i].end);
            for (std::size_t j = 0; j < i; ++j) {
                Vector crossing;
                if (cross(edges_[i], edges_[j], crossing))
                    add(crossing);
            }
        }
        std::sort(angles_.begin(), angles_.end());
    }

    static bool cross(const Edge &a, const Edge &b, Vector &point) {
        const Vector da = a.end - a.begin, db = b.end - b.begin;
        const double det = da.cross(db);
        if (det == 0)
            return false;
        const double onA = (b.begin - a.begin).cross(db) / det;
        const double onB = (b.begin - a.begin).cross(da) / det;
        point = a.begin + da * onA;
        return onA > 0 && onA < 1 && onB > 0 && onB < 1;
    }

    /// Adds what is seen between two directions, from right to left.
    void look(double right, double left) {
        if (left - right < leastAngle)
            return;
        const Vector middle = towards((right + left) / 2);
        const Edge *nearest = nullptr;
        double nearestDistance = noHit;
        for (const Edge &edge : edges_) {
            const double distance = rayDistance(middle, edge.begin, edge.end);
            if (distance < nearestDistance) {
                nearestDistance = distance;
                nearest = &edge;
            }
        }
        if (!nearest || nearest->begin.cross(nearest->end) <= 0) // nothing, or from its right side
            return;
        const Segment part(Vector2D<Scalar>(meet(*nearest, towards(right))),
                           Vector2D<Scalar>(meet(*nearest, towards(left))));
        if (!parts_.empty() && parts_.back().edge == nearest->number && lastLeft_ == right)
            parts_.back().segment = Segment(parts_.back().segment.begin(), part.end());
        else
            parts_.push_back({part, nearest->number});
        lastLeft_ = left;
    }

    static Vector towards(double angle) { return {std::cos(angle), std::sin(angle)}; }

    /// Where a direction meets an edge that is known to extend at least so far.
    static Vector meet(const Edge &edge, Vector direction) {
        const Vector along = edge.end - edge.begin;
        const double t = edge.begin.cross(direction) / direction.cross(along);
        return edge.begin + along * std::clamp(t, 0.0, 1.0);
    }

    /// Joins the two halves of the edge right behind the sensor, where a full turn begins and ends.
    void closeTurn() {
        if (parts_.size() < 2 || fieldOfView < 2 * pi || parts_.front().edge != parts_.back().edge)
            return;
        const Segment first = parts_.front().segment, last = parts_.back().segment;
        if ((first.begin() - last.end()).norm() > Scalar(1e-6) * (Scalar(1) + first.begin().norm()))
            return;
        parts_.front().segment = Segment(last.begin(), first.end());
        parts_.pop_back();
    }

    void clip() {
        if (!(maxRange < noHit))
            return;
        std::size_t kept = 0;
        for (const VisiblePart<Scalar> &part : parts_) {
            const Segment &s = part.segment;
            const double across = s.across({0, 0});
            if (std::abs(across) >= maxRange)
                continue;
            const double foot = s.along({0, 0}), half = std::sqrt(maxRange * maxRange - across * across);
            const double from = std::max(0.0, foot - half), to = std::min(double(s.length()), foot + half);
            if (from >= to)
                continue;
            const auto at = [&](double t) { return s.begin() + s.direction() * Scalar(t); };
            parts_[kept++] = {Segment(at(from), at(to), s.direction()), part.edge};
        }
        parts_.resize(kept);
    }

    std::vector<Edge> edges_;
    std::vector<double> angles_;
    std::vector<VisiblePart<Scalar>> parts_;
    double lastLeft_ = 0;
};

} // namespace vectorlib
