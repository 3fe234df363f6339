#include "vectorlib/graph/ScanSignature.h"

#include <algorithm>
#include <cmath>

namespace vectorlib {

VECTORLIB_BODY ScanSignature::ScanSignature(PointSpan<float> points) {
    constexpr float nearest = 0.5F, growth = 1.3F; // metres
    const float perStep = 1 / std::log(growth);
    for (const Vector2D<float> &p : points) {
        const float r = std::hypot(p.x, p.y);
        const float step = r > nearest ? std::log(r / nearest) * perStep : 0;
        const float at = step < float(last) ? step : float(last) - 0.001F;
        const auto i = static_cast<std::size_t>(at);
        parts_[i] += float(i + 1) - at;
        parts_[i + 1] += at - float(i);
    }
    const auto count = static_cast<float>(std::max<std::size_t>(1, points.size()));
    for (float &part : parts_)
        part = std::sqrt(part / count);
}

VECTORLIB_BODY float ScanSignature::distance(const ScanSignature &other) const {
    float sum = 0;
    for (std::size_t i = 0; i < parts_.size(); ++i)
        sum += std::abs(parts_[i] - other.parts_[i]);
    return sum;
}

} // namespace vectorlib
