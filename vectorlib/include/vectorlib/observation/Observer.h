#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace vectorlib {

/// The distance at which a ray meets nothing.
constexpr double noHit = std::numeric_limits<double>::infinity();

/// How far from the origin a ray of unit direction meets the segment from begin to end, whichever side it
/// meets; metres. noHit where it passes by, runs along the segment, or begins on it.
inline double rayDistance(Vector2D<double> direction, Vector2D<double> begin, Vector2D<double> end) {
    const Vector2D<double> edge = end - begin;
    const double across = direction.cross(edge);
    if (across == 0)
        return noHit;
    const double distance = begin.cross(edge) / across;
    const double along = begin.cross(direction) / across; // 0 at begin, 1 at end
    return distance > 0 && along >= 0 && along <= 1 ? distance : noHit;
}

/// A direction as a number that grows counter-clockwise like its angle, without trigonometry: 0 ahead, 1 to
/// the left, 2 (from above) and -2 (from below) behind.
double turnOf(Vector2D<double> d);

/// The line of an edge as it is seen from the origin: normal.p = distance.
struct SightLine {
    Vector2D<double> normal; ///< unit, away from the origin
    double distance = 0;     ///< metres, from 0 on

    SightLine() = default;
    SightLine(Vector2D<double> begin, Vector2D<double> end);
    /// Where a direction (of any length) that does not run along the line meets it.
    Vector2D<double> meet(Vector2D<double> direction) const {
        return direction * (distance / normal.dot(direction));
    }
};

/// Below 0 where `a` is nearer than `b` in a direction that meets both, above 0 where it is farther, 0 where
/// they cross; linear in the direction. Rounding counts as a crossing.
double compareDistance(const SightLine &a, const SightLine &b, Vector2D<double> direction);

/// An edge between two directions, under less than half a turn.
struct Sector {
    double right = 0, left = 0;                 ///< turnOf the two directions, right <= left
    Vector2D<double> towardsRight, towardsLeft; ///< the two directions, of any length
    std::size_t edge = 0;                       ///< number of the edge
};

/// Calls take(sector) for a sector, or, where it crosses the direction straight behind, for its two halves.
/// `right` and `left` are the ends of the edge as the origin sees them.
template <typename Take>
void cutBehind(Vector2D<double> right, Vector2D<double> left, std::size_t edge, Take take) {
    const Sector whole{turnOf(right), turnOf(left), right, left, edge};
    if (whole.right <= whole.left) {
        take(whole);
        return;
    }
    const Vector2D<double> behind(-1, 0);
    if (whole.right < 2)
        take(Sector{whole.right, 2, right, behind, edge});
    if (whole.left > -2)
        take(Sector{-2, whole.left, behind, left, edge});
}

/// The nearest edge in every direction around the origin, for edges that may touch and cross. The views of
/// two halves of the edges become one by a sweep over the angle that keeps the nearer; where both cross, it
/// changes from one to the other. O(n log n) for n edges, but for the crossings that are seen. Owns its
/// buffers.
class NearestEdges {
public:
    void clear();
    /// Adds an edge that does not run through the origin, between two directions. Of two edges in the same
    /// place the one that faces the origin is seen.
    void add(Vector2D<double> begin, Vector2D<double> end, bool facing, double lowest, double highest);
    /// The line of the edge that was added as number `edge`, from 0.
    const SightLine &line(std::size_t edge) const { return lines_[edge]; }

    /// What is seen, from right to left; valid until the next call.
    const std::vector<Sector> &operator()() {
        while (starts_.size() > 2)
            mergeNeighbours();
        return sectors_;
    }

private:
    void clip(Sector &sector, double lowest, double highest) const;
    // Views number 0 and 1, 2 and 3 ... become one each.
    void mergeNeighbours();
    // The view of sectors [i, middle) and that of [middle, end).
    void merge(std::size_t i, std::size_t middle, std::size_t end);
    void emitNearest(Sector both, std::size_t a, std::size_t b);
    void emit(const Sector &sector);

    std::vector<SightLine> lines_;
    std::vector<char> facing_;
    std::vector<Sector> sectors_, merged_;           // views behind each other
    std::vector<std::size_t> starts_, mergedStarts_; // where each begins, and the end of the last
    std::size_t first_ = 0;                          // of the view that is being made
};

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

#include VECTORLIB_BODIES("vectorlib/src/observation/Observer.cpp")
