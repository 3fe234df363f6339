#pragma once

#include "vectorlib/experiments/Scene.h"
#include "vectorlib/io/Svg.h"

#include "vectorlib/segmentation/EarSegmenter.h"

#include <cstdint>
#include <ostream>
#include <vector>

namespace hermes::experiments {

/// One panel of thesis figures 5.6 and 5.7: a scan with noise and outliers, and what the segmentation made of
/// it.
struct SegmentationPanel {
    double noise = 0;        ///< standard deviation of the range; metres
    double outlierShare = 0; ///< of the rays
    std::size_t points = 0;
    std::size_t clustersTrue = 0; ///< of the scan without noise and outliers
    std::size_t clusters = 0;
    std::size_t outliersTrue = 0;  ///< points farther than 4 sigma from every edge
    std::size_t outliersFound = 0; ///< of those, left out
    std::size_t pointsLost = 0;    ///< other points that were left out
    std::vector<vectorlib::Vector2D<float>> scan;
    std::vector<int> labels;
};

/// One panel of figures 5.3 and 5.4: the adaptive threshold with and without its bounds.
struct AdaptiveThresholdPanel {
    std::string name; ///< in file names
    std::string title;
    Scene scene;
    vectorlib::EarSettings settings;
    SegmentationPanel panel;
};

/// Nine panels: noise of 1, 3 and 6 cm by 0, 10 and 20 % outliers; 2,000 rays, the settings of thesis 5.3.
std::vector<SegmentationPanel> segmentationExperiment(const Scene &scene, std::uint64_t seed);

/// A wall so near that the threshold is less than the noise, without and with the lower bound; and posts
/// before a far wall, among outliers, without and with the upper one. 2,000 rays, noise of 1 cm.
std::vector<AdaptiveThresholdPanel> adaptiveThresholdExperiment(std::uint64_t seed);

void writeCsv(std::ostream &out, const std::vector<SegmentationPanel> &panels);
void writeCsv(std::ostream &out, const std::vector<AdaptiveThresholdPanel> &panels);
/// Clusters in colours, outliers in red, the true edges beneath.
vectorlib::SvgPicture pictureOf(const Scene &scene, const SegmentationPanel &panel);
vectorlib::SvgPicture pictureOf(const AdaptiveThresholdPanel &panel);

} // namespace hermes::experiments
