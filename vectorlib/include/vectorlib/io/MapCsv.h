#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/edges/EdgeRaw2D.h"
#include "vectorlib/io/TextInput.h"

#include <algorithm>
#include <cmath>
#include <iosfwd>
#include <string>
#include <vector>

namespace vectorlib {

/// Of the sums of n points, so that the variance across a wall is exact to a tenth of a millimetre squared
/// however long the wall is.
inline int decimalsOfSums(double n) {
    return n > 1 ? std::clamp(static_cast<int>(std::ceil(8 - std::log10(n))), 0, 8) : 8;
}

/// A map as CSV: `id,x1,y1,x2,y2,n,sigma,observations`, then the mean of the points and their second moments
/// about it (TlsSums). Lengths are written to the micrometre, moments by decimalsOfSums(); what was read is
/// written as it stood.
void writeMapCsv(std::ostream &out, const std::vector<MapEdge> &map);

/// Reads what writeMapCsv wrote. A missing column, a number that is none, or an id or count that is not whole
/// is an error.
Expected<std::vector<MapEdge>> readMapCsv(std::istream &in, std::string name);

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/io/MapCsv.cpp")
