#pragma once

#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/observation/NearestEdges.h"
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
/// O(n log n) of the number of edges; owns its buffers and allocates only while they grow.
template <typename Scalar = float>
class Observer {
public:
    using Segment = LineSegment2D<Scalar>;

    double fieldOfView = 2 * pi; ///< radians, half of it to each side of the heading
    double maxRange = noHit;     ///< metres; what lies beyond is cut off

    /// The visible parts counter-clockwise from the right limit of the field of view; the part straight
    /// behind comes first where the view closes. Valid until the next call. Edges and poses that are not
    /// finite see and are seen nowhere. Obstacles (thesis 7.4.2: the border of unexplored space) hide and are
    /// not seen.
    const std::vector<VisiblePart<Scalar>> &operator()(const std::vector<Segment> &world, const Pose2D &pose,
                                                       const std::vector<Segment> &obstacles = {}) {
        parts_.clear();
        nearest_.clear();
        numbers_.clear();
        limit_ = fieldOfView < 2 * pi ? turnOf({std::cos(fieldOfView / 2), std::sin(fieldOfView / 2)}) : 2;
        const Transformation2D toSensor = Transformation2D(pose).inverse();
        for (std::size_t i = 0; i < world.size(); ++i)
            place(toSensor, world[i], i);
        for (const Segment &obstacle : obstacles)
            place(toSensor, obstacle, unseen);
        for (const Sector &sector : nearest_())
            if (numbers_[sector.edge] != unseen && sector.left - sector.right > leastTurn)
                see(sector);
        closeTurn();
        clip();
        return parts_;
    }

private:
    using Vector = Vector2D<double>;
    static constexpr double leastTurn = 1e-12; ///< narrower sectors are rounding
    static constexpr std::size_t unseen = static_cast<std::size_t>(-1);

    void place(const Transformation2D &toSensor, const Segment &edge, std::size_t number) {
        const Vector begin = toSensor * Vector(edge.begin()), end = toSensor * Vector(edge.end());
        const double area = begin.cross(end);
        // What runs through the sensor has no side and hides nothing.
        if (!begin.isFinite() || !end.isFinite() || std::abs(area) <= 1e-12 * (end - begin).squaredNorm())
            return;
        const bool facing = area > 0 && number != unseen;
        numbers_.push_back(facing ? number : unseen);
        nearest_.add(begin, end, facing, -limit_, limit_);
    }
    void see(const Sector &sector) {
        const SightLine &line = nearest_.line(sector.edge);
        parts_.push_back(
            {Segment(Vector2D<Scalar>(line.meet(sector.towardsRight)),
                     Vector2D<Scalar>(line.meet(sector.towardsLeft)), Vector2D<Scalar>(line.normal.left())),
             numbers_[sector.edge]});
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

    double limit_ = 2; // turnOf the left limit of the field of view
    NearestEdges nearest_;
    std::vector<std::size_t> numbers_; // in the world, of what may be seen
    std::vector<VisiblePart<Scalar>> parts_;
};

} // namespace vectorlib
