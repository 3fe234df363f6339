#include "vectorlib/io/G2o.h"

#include "vectorlib/io/Number.h"

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

} // namespace vectorlib
