#pragma once

#include "vectorlib/experiments/Calibration.h"
#include "vectorlib/experiments/PlaceTrial.h"

namespace hermes::experiments {

/// How well PlaceTrust says which places of trials are right.
struct PlaceTrustQuality {
    /// Mean of -ln of the probability of what is right: one of the places, or none. Trials of other buildings
    /// weigh six times.
    double loss = 0;
    std::size_t trials = 0, found = 0, wrong = 0; ///< found and wrong at a probability of 0.9
    /// Of the first places, by the probability that was told.
    CalibrationTenths tenths;
};

/// The weights of the greatest likelihood (multinomial logistic, Newton's method); trials of other buildings
/// weigh six times. All else is as in the trust to begin with.
vectorlib::PlaceTrust fittedTrust(const std::vector<PlaceTrial> &trials, vectorlib::PlaceTrust trust);
PlaceTrustQuality qualityOf(const vectorlib::PlaceTrust &trust, const std::vector<PlaceTrial> &trials);

/// What fittedTrust gives from the first half of trials, and how well it and the present weights do on the
/// second half, in all and by set.
nlohmann::ordered_json trustSummary(const std::vector<PlaceTrial> &trials);

} // namespace hermes::experiments
