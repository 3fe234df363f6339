#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/edges/EdgeRaw2D.h"
#include "vectorlib/geometry/Pose2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/mapping/MapBuilder.h"
#include "vectorlib/mapping/ScanTracker.h"
#include "vectorlib/mapping/TimedScan.h"
#include "vectorlib/places/Relocalized.h"

#include <cmath>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

namespace vectorlib {

/// Settings of MapLocalizer.
struct MapLocalizerSettings {
    /// Scans that are sought in the whole map lie so far apart by odometry; metres, radians.
    double keyWay = 1, keyTurn = 0.6;
    std::size_t keyScans = 5;              ///< the same in scans, where the odometry does not tell
    double sameXY = 0.5, sameAlpha = 0.17; ///< two ways to one place agree within this; metres, radians
    int lostBeforeDropped = 3;             ///< lost scans in a row that refute a place not yet confirmed
    int lostBeforeSearch = 10;             ///< in a row, after which the place is sought again
    std::size_t maxKept = 1000;            ///< scans without a place that are kept until it is found
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
        tracker.grow(false);
    }

    /// The next scan of the drive.
    void take(const TimedScan &scan);
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

    void seek();
    Relocalized search() {
        ++searches_;
        return tracker.relocalize(false);
    }
    bool isFarFromSought(const TimedScan &scan);
    bool isKeyMotion(const Transformation2D &way) const {
        return way.translation().norm() >= settings.keyWay || std::abs(way.alpha()) >= settings.keyTurn;
    }

    // The last scan was taken there, if it matches the map.
    void propose(const Place &place);
    // Forgets what followed from it.
    void drop();
    void forget(const Kept &kept) { scans_[kept.number] = {scans_[kept.number].stamp, std::nullopt, false}; }

    void follow();
    void confirm();
    // The scans before the place that is confirmed now, the last first, until they are lost.
    void traceBack();
    template <typename Iterator>
    void followBack(Iterator from, Iterator end);
    static TimedScan backwards(TimedScan scan);
    // Finds a scan from the scan before, or from a pose.
    ScanReport::Outcome track(const Kept &kept, const std::optional<Pose2D> &pose, double against = 0);

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
    double against_ = 0;       // what speaks against the place
    std::optional<Sought> sought_;
    std::size_t sinceSought_ = 0;
    int lostInARow_ = 0;
    std::size_t searches_ = 0, found_ = 0, dropped_ = 0;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/mapping/MapLocalizer.cpp")
