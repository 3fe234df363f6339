#include "vectorlib/observation/Sector.h"

namespace vectorlib {

VECTORLIB_BODY double turnOf(Vector2D<double> d) {
    const double up = std::abs(d.y);
    const double turn = d.x >= 0 ? up / (d.x + up) : 2 - up / (up - d.x);
    return d.y < 0 ? -turn : turn;
}

VECTORLIB_BODY SightLine::SightLine(Vector2D<double> begin, Vector2D<double> end) {
    normal = -(end - begin).normalized().left();
    distance = normal.dot(begin);
    if (distance < 0) {
        normal = -normal;
        distance = -distance;
    }
}

VECTORLIB_BODY double compareDistance(const SightLine &a, const SightLine &b, Vector2D<double> direction) {
    const double left = a.distance * b.normal.dot(direction), right = b.distance * a.normal.dot(direction);
    const double difference = left - right;
    return std::abs(difference) > 1e-13 * (left + right) ? difference : 0;
}

} // namespace vectorlib
