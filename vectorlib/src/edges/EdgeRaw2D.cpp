#include "vectorlib/edges/EdgeRaw2D.h"
#include "vectorlib/tls/TlsFit.h"

#include <algorithm>
#include <cmath>

namespace vectorlib {

VECTORLIB_BODY EdgeRaw2D merged(const EdgeRaw2D &edge, const EdgeRaw2D &other) {
    EdgeRaw2D result(edge.sums + other.sums, edge.segment, edge.sigma);
    const TlsLine fit = fitLine(result.sums);
    if (!fit.line.isValid())
        return result;
    Vector2D<double> direction = fit.line.direction();
    if (direction.dot(edge.segment.direction()) < 0)
        direction = -direction;
    double from = 0, to = 0;
    const Vector2D<double> &mean = result.sums.mean;
    for (Vector2D<double> p :
         {edge.segment.begin(), edge.segment.end(), other.segment.begin(), other.segment.end()}) {
        const double t = (p - mean).dot(direction);
        from = std::min(from, t);
        to = std::max(to, t);
    }
    result.segment = {mean + direction * from, mean + direction * to, direction};
    result.sigma = std::sqrt(fit.variance);
    return result;
}

} // namespace vectorlib
