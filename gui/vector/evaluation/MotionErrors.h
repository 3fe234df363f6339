#pragma once

#include "vectorlib/geometry/Transformation2D.h"

#include <nlohmann/json.hpp>

#include <vector>

namespace hermes::vector {

/// How far motions are from those of a reference.
class MotionErrors {
public:
    void add(const vectorlib::Transformation2D &reference, const vectorlib::Transformation2D &found) {
        const vectorlib::Transformation2D difference = reference.inverse() * found;
        metres_.push_back(difference.translation().norm());
        degrees_.push_back(std::abs(difference.alpha()) * 180 / vectorlib::pi);
    }
    std::size_t size() const { return metres_.size(); }
    /// Of the motion that was added last; metres.
    double lastMetres() const { return metres_.back(); }

    /// Mean, median and 95th percentile in metres and degrees, and the share within 10 cm and 2 degrees; null
    /// where there are none.
    nlohmann::ordered_json summary() const;

private:
    std::vector<double> metres_, degrees_;
};

} // namespace hermes::vector
