#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Pose2D.h"
#include "vectorlib/graph/PoseGraph.h"
#include "vectorlib/io/TextInput.h"

#include <iosfwd>
#include <string>
#include <vector>

namespace vectorlib {

/// A graph in the format of g2o: `VERTEX_SE2 number x y theta` and `EDGE_SE2 from to x y theta` with the
/// upper triangle of the information matrix, multiplied by the weight of the constraint, in the frame of the
/// second pose as measured; metres, radians.
void writeG2o(std::ostream &out, const PoseGraph &graph);

/// A pose and when it was taken.
struct StampedPose {
    double stamp = 0; ///< seconds
    Pose2D pose;
    bool isApart = false; ///< nothing drove here from the pose before
};

/// What writeTum() changed so that the stamps ascend.
struct StampMend {
    std::size_t moved = 0;     ///< stamps written other than given
    std::size_t ties = 0;      ///< stamps given that are the one before
    std::size_t stepsBack = 0; ///< stamps given that are earlier than the one before
    double farthest = 0;       ///< largest distance that a stamp was moved, seconds
};

/// A trajectory in the format of the TUM benchmark: `stamp x y z qx qy qz qw`, one pose a line; seconds,
/// metres. Readers take one pose a stamp and divide by the time between: the stamps are written strictly
/// ascending. The poses keep their order; a stamp that is not later than the one before is moved to a
/// microsecond behind it (the last decimal of the benchmark's files), all others stay as they are.
StampMend writeTum(std::ostream &out, const std::vector<StampedPose> &trajectory);

/// A trajectory in that format, as other programs write it, too: lines that begin with # are comments, stamps
/// may have any order. Of a pose in space x, y and the heading about z are taken.
Expected<std::vector<StampedPose>> readTum(std::istream &in, std::string name);

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/io/Tum.cpp")
