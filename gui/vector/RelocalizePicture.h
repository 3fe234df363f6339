#pragma once

#include "gui/vector/SegmentSet.h"
#include "vectorlib/io/Svg.h"
#include "vectorlib/places/Relocalized.h"

namespace hermes::vector {

/// The map, and the scan with its sensor where it was found. Places that fit alike are all drawn, numbered
/// from 1 as in the result, best first; of a search that found none the best place, as one that is refused.
vectorlib::SvgPicture pictureOf(const SegmentSet &map, const SegmentSet &scan,
                                const vectorlib::Relocalized &result);

} // namespace hermes::vector
