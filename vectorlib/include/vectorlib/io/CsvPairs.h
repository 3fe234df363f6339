#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/SegmentPair.h"
#include "vectorlib/io/InputError.h"

#include <string>
#include <vector>

namespace vectorlib {

/// Pairs of segments that readCsvPairs() read; metres.
struct PairTable {
    std::vector<SegmentPair> pairs;
    bool hasWeights = false; ///< the file has a column `weight`
};

/// Pairs from CSV: `sx1,sy1,sx2,sy2,dx1,dy1,dx2,dy2[,weight]`. A segment of no length or a weight that is not
/// above 0 is an error, and so is a file without a pair.
Expected<PairTable> readCsvPairs(std::istream &in, std::string name);

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/io/CsvPairs.cpp")
