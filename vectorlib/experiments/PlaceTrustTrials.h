#pragma once

#include "vectorlib/experiments/DrawnPlaces.h"
#include "vectorlib/experiments/PlacesExperiment.h"

namespace hermes::experiments {

/// The trials to which PlaceTrust is fitted, in two halves. Of logs: scans in the map of every other scan, in
/// maps of the other logs and in a map that odometry and matching made, which drifts and has walls twice. Of
/// `other`, if any: scans in the maps of the logs only. Of worlds and floor plans: scans in their own maps,
/// after some of the furniture was moved, and in maps of others. Halves are blocks of 50 scans of a log; of
/// floor plans every other one, of scans in a world half.
std::vector<PlaceTrial> placeTrustTrials(const std::vector<vectorlib::CarmenLog> &logs,
                                         const vectorlib::CarmenLog *other, const std::vector<World> &worlds,
                                         const ExperimentOptions &options);

} // namespace hermes::experiments
