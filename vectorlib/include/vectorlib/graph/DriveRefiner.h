#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/PackedPoints.h"
#include "vectorlib/geometry/Pose2D.h"
#include "vectorlib/geometry/SegmentGrid.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/graph/PoseGraph.h"
#include "vectorlib/registration/PointRefinement.h"
#include "vectorlib/registration/RegistrationCovariance.h"

#include <functional>
#include <optional>
#include <vector>

namespace vectorlib {

/// Settings of DriveRefiner: which scans it matches, which matches count, and how far the drive is trusted.
struct DriveRefinerSettings {
    double keyWay = 0.5, keyTurn = 0.3; ///< between key scans; metres, radians
    /// Key scans that are nearer and less turned from each other are compared; metres, radians.
    double reach = 2, maxTurn = 1;
    double leastWay = 8;     ///< of the drive between them; metres
    std::size_t perScan = 2; ///< earlier passes that a key scan is compared with
    double passWay = 2;      ///< of the drive between two passes; metres
    /// What a match needs to count; see PointAgreement.
    double minExplained = 0.6, maxContradicted = 0.1;
    double maxXY = 0.3, maxAlpha = 0.1; ///< what it may be off the poses; metres, radians
    /// Standard deviations that a match has beside its own; metres, radians.
    double matchedXY = 0.01, matchedAlpha = 0.003;
    /// With which the way from scan to scan stays as it is: of a metre, and of a radian; metres, radians.
    double keptXY = 0.04, keptAlpha = 0.014, keptTurn = 0.02;
};

/// Makes the poses of a drive whose loops are closed more exact: scans that lie near each other are matched
/// anew by their points, from where they are, and all poses move so that they fit. Each scan is matched with
/// the key scan before it, each key scan with those of earlier passes. It refines: poses that are off by more
/// than maxXY stay off.
class DriveRefiner {
public:
    DriveRefinerSettings settings;
    PointRefinement match;
    PointCovariance tellCovariance;

    /// The next scan of the drive: its points in the sensor's frame, in the order of ScanOrder, and the
    /// motion since the scan before as it was tracked (of no meaning for the first); metres, radians.
    void add(PointSpan<float> points, const Transformation2D &tracked);
    /// Moves the poses, one for each scan that was added (metres, radians). `loops` are motions between scans
    /// that were found before, with their weights. False, and the poses are as before, where there are not as
    /// many poses as scans or the equations cannot be solved. The first pose stays. progress counts key scans
    /// that are compared with earlier ones, which takes most of the time.
    bool operator()(std::vector<Pose2D> &poses, const std::vector<PoseConstraint> &loops,
                    const std::function<void(std::size_t done, std::size_t all)> &progress = {});

private:
    struct Scan {
        std::size_t number;
        PointSpan<float> points;
    };
    struct Key {
        std::size_t scan;
        double way; // since the start of the drive; metres
        PackedPoints points;
    };
    struct Candidate {
        double apart; // metres, and half of the radians
        std::size_t key;
    };

    // Nothing where the points do not agree well.
    std::optional<PoseConstraint> measured(const Scan &from, const Scan &to,
                                           const Transformation2D &expected);
    void take(const PoseConstraint &c);
    Transformation2D motionBetween(std::size_t from, std::size_t to) const {
        return Transformation2D(graph_.poses[from]).inverse() * Transformation2D(graph_.poses[to]);
    }
    void keepWay();
    void comparePasses(const std::function<void(std::size_t, std::size_t)> &progress);
    // The nearest key scans of earlier passes, one of each pass.
    void compareWithNearest(std::size_t key, SegmentGrid &grid);
    void findCandidates(std::size_t key, SegmentGrid &grid);

    std::size_t scans_ = 0;
    double way_ = 0;         // since the start of the drive; metres
    Transformation2D since_; // motion since the last key scan
    std::vector<Key> keys_;
    std::vector<Vector2D<float>> keyPoints_, earlier_; // of the key scan at hand, and of one before it
    std::vector<PoseConstraint> nexts_;                // from each scan's key scan to it
    PoseGraph graph_;                                  // a pose each scan
    std::vector<Candidate> candidates_;
    std::vector<double> passes_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/graph/DriveRefiner.cpp")
