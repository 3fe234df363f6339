#pragma once

#include "vectorlib/geometry/SmallMatrix.h"
#include "vectorlib/vectorization/PrefixSums.h"
#include "vectorlib/vectorization/VectorizedLine.h"

#include <Eigen/LU>

#include <limits>
#include <vector>

namespace vectorlib {

/// Moves the vertices of a polyline to where the points of its lines lie nearest to its edges, in the least
/// squares sense: one Gauss-Newton step over all vertices, from the lines' sums alone. A point between two
/// vertices, at the share t of the edge, moves away from it by (1 - t) and t of their motions across the
/// edge: the normal equations are block tridiagonal, and are solved in time linear in the lines. Vertices
/// where total least squares lines intersect stay. Keeps its buffers between calls.
class VertexRelaxation {
public:
    /// How strongly a vertex is held where it is, as that many points there would do: along its edges nothing
    /// else does. A vertex then moves by about five times the noise at most.
    double hold = 0.04;

    /// vertices.size() - 1 lines, and the vertices before, between and after them. They stay as they are
    /// where that would not be better.
    void operator()(const VectorizedLine *lines, std::vector<Vector2D<double>> &vertices) {
        const std::size_t count = vertices.size();
        blocks_.assign(count, Block());
        double before = 0, after = 0;
        for (std::size_t i = 0; i + 1 < count; ++i) {
            const Edge edge(lines[i].sums, vertices[i], vertices[i + 1]);
            edge.addTo(blocks_[i], blocks_[i + 1]);
            before += edge.squares;
        }
        solve();
        moved_.resize(count);
        for (std::size_t i = 0; i < count; ++i)
            moved_[i] = vertices[i] + Vector2D<double>(blocks_[i].right.x(), blocks_[i].right.y());
        for (std::size_t i = 0; i + 1 < count; ++i)
            after += Edge(lines[i].sums, moved_[i], moved_[i + 1]).squares;
        if (after < before)
            vertices.swap(moved_);
    }

private:
    using Matrix = Eigen::Matrix2d;
    using Vector = Eigen::Vector2d;

    // The row of a vertex in the normal equations: its own block, that to the next vertex, the right side.
    struct Block {
        Matrix own = Matrix::Zero(), next = Matrix::Zero();
        Vector right = Vector::Zero();
    };
    // The points of a line seen from an edge: sums over t and over the distance r from the edge.
    struct Edge {
        Vector normal;
        double n = 0, t = 0, tt = 0, r = 0, tr = 0;
        double squares; // of r; infinite when the edge has no length

        Edge(const TlsSums &sums, Vector2D<double> from, Vector2D<double> to)
            : normal(0, 0)
            , squares(std::numeric_limits<double>::infinity()) {
            const Vector2D<double> edge = to - from;
            const double length = edge.norm();
            if (!(length > 0))
                return;
            const Vector2D<double> u = edge * (1 / length), v = u.left(), mean = sums.mean - from;
            const double mt = mean.dot(u) / length, mr = mean.dot(v);
            normal = Vector(v.x, v.y);
            n = sums.n;
            t = n * mt;
            r = n * mr;
            tt = t * mt + moment(sums, u, u) / (length * length);
            tr = t * mr + moment(sums, u, v) / length;
            squares = r * mr + moment(sums, v, v);
        }
        static double moment(const TlsSums &s, Vector2D<double> u, Vector2D<double> v) {
            return u.x * v.x * s.xx + (u.x * v.y + u.y * v.x) * s.xy + u.y * v.y * s.yy;
        }
        void addTo(Block &from, Block &to) const {
            const Matrix across = square(1, normal);
            from.own += (n - 2 * t + tt) * across;
            from.next = (t - tt) * across;
            to.own += tt * across;
            from.right += (r - tr) * normal;
            to.right += tr * normal;
        }
    };
    // Block elimination downwards, substitution upwards; the solution takes the place of the right side.
    void solve() {
        for (std::size_t i = 0; i < blocks_.size(); ++i) {
            Block &block = blocks_[i];
            block.own += hold * Matrix::Identity();
            if (i > 0) {
                const Block &above = blocks_[i - 1];
                const Matrix factor = product(above.next, Matrix(above.own.inverse())); // next is symmetric
                block.own -= product(factor, above.next);
                block.right -= product(factor, above.right);
            }
        }
        for (std::size_t i = blocks_.size(); i-- > 0;) {
            Block &block = blocks_[i];
            if (i + 1 < blocks_.size())
                block.right -= product(block.next, blocks_[i + 1].right);
            block.right = product(Matrix(block.own.inverse()), block.right);
        }
    }

    std::vector<Block> blocks_; // of the vertices
    std::vector<Vector2D<double>> moved_;
};

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
