#pragma once

#include "vectorlib/correspondence/CorrespondenceTracker.h"
#include "vectorlib/edges/EdgeExtractor.h"
#include "vectorlib/mapping/GlobalPairMatcher.h"
#include "vectorlib/registration/PointRefinement.h"

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
    bool searchAnywhere = false; ///< at first, whatever is expected; see GlobalPairMatcher

    /// For an expected motion that is hardly more than a guess: without odometry.
    static ScanPairSettings forPoorExpectation() {
        ScanPairSettings s;
        s.searchAnywhere = true;
        s.deviationXY = 1;
        s.deviationAlpha = 0.5;
        s.lines = s.wideLines;
        s.maxContradicted = 0.10;
        s.minReliability = 0.6; // nothing else says how far the sensor went along a corridor
        return s;
    }
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
                                    const Transformation2D &expected) {
        fixedEdges_ = extract(fixed);
        return (*this)(fixed, fixedEdges_, moving, extract(moving), expected);
    }
    /// The same for scans whose edges are known.
    const ScanPairMatch &operator()(PointSpan<float> fixed, const std::vector<EdgeRaw2D> &fixedEdges,
                                    PointSpan<float> moving, const std::vector<EdgeRaw2D> &movingEdges,
                                    const Transformation2D &expected) {
        fixedSegments_.clear();
        for (const EdgeRaw2D &edge : fixedEdges)
            fixedSegments_.push_back(edge.segment);
        expected_ = {expected, settings.deviationXY, settings.deviationAlpha};
        refine.start(fixed, moving);
        match_ = ScanPairMatch();
        match_.byLines = expected;
        if (settings.searchAnywhere && isFoundAnywhere(fixed, moving))
            return match_;

        track_.settings = settings.lines;
        const Match &lines = track_(fixedSegments_, movingEdges, expected);
        match_.linesSuffice = lines.accepted && lines.reliability >= settings.lineReliability;
        if (lines.accepted)
            match_.byLines = lines.pose;
        take(refine(match_.byLines, expected_));
        if (!isGood())
            searchWidely(movingEdges, lines.pose);
        match_.accepted = isAcceptable() && !(settings.searchAnywhere && isOutvoted());
        if (settings.searchAnywhere && !match_.accepted)
            takeBestOfAnywhere();
        return match_;
    }

private:
    bool isFoundAnywhere(PointSpan<float> fixed, PointSpan<float> moving) {
        anywhere_ = &matchAnywhere_(fixed, moving);
        if (anywhere_->isAccepted())
            takeBestOfAnywhere();
        return match_.accepted = anywhere_->isAccepted();
    }
    // Found near a poor expectation, while more speaks for a place elsewhere.
    bool isOutvoted() const {
        if (anywhere_->solutions.empty())
            return false;
        const Transformation2D off = anywhere_->solutions.front().pose.inverse() * match_.pose;
        return off.translation().norm() > matchAnywhere_.settings.farXY ||
               std::abs(off.alpha()) > matchAnywhere_.settings.farAlpha;
    }
    void takeBestOfAnywhere() {
        if (!anywhere_->solutions.empty())
            take(anywhere_->solutions.front().pose);
    }
    void searchWidely(const std::vector<EdgeRaw2D> &edges, const Transformation2D &byLines) {
        const double gate = settings.wideGate;
        match_.searchedAgain = true;
        consider(refine(byLines, expected_, gate));
        consider(refine(expected_.pose, expected_, gate));
        consider(refine(Transformation2D(0, 0, expected_.pose.alpha()), expected_, gate)); // wheels that slip
        track_.settings = settings.wideLines;
        const Match &lines = track_(fixedSegments_, edges, expected_.pose);
        consider(refine(lines.pose,
                        {expected_.pose, settings.wideLines.expectedDeviationXY,
                         settings.wideLines.expectedDeviationAlpha},
                        gate));
    }
    void take(const Transformation2D &pose) {
        match_.pose = pose;
        match_.agreement = refine.agreement(pose);
        worth_ = match_.agreement.score() - settings.expectationCost * surprise(pose);
    }
    void consider(const Transformation2D &pose) {
        const double before = worth_;
        const ScanPairMatch kept = match_;
        take(pose);
        if (!(worth_ > before)) {
            match_ = kept;
            worth_ = before;
        }
    }
    // How far from the expected motion, in standard deviations, squared.
    double surprise(const Transformation2D &pose) const {
        const Transformation2D off = expected_.pose.inverse() * pose;
        const double xy = off.translation().norm() / expected_.deviationXY;
        const double alpha = off.alpha() / expected_.deviationAlpha;
        return xy * xy + alpha * alpha;
    }
    bool isGood() const {
        return match_.agreement.explained() >= settings.enoughExplained &&
               match_.agreement.contradicted() <= settings.fewContradicted;
    }
    bool isAcceptable() const {
        const double surprising = settings.surprising * settings.surprising;
        return match_.agreement.explainedPoints() >= settings.minPoints &&
               match_.agreement.explained() >= settings.minExplained &&
               match_.agreement.contradicted() <= settings.maxContradicted &&
               match_.agreement.reliability() >= settings.minReliability &&
               (isGood() || surprise(match_.pose) <= surprising);
    }

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
