#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/correspondence/CorrespondenceTracker.h"
#include "vectorlib/correspondence/Match.h"
#include "vectorlib/edges/EdgeExtractor.h"
#include "vectorlib/edges/EdgeRaw2D.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/mapping/GlobalPairMatcher.h"
#include "vectorlib/registration/PointRefinement.h"
#include "vectorlib/registration/ScanIndex.h"

#include <algorithm>
#include <array>
#include <vector>

namespace vectorlib {

/// Settings of ScanPairMatcher: how far it trusts the expected motion, and what a match needs to be accepted.
struct ScanPairSettings {
    double deviationXY = 0.15;    ///< of the expected motion, a standard deviation; metres
    double deviationAlpha = 0.10; ///< the same; radians
    TrackingSettings lines;       ///< of the first search
    /// A match with fewer points explained or more contradicted is searched for again, more widely.
    double enoughExplained = 0.5, fewContradicted = 0.10;
    TrackingSettings wideLines = TrackingSettings::forPoorExpectation(); ///< of lines in the wider search
    double wideGate = 0.5;          ///< of points in the wider search; metres
    double expectationCost = 0.002; ///< in score, of one squared standard deviation from the expected motion
    /// What a match needs to be accepted; see PointAgreement.
    double minPoints = 10, minExplained = 0.3, maxContradicted = 0.25, minReliability = 0;
    /// A match that is farther from the expected motion needs as much as one that is not searched for again;
    /// standard deviations.
    double surprising = 4;
    /// Below this reliability of the paired lines the points decide alone; thesis appendices.
    double lineReliability = 0.1;
    /// Shares of the walls that face a direction: with less the expected motion stands there, with more the
    /// scans tell it alone.
    double unknownShare = 0.03, knownShare = 0.12;
    bool leavesOpen = true;      ///< false: the scans tell it all, as nothing else does
    bool searchAnywhere = false; ///< at first, whatever is expected; see GlobalPairMatcher

    /// For an expected motion that is hardly more than a guess: without odometry.
    static ScanPairSettings forPoorExpectation();
};

/// The motion between two scans.
struct ScanPairMatch {
    Transformation2D pose; ///< of the second scan's sensor in the frame of the first
    bool accepted = false; ///< false: the best found, not to be trusted
    PointAgreement agreement;
    Transformation2D byLines;  ///< the same from the lines alone; the expected motion where they say nothing
    bool linesSuffice = false; ///< the lines alone fix the motion in all directions
    bool searchedAgain = false;
};

/// Finds the motion between two scans: lines first, which reach far, then the points themselves, which also
/// know round and cluttered places. How well the points of each scan lie on the other one tells whether to
/// trust the result, to search again more widely, or to refuse. Keeps its buffers between calls.
class ScanPairMatcher {
public:
    ScanPairSettings settings;
    EdgeExtractor extract; ///< its segmentation is to be set up for the scanner
    PointRefinement refine;

    /// Both scans in their sensor's frame, in the order of ScanOrder; metres. `expected` is the motion as far
    /// as it is known, from odometry.
    const ScanPairMatch &operator()(PointSpan<float> fixed, PointSpan<float> moving,
                                    const Transformation2D &expected);
    /// The same for scans whose edges are known.
    const ScanPairMatch &operator()(PointSpan<float> fixed, const std::vector<EdgeRaw2D> &fixedEdges,
                                    PointSpan<float> moving, const std::vector<EdgeRaw2D> &movingEdges,
                                    const Transformation2D &expected);

    /// The last one.
    const ScanPairMatch &match() const { return match_; }

private:
    // In the direction of which the walls tell too little the expected motion stands.
    void leaveOpen();
    bool isFoundAnywhere(PointSpan<float> fixed, PointSpan<float> moving);
    // Found near a poor expectation, while more speaks for a place elsewhere.
    bool isOutvoted() const;
    void takeBestOfAnywhere();
    void searchWidely(const std::vector<EdgeRaw2D> &edges, const Transformation2D &byLines);
    void take(const Transformation2D &pose);
    void consider(const Transformation2D &pose);
    // How far from the expected motion, in standard deviations, squared.
    double surprise(const Transformation2D &pose) const;
    bool isGood() const {
        return match_.agreement.explained() >= settings.enoughExplained &&
               match_.agreement.contradicted() <= settings.fewContradicted;
    }
    bool isAcceptable() const;

    CorrespondenceTracker track_;
    GlobalPairMatcher matchAnywhere_;
    const GlobalPairMatch *anywhere_ = nullptr;
    Expectation expected_;
    std::vector<EdgeRaw2D> fixedEdges_;
    std::vector<LineSegment2D<double>> fixedSegments_;
    ScanPairMatch match_;
    double worth_ = 0;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/mapping/ScanPairMatcher.cpp")
