#pragma once

#include "common/world/World.h"
#include "vectorlib/experiments/ScanPairs.h"
#include "vectorlib/experiments/VectorizationExperiment.h"

#include <Eigen/Core>

namespace hermes::experiments {

/// What many registrations at one pose came to. Lengths in metres, angles in radians. Ambiguities are divided
/// by the weight of the pairs, so that those with and without weights can be compared.
struct RegistrationStatistics {
    int runs = 0;              ///< scans
    int unsolved = 0;          ///< of those, without a result; all else is of the others
    double ambiguityXY = 0;    ///< mean A_t; m^2
    double ambiguityAlpha = 0; ///< mean A_alpha; rad^2
    double errorXY = 0;        ///< mean squared distance from the true position, D_t; m^2
    double errorAlpha = 0;     ///< the same of the heading, D_alpha; rad^2
    double reliability = 0;    ///< mean over all scans, 0 for the unsolved
    double leastReliability = 1;
    std::vector<double> reliabilities; ///< of each scan
    double pairs = 0;                  ///< mean number of segments that took part
    Eigen::Vector3d mean =
        Eigen::Vector3d::Zero(); ///< of the errors x, y, alpha, in the frame of the true pose
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero(); ///< their covariance

    /// The part of errorXY that is left when many scans are averaged, without what chance leaves of so many;
    /// m^2. The other part falls with the number of scans.
    double biasXY() const;
    double biasAlpha() const; ///< the same of errorAlpha; rad^2
};

/// One pose of a world, at one setting of the scanner.
struct RegistrationRow {
    std::string world;
    std::size_t pose = 0;
    vectorlib::Pose2D at{0, 0, 0};
    int points = 0;   ///< rays of a scan, P
    double sigma = 0; ///< noise of the range; metres
    bool weighted = false;
    RegistrationStatistics result;
};

struct RegistrationCase {
    std::vector<int> points;
    std::vector<double> sigmas;
    double minLength = 0; ///< shorter segments take no part; metres
    Pairing pairing = Pairing::Extracted;
};

/// How many points of scans take part, each with one noise.
std::size_t stepsOf(const World &world, const RegistrationCase &which, const ExperimentOptions &options);

/// Localization in a known map with known correspondences (paper 4): every pose of the world, with every
/// number of points and noise, each without and with weights (length of the shorter segment) on the same
/// scans.
std::vector<RegistrationRow> registrationExperiment(const World &world, const RegistrationCase &which,
                                                    const ExperimentOptions &options);

void writeCsv(std::ostream &out, const std::vector<RegistrationRow> &rows);

/// Paper figure 6: A and D over the number of points, a curve for each noise; without weights.
std::vector<Plot> accuracyPlots(const std::vector<RegistrationRow> &rows);
/// Paper figures 7 and 8: the world with a two-sigma ellipse of the position and the range of headings at
/// every pose; rows of one world and one setting. `scale` enlarges the ellipses and angles: 1 is to scale.
Plot dispersionPlot(const World &world, const std::vector<RegistrationRow> &rows, const std::string &name,
                    double scale);
/// Paper figure 9: a circle at every pose, and inside it those whose areas are the reliabilities of the
/// scans. In colours of their own the lowest one of a scan that has a solution, and small circles where scans
/// have none.
Plot reliabilityPlot(const World &world, const std::vector<RegistrationRow> &rows);

} // namespace hermes::experiments
