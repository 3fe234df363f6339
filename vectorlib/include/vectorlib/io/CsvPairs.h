#pragma once

#include "vectorlib/geometry/SegmentPair.h"
#include "vectorlib/io/Csv.h"

namespace vectorlib {

/// Pairs of segments that readCsvPairs() read; metres.
struct PairTable {
    std::vector<SegmentPair> pairs;
    bool hasWeights = false; ///< the file has a column `weight`
};

/// Pairs from CSV: `sx1,sy1,sx2,sy2,dx1,dy1,dx2,dy2[,weight]`. A segment of no length or a weight that is not
/// above 0 is an error, and so is a file without a pair.
inline Expected<PairTable> readCsvPairs(std::istream &in, std::string name) {
    CsvReader csv(in, std::move(name),
                  {{"sx1", "sy1", "sx2", "sy2", "dx1", "dy1", "dx2", "dy2"}, {"weight"}});
    PairTable table;
    while (const auto *row = csv.next()) {
        const std::vector<double> &r = *row;
        SegmentPair pair;
        pair.fixed = {{r[0], r[1]}, {r[2], r[3]}};
        pair.moving = {{r[4], r[5]}, {r[6], r[7]}};
        table.hasWeights = csv.hasOptional(0);
        if (table.hasWeights)
            pair.weight = r[8];
        for (const LineSegment2D<double> &s : {pair.fixed, pair.moving})
            if (!(s.direction().squaredNorm() > 0.5 && std::isfinite(s.length())))
                return csv.errorHere("a segment of no length or beyond all measure",
                                     "two distinct end points");
        if (!(pair.weight > 0))
            return csv.errorHere("a weight of " + std::to_string(pair.weight), "a weight above 0");
        table.pairs.push_back(pair);
    }
    if (csv.error())
        return *csv.error();
    if (table.pairs.empty())
        return csv.errorHere("the end of the file and no pair", "at least one pair of segments");
    return table;
}

} // namespace vectorlib
