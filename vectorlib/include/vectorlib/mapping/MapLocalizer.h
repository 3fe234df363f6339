#pragma once

#include "vectorlib/mapping/ScanTracker.h"

#include <deque>

namespace vectorlib {

/// Settings of MapLocalizer.
struct MapLocalizerSettings {
    /// Scans that are sought in the whole map lie so far apart by odometry; metres, radians.
    double keyWay = 1, keyTurn = 0.6;
    std::size_t keyScans = 5;              ///< the same in scans, where the odometry does not tell
    double sameXY = 0.5, sameAlpha = 0.17; ///< two ways to one place agree within this; metres, radians
    int lostBeforeDropped = 3;             ///< lost scans in a row that refute a place not yet confirmed
    int lostBeforeSearch = 10;             ///< in a row, after which the place is sought again
    std::size_t mostKept = 1000;           ///< scans without a place that are kept until it is found
};

/// A scan of the drive. Without a pose nothing tells where it was taken.
struct LocalizedScan {
    double stamp = 0;           ///< seconds
    std::optional<Pose2D> pose; ///< of the sensor, map frame
    bool matched = false;       ///< else the pose is where the motion led
};

/// Finds the poses of a drive in a finished map, which does not change. Nothing is known of the first pose:
/// scans are sought in the whole map, and a place counts when a second search, a metre or 0.6 rad on, agrees
/// with the way there. The scans before it get their poses backwards from it. The same again after the drive
/// was lost. Goes by the scans, not by a clock: the result is always the same.
class MapLocalizer {
public:
    MapLocalizerSettings settings;
    ScanTracker tracker; ///< takes scans only here

    explicit MapLocalizer(const std::vector<MapEdge> &map) {
        for (const MapEdge &edge : map)
            tracker.builder.map.add(edge, edge.observations);
        apply({});
    }
    /// The search takes the time that it needs.
    void apply(ScanTrackerSettings of) {
        of.relocalizeSeconds = 1e6;
        tracker.apply(of);
        tracker.builder.settings.grow = false;
    }

    /// The next scan of the drive.
    void take(const TimedScan &scan) {
        scans_.push_back({scan.stamp, std::nullopt, false});
        kept_.push_back({scans_.size() - 1, scan});
        if (state_ == State::Lost)
            seek();
        else
            follow();
        if (kept_.size() <= settings.mostKept)
            return;
        if (state_ == State::Proposed)
            drop();
        kept_.pop_front();
    }
    /// After the last scan: a place that nothing confirmed does not count.
    void finish() {
        if (state_ == State::Proposed)
            drop();
    }

    const std::vector<LocalizedScan> &scans() const { return scans_; }
    std::size_t searches() const { return searches_; }
    /// Places that were found and confirmed, the first among them.
    std::size_t placesFound() const { return found_; }
    /// Places that were proposed and not confirmed.
    std::size_t placesDropped() const { return dropped_; }

private:
    enum class State {
        Lost,     // nothing is known
        Proposed, // one search found a place
        Confirmed // and another agreed
    };
    struct Kept {
        std::size_t number; // of the scan
        TimedScan scan;
    };

    void seek() {
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
            propose(found.places.front().pose);
    }
    Relocalized search() {
        ++searches_;
        return tracker.relocalize(false);
    }
    bool isFarFromSought(const TimedScan &scan) {
        ++sinceSought_;
        if (searches_ == 0 || sinceSought_ >= settings.mostKept)
            return true;
        if (sought_ && scan.odometry && scan.odometry->epoch() == sought_->epoch)
            return isKeyMotion(sought_->robot.inverse() * scan.odometry->at(scan.stamp));
        return sinceSought_ >= settings.keyScans;
    }
    bool isKeyMotion(const Transformation2D &way) const {
        return way.translation().norm() >= settings.keyWay || std::abs(way.alpha()) >= settings.keyTurn;
    }

    // The last scan was taken there, if it matches the map.
    void propose(const Pose2D &pose) {
        if (track(kept_.back(), pose) != ScanReport::Outcome::Matched) {
            scans_.back().pose.reset();
            return;
        }
        state_ = State::Proposed;
        proposal_ = scans_.size() - 1;
        keyPose_ = Transformation2D(*scans_.back().pose);
        lostInARow_ = 0;
    }
    // Forgets what followed from it.
    void drop() {
        for (const Kept &kept : kept_)
            forget(kept);
        state_ = State::Lost;
        ++dropped_;
    }
    void forget(const Kept &kept) { scans_[kept.number] = {scans_[kept.number].stamp, std::nullopt, false}; }

    void follow() {
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
    void confirm() {
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
            traceBack();
            kept_.clear();
        } else {
            drop();
            propose(pose);
        }
    }
    // The scans before the place that is confirmed now, the last first, until they are lost.
    void traceBack() {
        const auto first =
            std::find_if(kept_.begin(), kept_.end(), [this](const Kept &k) { return k.number == proposal_; });
        const Pose2D here = *scans_.back().pose;
        followBack(std::make_reverse_iterator(first == kept_.end() ? first : first + 1), kept_.rend());
        track(kept_.back(), here); // from where the drive goes on
    }
    template <typename Iterator>
    void followBack(Iterator from, Iterator end) {
        if (from == end)
            return;
        std::optional<Pose2D> start = scans_[from->number].pose;
        lostInARow_ = 0;
        auto lost = from;
        for (; from != end && lostInARow_ < settings.lostBeforeSearch; ++from, start.reset()) {
            const bool isLost =
                track({from->number, backwards(from->scan)}, start) == ScanReport::Outcome::Lost;
            scans_[from->number].stamp = -scans_[from->number].stamp;
            lostInARow_ = isLost ? lostInARow_ + 1 : 0;
            if (!isLost)
                lost = std::next(from);
        }
        for (; lostInARow_ >= settings.lostBeforeSearch && lost != from; ++lost)
            forget(*lost);
        lostInARow_ = 0;
    }
    static TimedScan backwards(TimedScan scan) {
        if (scan.odometry)
            scan.odometry.emplace(
                scan.odometry->epoch(),
                std::vector<OdometrySample>{{-scan.stamp, scan.odometry->at(scan.stamp).pose(), {}, {}}});
        scan.stamp = -scan.stamp;
        for (float &seconds : scan.seconds)
            seconds = -seconds;
        return scan;
    }
    // Finds a scan from the scan before, or from a pose.
    ScanReport::Outcome track(const Kept &kept, const std::optional<Pose2D> &pose) {
        if (pose)
            tracker.place(*pose);
        TimedScan scan = kept.scan;
        const ScanReport &report = tracker.process(scan);
        scans_[kept.number] = {scan.stamp, report.pose, report.outcome == ScanReport::Outcome::Matched};
        return report.outcome;
    }

    // Where the last search of the whole map was made, by odometry.
    struct Sought {
        std::uint64_t epoch;
        Transformation2D robot;
    };

    std::vector<LocalizedScan> scans_;
    std::deque<Kept> kept_; // scans whose poses are not certain
    State state_ = State::Lost;
    std::size_t proposal_ = 0; // the scan that proposed a place
    Transformation2D keyPose_; // of the last scan that was sought, where a place is proposed
    std::optional<Sought> sought_;
    std::size_t sinceSought_ = 0;
    int lostInARow_ = 0;
    std::size_t searches_ = 0, found_ = 0, dropped_ = 0;
};

} // namespace vectorlib
