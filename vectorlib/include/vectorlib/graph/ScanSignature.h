#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/PointSpan.h"

#include <array>

namespace vectorlib {

/// How a scan looks from afar: how its points are distributed over ranges that grow by 30 % from step to
/// step, from half a metre on. The same however the sensor is turned, as far as it sees the same then.
class ScanSignature {
public:
    ScanSignature() = default;
    explicit ScanSignature(PointSpan<float> points);
    /// 0 where two scans look the same; about 1 where they are of different places.
    float distance(const ScanSignature &other) const;

private:
    static constexpr std::size_t last = 19; // 73 m and more
    std::array<float, last + 1> parts_{};
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/graph/ScanSignature.cpp")
