#pragma once

#include "vectorlib/geometry/SmallMatrix.h"
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

} // namespace vectorlib
