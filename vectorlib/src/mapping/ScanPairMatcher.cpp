#include "vectorlib/mapping/ScanPairMatcher.h"

#include <cmath>

namespace vectorlib {

VECTORLIB_BODY ScanPairSettings ScanPairSettings::forPoorExpectation() {
    ScanPairSettings s;
    s.searchAnywhere = true;
    s.deviationXY = 1;
    s.deviationAlpha = 0.5;
    s.lines = s.wideLines;
    s.maxContradicted = 0.10;
    s.minReliability = 0.6; // nothing else says how far the sensor went along a corridor
    return s;
}

VECTORLIB_BODY const ScanPairMatch &ScanPairMatcher::operator()(PointSpan<float> fixed,
                                                                PointSpan<float> moving,
                                                                const Transformation2D &expected) {
    fixedEdges_ = extract(fixed);
    return (*this)(fixed, fixedEdges_, moving, extract(moving), expected);
}

VECTORLIB_BODY const ScanPairMatch &ScanPairMatcher::operator()(PointSpan<float> fixed,
                                                                const std::vector<EdgeRaw2D> &fixedEdges,
                                                                PointSpan<float> moving,
                                                                const std::vector<EdgeRaw2D> &movingEdges,
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
    if (settings.leavesOpen && !settings.searchAnywhere)
        leaveOpen();
    return match_;
}

VECTORLIB_BODY void ScanPairMatcher::leaveOpen() {
    if (match_.linesSuffice) {
        match_.pose = match_.agreement.localizability().leaveOpen(match_.pose, expected_.pose);
        return;
    }
    const double share = match_.agreement.walls().weakestShare();
    const double kept =
        std::clamp((share - settings.unknownShare) / (settings.knownShare - settings.unknownShare), 0.0, 1.0);
    const Vector2D<double> along = match_.agreement.walls().weakest();
    const Vector2D<double> off = match_.pose.translation() - expected_.pose.translation();
    match_.pose =
        Transformation2D(match_.pose.x() - (1 - kept) * along.dot(off) * along.x,
                         match_.pose.y() - (1 - kept) * along.dot(off) * along.y, match_.pose.alpha());
}

VECTORLIB_BODY bool ScanPairMatcher::isFoundAnywhere(PointSpan<float> fixed, PointSpan<float> moving) {
    anywhere_ = &matchAnywhere_(fixed, moving);
    if (anywhere_->isAccepted())
        takeBestOfAnywhere();
    return match_.accepted = anywhere_->isAccepted();
}

VECTORLIB_BODY bool ScanPairMatcher::isOutvoted() const {
    if (anywhere_->solutions.empty())
        return false;
    const Transformation2D off = anywhere_->solutions.front().pose.inverse() * match_.pose;
    return off.translation().norm() > matchAnywhere_.settings.farXY ||
           std::abs(off.alpha()) > matchAnywhere_.settings.farAlpha;
}

VECTORLIB_BODY void ScanPairMatcher::takeBestOfAnywhere() {
    if (!anywhere_->solutions.empty())
        take(anywhere_->solutions.front().pose);
}

VECTORLIB_BODY void ScanPairMatcher::searchWidely(const std::vector<EdgeRaw2D> &edges,
                                                  const Transformation2D &byLines) {
    const double gate = settings.wideGate;
    match_.searchedAgain = true;
    consider(refine(byLines, expected_, gate));
    consider(refine(expected_.pose, expected_, gate));
    consider(refine(Transformation2D(0, 0, expected_.pose.alpha()), expected_, gate)); // wheels that slip
    track_.settings = settings.wideLines;
    const Match &lines = track_(fixedSegments_, edges, expected_.pose);
    consider(refine(
        lines.pose,
        {expected_.pose, settings.wideLines.expectedDeviationXY, settings.wideLines.expectedDeviationAlpha},
        gate));
}

VECTORLIB_BODY void ScanPairMatcher::take(const Transformation2D &pose) {
    match_.pose = pose;
    match_.agreement = refine.agreement(pose);
    worth_ = match_.agreement.score() - settings.expectationCost * surprise(pose);
}

VECTORLIB_BODY void ScanPairMatcher::consider(const Transformation2D &pose) {
    const double before = worth_;
    const ScanPairMatch kept = match_;
    take(pose);
    if (!(worth_ > before)) {
        match_ = kept;
        worth_ = before;
    }
}

VECTORLIB_BODY double ScanPairMatcher::surprise(const Transformation2D &pose) const {
    const Transformation2D off = expected_.pose.inverse() * pose;
    const double xy = off.translation().norm() / expected_.deviationXY;
    const double alpha = off.alpha() / expected_.deviationAlpha;
    return xy * xy + alpha * alpha;
}

VECTORLIB_BODY bool ScanPairMatcher::isAcceptable() const {
    const double surprising = settings.surprising * settings.surprising;
    return match_.agreement.explainedPoints() >= settings.minPoints &&
           match_.agreement.explained() >= settings.minExplained &&
           match_.agreement.contradicted() <= settings.maxContradicted &&
           match_.agreement.walls().reliability() >= settings.minReliability &&
           (isGood() || surprise(match_.pose) <= surprising);
}

} // namespace vectorlib
