#pragma once

#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/io/Svg.h"
#include "vectorlib/mapping/TimedScan.h"
#include "vectorlib/segmentation/EarSegmenter.h"

#include <string>
#include <vector>

namespace hermes::experiments {

/// Which scan of a log or capture an experiment shows, by the lines that FTLS finds in it.
enum class RealScanKind {
    EmptyRoom, ///< long lines in all directions: thesis figure 6.11
    Corridor,  ///< long lines in one direction: figure 6.12
    Laboratory ///< the most lines: figure 6.13
};

constexpr double realScanSigma = 0.02; ///< metres, as in thesis 6.5.2

/// A scan with its clusters; empty where none was chosen.
struct RealScan {
    std::size_t number = 0; ///< among those of its log, from 0
    std::vector<std::vector<vectorlib::Vector2D<float>>> clusters;
    std::vector<vectorlib::Vector2D<float>> outliers;
    std::vector<vectorlib::LineSegment2D<double>> segments; ///< of FTLS

    std::size_t points() const; ///< in clusters
};

/// Chooses of many scans the one of each kind. Scans with returns in clusters on half of their rays come
/// before all others; those with less than ten points there are not looked at.
class RealScanChoice {
public:
    explicit RealScanChoice(const std::vector<RealScanKind> &kinds);

    void take(std::size_t number, const vectorlib::TimedScan &scan);
    /// Of the kind that was given there.
    const RealScan &best(std::size_t kind) const { return best_[kind].scan; }

private:
    struct Best {
        RealScanKind kind;
        bool isFull = false; ///< with returns on half of its rays
        double score = -1;
        RealScan scan = {};
    };
    std::vector<Best> best_;
    vectorlib::EarSegmenter<float> segment_;
};

/// Thesis figure 5.5: clusters in colours, outliers in black.
vectorlib::SvgPicture pictureOfClusters(const std::string &title, const RealScan &scan);

} // namespace hermes::experiments
