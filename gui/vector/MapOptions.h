#pragma once

#include "gui/vector/MapSource.h"
#include "gui/vector/Options.h"
#include "vectorlib/vectorization/VectorizedLine.h"

namespace hermes::vector {

/// The command line of hermes-vector map.
struct MapOptions {
    MapSourceOptions source;
    std::string odometry = "use";
    std::string sensor;   ///< its pose on the robot, as text; empty: as the log tells
    std::string localize; ///< a map; empty: one is built
    std::string outMap, outTrajectory, outGraph, outTrust;
    std::string loops = "close";
    std::string summary, svg;
    std::optional<std::size_t> onlyScan;
    bool force = false;
    SegmentOptions segment;
    double sigma = vectorlib::VectorizerSettings().sigma;

    void addTo(CLI::App &command);
    bool isSigmaGiven() const { return sigmaOption_->count() > 0; }

private:
    void addInput(CLI::App &command);
    void addFiles(CLI::App &command);
    void addWays(CLI::App &command);

    const CLI::Option *sigmaOption_ = nullptr;
};

} // namespace hermes::vector
