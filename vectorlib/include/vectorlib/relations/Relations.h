#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/relations/Corner.h"
#include "vectorlib/relations/TypedSegment.h"

#include <cmath>
#include <cstdint>
#include <vector>

namespace vectorlib {

/// An angle as a 65536th of a turn: differences wrap by themselves.
using TurnPart = std::uint16_t;

/// The part of a turn of an angle in radians.
TurnPart turnPart(double radians);
/// Whether two angles differ by at most `window`; 65536ths of a turn.
inline bool isWithin(TurnPart a, TurnPart b, int window) {
    return std::abs(static_cast<std::int16_t>(static_cast<TurnPart>(a - b))) <= window;
}

/// Relation A of pose-free thesis 4.3: two segments and the relative angle between them.
struct AngleRelation {
    std::int16_t first = 0, second = 0;
    TurnPart angle = 0;
};

/// How two parallel segments lie beside each other. Pose-free thesis 4.4.
enum class OverlapKind : std::uint8_t { Overlap, MayOverlap, NoOverlap };

/// Relation P of pose-free thesis 4.4: two parallel segments.
struct ParallelRelation {
    std::int16_t first = 0, second = 0;
    TurnPart angle = 0;
    OverlapKind kind = OverlapKind::MayOverlap;
    bool isLeast = false; ///< the overlap may be longer: an end that limits it is interior
    float along = 0;      ///< overlap length, or the gap of NoOverlap; metres. MayOverlap: undefined, 0
    float across = 0;     ///< distance of the lines; metres
};

/// Relation E of pose-free thesis 4.5: two corners, their distance, and the angles from their segments to the
/// line from the first corner to the second. A jump has one segment, and one angle is missing.
struct CornerRelation {
    std::int16_t first = 0, second = 0;
    float distance = 0;                ///< metres
    TurnPart angles[4] = {0, 0, 0, 0}; ///< of the first corner's segments, then the second's
    std::uint8_t present = 0;          ///< bit i: angles[i] is there
};

/// How two segments of one scan lie beside each other, when they are parallel within the window; false when
/// they are not.
bool parallelRelation(const TypedSegment &a, const TypedSegment &b, double window,
                      ParallelRelation &relation);

/// Two corners of one scan; false when they are too near to each other to have a direction.
bool cornerRelation(const std::vector<TypedSegment> &segments, const Corner &a, const Corner &b, double least,
                    CornerRelation &relation);

/// Whether the parameters of two relations are equal within the windows (metres; 65536ths of a turn).
bool parametersMatch(const ParallelRelation &a, const ParallelRelation &b, float window, int turn);
/// The same for two relations of corners: angles that both have, and the distance.
bool parametersMatch(const CornerRelation &a, const CornerRelation &b, float window, int turn);

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/relations/Relations.cpp")
