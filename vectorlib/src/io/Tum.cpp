#include "vectorlib/io/Tum.h"
#include "vectorlib/io/Number.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <ostream>

namespace vectorlib {

VECTORLIB_BODY void writeG2o(std::ostream &out, const PoseGraph &graph) {
    for (std::size_t i = 0; i < graph.poses.size(); ++i)
        out << "VERTEX_SE2 " << i << ' ' << Number(graph.poses[i].x) << ' ' << Number(graph.poses[i].y) << ' '
            << Number(graph.poses[i].theta) << '\n';
    out << "FIX 0\n";
    for (const PoseConstraint &c : graph.constraints) {
        Eigen::Matrix3d turned = Eigen::Matrix3d::Identity();
        turned.topLeftCorner<2, 2>() << c.motion.cos(), -c.motion.sin(), c.motion.sin(), c.motion.cos();
        const Eigen::Matrix3d information = c.weight * (turned.transpose() * c.information * turned);
        out << "EDGE_SE2 " << c.from << ' ' << c.to << ' ' << Number(c.motion.x()) << ' '
            << Number(c.motion.y()) << ' ' << Number(c.motion.alpha());
        for (int r = 0; r < 3; ++r)
            for (int k = r; k < 3; ++k)
                out << ' ' << Number(information(r, k));
        out << '\n';
    }
}

VECTORLIB_BODY StampMend writeTum(std::ostream &out, const std::vector<StampedPose> &trajectory) {
    constexpr double step = 1e-6;
    StampMend mend;
    double kept = 0, given = 0, last = -std::numeric_limits<double>::infinity();
    std::size_t behind = 0; // stamps moved since the one kept; counted, so that rounding does not add up
    for (const StampedPose &p : trajectory) {
        const bool isFirst = &p == &trajectory.front();
        mend.ties += !isFirst && p.stamp == given;
        mend.stepsBack += !isFirst && p.stamp < given;
        given = p.stamp;
        if (p.stamp > last) {
            kept = last = p.stamp;
            behind = 0;
        } else {
            const double next = std::nextafter(last, std::numeric_limits<double>::infinity());
            last = std::max(kept + double(++behind) * step, next);
            ++mend.moved;
            mend.farthest = std::max(mend.farthest, last - p.stamp);
        }
        out << Number(last) << ' ' << Number(p.pose.x) << ' ' << Number(p.pose.y) << " 0 0 0 "
            << Number(std::sin(p.pose.theta / 2)) << ' ' << Number(std::cos(p.pose.theta / 2)) << '\n';
    }
    return mend;
}

VECTORLIB_BODY Expected<std::vector<StampedPose>> readTum(std::istream &in, std::string name) {
    constexpr std::size_t columns = 8; // stamp x y z qx qy qz qw
    constexpr double widest = 1e7;     // metres
    LineReader lines(in, std::move(name));
    std::vector<std::string_view> fields;
    std::vector<StampedPose> trajectory;
    while (const auto line = lines.next()) {
        splitBlanks(*line, fields);
        if (fields.empty() || fields[0][0] == '#')
            continue;
        if (fields.size() != columns)
            return lines.errorHere(std::to_string(fields.size()) + " fields",
                                   "eight: stamp x y z qx qy qz qw");
        std::array<double, columns> v;
        for (std::size_t i = 0; i < columns; ++i) {
            const auto number = parseNumber(fields[i]);
            if (!number)
                return lines.errorHere(quoted(fields[i]), "a finite number");
            v[i] = *number;
        }
        if (std::abs(v[1]) > widest || std::abs(v[2]) > widest)
            return lines.errorHere("a place beyond all measure", "metres");
        const double length = std::hypot(std::hypot(v[4], v[5]), std::hypot(v[6], v[7]));
        if (!(std::abs(length - 1) < 0.01))
            return lines.errorHere("a quaternion of length " + std::to_string(length), "one of length 1");
        const double heading =
            std::atan2(2 * (v[7] * v[6] + v[4] * v[5]), 1 - 2 * (v[5] * v[5] + v[6] * v[6]));
        trajectory.push_back({v[0], {v[1], v[2], heading}});
    }
    if (lines.error())
        return *lines.error();
    return trajectory;
}

} // namespace vectorlib
