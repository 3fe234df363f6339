#include "vectorlib/io/Dxf.h"

#include "vectorlib/io/Number.h"

namespace vectorlib {

VECTORLIB_BODY void writeDxf(std::ostream &out, const std::vector<MapEdge> &map) {
    out << "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1009\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n";
    for (const MapEdge &m : map) {
        const auto a = m.segment.begin(), b = m.segment.end();
        out << "0\nLINE\n8\nMAP\n10\n"
            << Number(a.x) << "\n20\n"
            << Number(a.y) << "\n30\n0\n11\n"
            << Number(b.x) << "\n21\n"
            << Number(b.y) << "\n31\n0\n";
    }
    out << "0\nENDSEC\n0\nEOF\n";
}

} // namespace vectorlib
