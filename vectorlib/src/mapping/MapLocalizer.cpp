#include "vectorlib/mapping/MapLocalizer.h"

namespace vectorlib {

VECTORLIB_BODY void MapLocalizer::take(const TimedScan &scan) {
    scans_.push_back({scan.stamp, std::nullopt, false});
    kept_.push_back({scans_.size() - 1, scan});
    if (state_ == State::Lost)
        seek();
    else
        follow();
    if (kept_.size() <= settings.maxKept)
        return;
    if (state_ == State::Proposed)
        drop();
    kept_.pop_front();
}

VECTORLIB_BODY void MapLocalizer::seek() {
    const TimedScan &scan = kept_.back().scan;
    if (!isFarFromSought(scan))
        return;
    sought_ = scan.odometry ? std::optional(Sought{scan.odometry->epoch(), scan.odometry->at(scan.stamp)})
                            : std::nullopt;
    sinceSought_ = 0;
    tracker.place({});
    TimedScan seen = scan;
    tracker.process(seen);
    const Relocalized found = search();
    if (found.isFound())
        propose(found.places.front());
}

VECTORLIB_BODY bool MapLocalizer::isFarFromSought(const TimedScan &scan) {
    ++sinceSought_;
    if (searches_ == 0 || sinceSought_ >= settings.maxKept)
        return true;
    if (sought_ && scan.odometry && scan.odometry->epoch() == sought_->epoch)
        return isKeyMotion(sought_->robot.inverse() * scan.odometry->at(scan.stamp));
    return sinceSought_ >= settings.keyScans;
}

VECTORLIB_BODY void MapLocalizer::propose(const Place &place) {
    against_ = place.against;
    if (track(kept_.back(), place.pose, against_) != ScanReport::Outcome::Matched) {
        scans_.back().pose.reset();
        return;
    }
    state_ = State::Proposed;
    proposal_ = scans_.size() - 1;
    keyPose_ = Transformation2D(*scans_.back().pose);
    lostInARow_ = 0;
}

VECTORLIB_BODY void MapLocalizer::drop() {
    for (const Kept &kept : kept_)
        forget(kept);
    state_ = State::Lost;
    ++dropped_;
}

VECTORLIB_BODY void MapLocalizer::follow() {
    const bool isLost = track(kept_.back(), std::nullopt) == ScanReport::Outcome::Lost;
    lostInARow_ = isLost ? lostInARow_ + 1 : 0;
    if (state_ == State::Proposed)
        return lostInARow_ >= settings.lostBeforeDropped ? drop() : confirm();
    if (!isLost)
        kept_.clear();
    if (lostInARow_ < settings.lostBeforeSearch)
        return;
    for (const Kept &kept : kept_)
        forget(kept);
    state_ = State::Lost;
    sought_.reset();
}

VECTORLIB_BODY void MapLocalizer::confirm() {
    const Transformation2D here(*scans_.back().pose);
    if (!scans_.back().matched || !isKeyMotion(keyPose_.inverse() * here))
        return;
    keyPose_ = here;
    const Relocalized found = search();
    if (!found.isFound())
        return;
    const Pose2D &pose = found.places.front().pose;
    const Transformation2D off = here.inverse() * Transformation2D(pose);
    if (off.translation().norm() <= settings.sameXY && std::abs(off.alpha()) <= settings.sameAlpha) {
        ++found_;
        state_ = State::Confirmed;
        against_ = found.places.front().against;
        traceBack();
        kept_.clear();
    } else {
        drop();
        propose(found.places.front());
    }
}

VECTORLIB_BODY void MapLocalizer::traceBack() {
    const auto first =
        std::find_if(kept_.begin(), kept_.end(), [this](const Kept &k) { return k.number == proposal_; });
    const Pose2D here = *scans_.back().pose;
    followBack(std::make_reverse_iterator(first == kept_.end() ? first : first + 1), kept_.rend());
    track(kept_.back(), here, against_); // from where the drive goes on
}

template <typename Iterator>
void MapLocalizer::followBack(Iterator from, Iterator end) {
    if (from == end)
        return;
    std::optional<Pose2D> start = scans_[from->number].pose;
    lostInARow_ = 0;
    auto lost = from;
    for (; from != end && lostInARow_ < settings.lostBeforeSearch; ++from, start.reset()) {
        const bool isLost =
            track({from->number, backwards(from->scan)}, start, against_) == ScanReport::Outcome::Lost;
        scans_[from->number].stamp = -scans_[from->number].stamp;
        lostInARow_ = isLost ? lostInARow_ + 1 : 0;
        if (!isLost)
            lost = std::next(from);
    }
    for (; lostInARow_ >= settings.lostBeforeSearch && lost != from; ++lost)
        forget(*lost);
    lostInARow_ = 0;
}

VECTORLIB_BODY TimedScan MapLocalizer::backwards(TimedScan scan) {
    if (scan.odometry)
        scan.odometry.emplace(
            scan.odometry->epoch(),
            std::vector<OdometrySample>{{-scan.stamp, scan.odometry->at(scan.stamp).pose(), {}, {}}});
    scan.stamp = -scan.stamp;
    for (float &seconds : scan.seconds)
        seconds = -seconds;
    return scan;
}

VECTORLIB_BODY ScanReport::Outcome MapLocalizer::track(const Kept &kept, const std::optional<Pose2D> &pose,
                                                       double against) {
    if (pose)
        tracker.place(*pose, against);
    TimedScan scan = kept.scan;
    const ScanReport &report = tracker.process(scan);
    scans_[kept.number] = {scan.stamp, report.pose, report.outcome == ScanReport::Outcome::Matched};
    return report.outcome;
}

} // namespace vectorlib
