#include "vectorlib/places/PlaceFit.h"

#include "vectorlib/geometry/SmallMatrix.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace vectorlib {

VECTORLIB_BODY double PlaceFit::leadOver(const PlaceFit &other) const {
    double sum = 0, strongest = 0;
    for (std::size_t i = 0; i + 1 < said.size(); ++i) {
        const double more = said[i] - other.said[i];
        sum += more;
        strongest = std::max(strongest, more);
    }
    const double byHidden = std::min(said.back() - other.said.back(), mostHiddenLead * points);
    return points > 0 ? (sum - strongest + byHidden) / points : 0;
}

VECTORLIB_BODY double PlaceFit::reliability() const {
    const double xx = information(0, 0), yy = information(1, 1), xy = information(1, 0);
    return xx + yy > 0 ? 2 * std::sqrt(std::max(0.0, xx * yy - xy * xy)) / (xx + yy) : 0;
}

VECTORLIB_BODY std::optional<Eigen::Matrix3d> PlaceFit::covariance() const {
    if (!(reliability() > 1e-3))
        return std::nullopt;
    const Eigen::Matrix3d c = information.inverse() * (4 * std::max(meanSquare(), 0.02 * 0.02));
    return c.allFinite() && c(2, 2) > 0 ? std::optional<Eigen::Matrix3d>(c) : std::nullopt;
}

} // namespace vectorlib
