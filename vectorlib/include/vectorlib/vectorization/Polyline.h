#pragma once

#include "vectorlib/vectorization/PrefixSums.h"
#include "vectorlib/vectorization/VectorizedLine.h"
#include "vectorlib/vectorization/VertexRelaxation.h"

#include <vector>

namespace vectorlib {

/// Joins the consecutive lines of one cluster into a polyline: thesis 6.3.3, figure 6.6. Where one line
/// changes to the next, the first of these that holds decides:
///
/// 1. Their intersection is the vertex if it lies within delta of the middle between the two points there, or
/// of where points begin to be nearer to the other line: the search for the longest line overruns corners.
///
/// 2. The vertex lies between the lines if they pass that middle within delta / 2 of each other. All vertices
/// of the polyline are then moved to where the points lie nearest to its edges (VertexRelaxation), so that
/// the edges may leave their lines a little.
///
/// 3. Three lines, each a third of the points of both, take their place if they keep sigma and meet.
///
/// 4. Else the polyline is interrupted there, and both lines keep their own ends.
///
/// Only the segments change, but for 3.
class PolylineJoiner {
public:
    /// `sums` are those of the points: PrefixSums or BlockSums.
    template <typename Scalar, typename Sums>
    void operator()(PointSpan<Scalar> points, const Sums &sums, const VectorizerSettings &settings,
                    std::vector<VectorizedLine> &lines) {
        joined_.clear();
        joints_.clear();
        for (const VectorizedLine &next : lines) {
            if (!joined_.empty()) {
                const Joint joint = meet(points, joined_.back(), next, settings.delta);
                if (!joint.holds() && bridge(points, sums, next, settings))
                    continue;
                joints_.push_back(joint);
            }
            joined_.push_back(next);
        }
        placeVertices();
        lines.swap(joined_);
    }

private:
    // How a line meets the next one.
    struct Joint {
        enum { Interrupted, Corner, Between } kind = Interrupted;
        Vector2D<double> vertex;

        bool holds() const { return kind != Interrupted; }
    };

    template <typename Scalar>
    static Joint meet(PointSpan<Scalar> points, const VectorizedLine &l, const VectorizedLine &m,
                      double delta) {
        Joint joint;
        if (!l.line.isValid() || !m.line.isValid())
            return joint;
        const double limit = delta * delta;
        const Vector2D<double> change = placeBefore(points, m.first);
        if (intersect(l.line, m.line, joint.vertex) &&
            ((joint.vertex - change).squaredNorm() <= limit ||
             (joint.vertex - placeBefore(points, nearerChange(points, l, m))).squaredNorm() <= limit)) {
            joint.kind = Joint::Corner;
            return joint;
        }
        const Vector2D<double> a = l.line.project(change), b = m.line.project(change);
        if (4 * (a - b).squaredNorm() <= limit) {
            joint.kind = Joint::Between;
            joint.vertex = (a + b) * 0.5;
        }
        return joint;
    }
    // The middle between a point and the one before.
    template <typename Scalar>
    static Vector2D<double> placeBefore(PointSpan<Scalar> points, std::size_t i) {
        return (Vector2D<double>(points[i - 1]) + Vector2D<double>(points[i])) * 0.5;
    }
    // The first point of the second line, if the points next to it belonged to the line that they are nearer
    // to.
    template <typename Scalar>
    static std::size_t nearerChange(PointSpan<Scalar> points, const VectorizedLine &l,
                                    const VectorizedLine &m) {
        const auto isNearer = [points](std::size_t i, const Line2D &line, const Line2D &than) {
            const Vector2D<double> p(points[i]);
            return std::abs(line.signedDistance(p)) < std::abs(than.signedDistance(p));
        };
        std::size_t first = m.first;
        while (first > l.first + 1 && isNearer(first - 1, m.line, l.line))
            --first;
        if (first == m.first)
            while (first < m.last && isNearer(first, l.line, m.line))
                ++first;
        return first;
    }
    // Replaces the last joined line and `next` by three lines when these fit and meet; the correction of
    // figure 6.6b.
    template <typename Scalar, typename Sums>
    bool bridge(PointSpan<Scalar> points, const Sums &sums, const VectorizedLine &next,
                const VectorizerSettings &settings) {
        const std::size_t first = joined_.back().first, end = next.last + 1, count = end - first;
        if (count < 6)
            return false;
        const std::size_t cuts[] = {first, first + count / 3, first + 2 * count / 3, end};
        VectorizedLine thirds[3];
        Joint joints[3]; // with the line before, between the thirds
        const bool isJoined = !joints_.empty() && joints_.back().holds();
        for (int i = 0; i < 3; ++i) {
            // Few points are added up sooner than looked up.
            if (cuts[i + 1] - cuts[i] > 32 && !sums.fitWithin(cuts[i], cuts[i + 1], settings.variance()))
                return false;
            thirds[i] = makeLine(points, cuts[i], cuts[i + 1] - 1,
                                 TlsSums::of(points.begin() + cuts[i], points.begin() + cuts[i + 1]));
            if (!(thirds[i].sigma * thirds[i].sigma <= settings.variance()))
                return false;
            if (i > 0 || isJoined) {
                const VectorizedLine &before = i > 0 ? thirds[i - 1] : joined_[joined_.size() - 2];
                joints[i] = meet(points, before, thirds[i], settings.delta);
                if (!joints[i].holds())
                    return false;
            }
        }
        if (isJoined)
            joints_.back() = joints[0];
        joints_.insert(joints_.end(), joints + 1, joints + 3);
        joined_.back() = thirds[0];
        joined_.insert(joined_.end(), thirds + 1, thirds + 3);
        return true;
    }
    void placeVertices() {
        for (std::size_t first = 0, last; first < joined_.size(); first = last + 1) {
            bool isExact = true;
            vertices_.assign(1, joined_[first].segment.begin());
            for (last = first; last < joints_.size() && joints_[last].holds(); ++last) {
                vertices_.push_back(joints_[last].vertex);
                isExact = isExact && joints_[last].kind == Joint::Corner;
            }
            if (last == first)
                continue;
            vertices_.push_back(joined_[last].segment.end());
            if (!isExact)
                relax_(&joined_[first], vertices_);
            for (std::size_t i = first; i <= last; ++i)
                joined_[i].segment = {vertices_[i - first], vertices_[i - first + 1]};
        }
    }

    std::vector<VectorizedLine> joined_;
    std::vector<Joint> joints_; // one less than lines
    std::vector<Vector2D<double>> vertices_;
    VertexRelaxation relax_;
};

} // namespace vectorlib
