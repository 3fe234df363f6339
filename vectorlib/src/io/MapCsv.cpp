#include "vectorlib/io/MapCsv.h"

#include "vectorlib/io/Csv.h"
#include "vectorlib/io/Number.h"

namespace vectorlib {

VECTORLIB_BODY void writeMapCsv(std::ostream &out, const std::vector<MapEdge> &map) {
    out << "id,x1,y1,x2,y2,n,sigma,observations,mean_x,mean_y,xx,xy,yy\n";
    for (const MapEdge &m : map) {
        out << m.id;
        for (const double v :
             {m.segment.begin().x, m.segment.begin().y, m.segment.end().x, m.segment.end().y})
            out << ',' << Number(micrometres(v));
        out << ',' << Number(m.sums.n) << ',' << Number(micrometres(m.sigma)) << ',' << m.observations;
        for (const double v : {m.sums.mean.x, m.sums.mean.y})
            out << ',' << Number(micrometres(v));
        for (const double v : {m.sums.xx, m.sums.xy, m.sums.yy})
            out << ',' << Number(rounded(v, decimalsOfSums(m.sums.n)));
        out << '\n';
    }
}

VECTORLIB_BODY Expected<std::vector<MapEdge>> readMapCsv(std::istream &in, std::string name) {
    CsvReader csv(
        in, std::move(name),
        {{"id", "x1", "y1", "x2", "y2", "n", "sigma", "observations", "mean_x", "mean_y", "xx", "xy", "yy"},
         {}});
    std::vector<MapEdge> map;
    constexpr double farthest = 1.1e7; // all of UTM, and what a robot sees and drives from its ends
    const auto isWhole = [](double v) { return v >= 0 && v < 9007199254740992.0 && v == std::floor(v); };
    while (const auto *row = csv.next()) {
        const std::vector<double> &r = *row;
        if (!isWhole(r[0]) || !isWhole(r[7]))
            return csv.errorHere("an id or a number of observations that is not a whole number",
                                 "whole numbers from 0");
        for (const std::size_t column : {5, 6, 10, 12})
            if (r[column] < 0)
                return csv.errorHere("a negative n, sigma, xx or yy", "numbers from 0");
        for (const std::size_t column : {1, 2, 3, 4, 8, 9})
            if (std::abs(r[column]) > farthest)
                return csv.errorHere("a coordinate beyond 11,000 km", "metres in the map's frame");
        for (const std::size_t column : {5, 6, 10, 11, 12})
            if (std::abs(r[column]) > 1e18)
                return csv.errorHere("an n, sigma, xx, xy or yy beyond 1e18",
                                     "what points of a map add up to");
        MapEdge m;
        m.id = static_cast<std::int64_t>(r[0]);
        m.segment = {{r[1], r[2]}, {r[3], r[4]}};
        m.sums.n = r[5];
        m.sigma = r[6];
        m.observations = static_cast<std::int64_t>(r[7]);
        m.sums.mean = {r[8], r[9]};
        m.sums.xx = r[10];
        m.sums.xy = r[11];
        m.sums.yy = r[12];
        map.push_back(m);
    }
    if (csv.error())
        return *csv.error();
    return map;
}

} // namespace vectorlib
