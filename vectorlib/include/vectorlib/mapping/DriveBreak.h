#pragma once

#include "vectorlib/mapping/MapBuilder.h"

namespace vectorlib {

/// Watches whether a drive breaks while its map grows: two scans that were expected close together do not
/// show the same, as after the sensor was carried. From then on scans are compared with what the map hid
/// before.
class DriveBreak {
public:
    /// By how much more of a scan may lie behind walls of the map than before the break; a share of its
    /// points.
    double mostHidden = 0.15;

    /// The sensor was put somewhere: nothing is suspicious before a scan is matched there.
    void place() {
        correct();
        isSuspect_ = false;
        isInsisted_ = true;
    }
    /// The map was made anew: what it hid does not count.
    void correct() { hidden_ = knownHidden_ = 0; }
    /// Takes the outcome of a scan, whether it was expected near the one before, and whether that shows it.
    void take(ScanReport::Outcome outcome, bool isNear, bool isFollowed) {
        const bool isLost = outcome == ScanReport::Outcome::Lost;
        if (!isSuspect_ && !isInsisted_ && isNear && (isLost || !isFollowed)) {
            isSuspect_ = true;
            knownHidden_ = hidden_;
        }
        isInsisted_ = isInsisted_ && outcome != ScanReport::Outcome::Matched;
    }
    /// Whether the drive broke, and no scan has agreed with the map since.
    bool isSuspect() const { return isSuspect_; }
    /// Takes the share of the scan's points that lie behind walls. True where the scan contradicts the map
    /// after a break, and also where the map does not know what the scan shows and nothing else tells its
    /// pose.
    bool isContradicted(ScanReport::Outcome outcome, double hidden, bool isUnknown) {
        hidden_ = hidden;
        const bool isContradicted = isSuspect_ && (hidden - knownHidden_ > mostHidden || isUnknown);
        isSuspect_ = isSuspect_ && (isContradicted || outcome == ScanReport::Outcome::Lost);
        return isContradicted;
    }

private:
    double hidden_ = 0, knownHidden_ = 0; // of one of the last scans, and before the break
    bool isSuspect_ = false, isInsisted_ = false;
};

} // namespace vectorlib
