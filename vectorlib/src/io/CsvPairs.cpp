#include "vectorlib/io/CsvPairs.h"

#include "vectorlib/io/Csv.h"

namespace vectorlib {

VECTORLIB_BODY Expected<PairTable> readCsvPairs(std::istream &in, std::string name) {
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
