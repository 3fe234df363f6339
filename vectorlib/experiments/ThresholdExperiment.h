#pragma once

#include "vectorlib/experiments/Plot.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/io/Svg.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

namespace hermes::experiments {

/// The problem of a threshold, thesis 6.1.4: a sharp corner of two edges of 1 m, precise and with noise of 2
/// cm in both coordinates, 50 points an edge.
class ThresholdExperiment {
public:
    static constexpr std::size_t corner = 50; ///< the first point of the second edge
    static constexpr double noise = 0.02;     ///< metres
    static constexpr double threshold = 0.04; ///< of sigma, a defensive choice: twice the noise; metres

    explicit ThresholdExperiment(std::uint64_t seed);

    /// Sigma of the first n points from their line, for n from 2: figure 6.2.
    void writeCsv(std::ostream &out) const;
    Plot errorPlot() const;
    /// Figure 6.1: both clouds.
    vectorlib::SvgPicture pictureOfClouds() const;
    /// Figure 6.3: the two lines of INC, and those with the least error.
    vectorlib::SvgPicture pictureOfLines() const;
    /// Where the lines of each algorithm change, their error, and by how much the first one is turned.
    nlohmann::ordered_json summary() const;

private:
    using Points = std::vector<vectorlib::Vector2D<double>>;
    struct Vectorization {
        std::string name;
        std::vector<vectorlib::LineSegment2D<double>> segments;
        std::size_t breakPoint = 0; ///< the first point of the second line
        double rms = 0;             ///< the root of E (6.27); metres
        double turned = 0;          ///< the first line against its edge; degrees
    };

    Points precise_, noised_;
    std::vector<double> preciseErrors_, noisedErrors_; ///< by n, from 2
    std::vector<Vectorization> vectorizations_;        ///< of the noised cloud; INC first, the optimum last
};

} // namespace hermes::experiments
