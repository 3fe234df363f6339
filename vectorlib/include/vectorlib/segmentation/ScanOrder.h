#pragma once

#include "vectorlib/geometry/Angle.h"
#include "vectorlib/geometry/Vector2D.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

namespace vectorlib {

/// Puts the points of a scan into counter-clockwise order about the sensor. A scan that has this order is
/// given back as it is, wherever it begins and up to some sixty turns round; one that goes clockwise is
/// reversed; one without order is sorted by direction. Sensor frame, metres. Looks at some 128 points of a
/// scan, so that one in order costs next to nothing. Keeps its buffers.
class ScanOrder {
public:
    /// Valid until the next call, and while the given points are. A sorted scan begins behind its widest gap
    /// and is without the points that are not finite or farther away than 1,000 km.
    PointSpan<float> operator()(PointSpan<float> scan) {
        const Steps steps = stepsOf(scan);
        if (steps.right <= few * steps.left)
            return scan;
        points_.clear();
        if (steps.left <= few * steps.right)
            points_.assign(std::make_reverse_iterator(scan.end()), std::make_reverse_iterator(scan.begin()));
        else
            sortByDirection(scan);
        return points_;
    }

private:
    static constexpr double few = 0.1; // share of steps the other way that noise and gaps may make
    static constexpr std::size_t lookedAt = 128;

    /// How many steps from point to point go to the left about the sensor, and to the right.
    struct Steps {
        int left = 0, right = 0;
    };
    struct Directed {
        float direction; // radians
        Vector2D<float> point;

        bool operator<(const Directed &o) const {
            return direction != o.direction ? direction < o.direction
                                            : point.squaredNorm() < o.point.squaredNorm();
        }
    };

    static bool isPlace(Vector2D<float> p) { return std::abs(p.x) < 1e6f && std::abs(p.y) < 1e6f; }

    static Steps stepsOf(PointSpan<float> scan) {
        Steps steps;
        const std::size_t step = 1 + scan.size() / (lookedAt + 1);
        Vector2D<float> last;
        for (std::size_t i = 0; i < scan.size(); i += step) {
            while (i + 1 < scan.size() && !isPlace(scan[i]))
                ++i;
            const float turn = last.cross(scan[i]);
            steps.left += turn > 0;
            steps.right += turn < 0;
            if (turn != 0 || last == Vector2D<float>()) // the same point again is no step
                last = scan[i];
        }
        return steps;
    }
    void sortByDirection(PointSpan<float> scan) {
        directed_.clear();
        for (const Vector2D<float> &p : scan)
            if (isPlace(p))
                directed_.push_back({std::atan2(p.y, p.x), p});
        std::sort(directed_.begin(), directed_.end());
        std::size_t begin = 0;
        float widest = 0;
        for (std::size_t i = 0; i < directed_.size(); ++i) {
            const float turn = i > 0 ? 0 : static_cast<float>(2 * pi);
            const float before = (i > 0 ? directed_[i - 1] : directed_.back()).direction;
            if (const float gap = directed_[i].direction - before + turn; gap > widest) {
                widest = gap;
                begin = i;
            }
        }
        for (std::size_t i = 0; i < directed_.size(); ++i)
            points_.push_back(directed_[(begin + i) % directed_.size()].point);
    }

    std::vector<Directed> directed_;
    std::vector<Vector2D<float>> points_;
};

} // namespace vectorlib
