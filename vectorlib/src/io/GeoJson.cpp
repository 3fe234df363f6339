#include "vectorlib/io/GeoJson.h"

#include "vectorlib/io/Number.h"

namespace vectorlib {

VECTORLIB_BODY void writeGeoJson(std::ostream &out, const std::vector<MapEdge> &map) {
    out << "{\"type\": \"FeatureCollection\", \"units\": \"metres in the frame of the map\", \"features\": [";
    const char *separator = "\n";
    for (const MapEdge &m : map) {
        const auto a = m.segment.begin(), b = m.segment.end();
        out << separator << R"({"type": "Feature", "id": )" << m.id
            << R"(, "geometry": {"type": "LineString", "coordinates": [[)" << Number(a.x) << ", "
            << Number(a.y) << "], [" << Number(b.x) << ", " << Number(b.y) << R"(]]}, "properties": {"n": )"
            << Number(m.sums.n) << R"(, "sigma": )" << Number(m.sigma) << R"(, "observations": )"
            << m.observations << "}}";
        separator = ",\n";
    }
    out << "\n]}\n";
}

} // namespace vectorlib
