#include "vectorlib/graph/PoseConstraint.h"

namespace vectorlib {

VECTORLIB_BODY bool PoseConstraint::isRefused() const {
    constexpr double least = 0.25;
    return mayBeWrong && weight < least;
}

} // namespace vectorlib
