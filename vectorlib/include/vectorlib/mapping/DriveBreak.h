#pragma once

#include "vectorlib/mapping/MapBuilder.h"

#include <optional>

namespace vectorlib {

/// Watches whether a drive breaks while its map grows: two scans that were expected close together do not
/// show the same, as after the sensor was carried. From then on scans are compared with what the map hid
/// before.
class DriveBreak {
public:
    /// By how much more of a scan may lie behind walls of the map than before the break; a share of its
    /// points.
    double maxHidden = 0.15;
    /// By how much more of a scan than usual the scan before may contradict, where the two were taken close
    /// together: it saw something farther away there. A share of its points, and how many times the usual.
    double maxTorn = 0.06, usualTorn = 3;

    /// The sensor was put somewhere: nothing is suspicious before a scan is matched there.
    void place() {
        correct();
        torn_ = 0;
        isSuspect_ = isTorn_ = false;
        isInsisted_ = true;
    }
    /// The map was made anew: what it hid does not count.
    void correct() { hidden_ = knownHidden_ = 0; }
    /// Takes the outcome of a scan, whether it was expected near the one before, and whether that shows it;
    /// whether the map shows it where the odometry tells: then the drive did not break, and people go by;
    /// the share of it that the one before contradicts, where the two were compared, and whether that is
    /// still the one with which the last scan was compared.
    void take(ScanReport::Outcome outcome, bool isNear, bool isFollowed, bool isMapped,
              std::optional<double> contradicted, bool isByTheSame = false) {
        const bool isLost = outcome == ScanReport::Outcome::Lost;
        isMapped_ = isMapped;
        follow(isNear && contradicted, contradicted.value_or(0), isByTheSame, isLost);
        if (!isSuspect_ && !isInsisted_ && isNear && (isLost || !isFollowed)) {
            isSuspect_ = true;
            knownHidden_ = hidden_;
        }
        isInsisted_ = isInsisted_ && outcome != ScanReport::Outcome::Matched;
    }
    /// Whether the drive broke, and no scan has agreed with the map since.
    bool isSuspect() const { return isSuspect_; }
    /// Whether the two show different places; the next scan decides, as people go on: compared with this one
    /// it is of the same place, compared with the one before of another one again.
    bool mayBeTorn() const { return torn_ > 0; }
    bool isTorn() const { return isTorn_; }
    /// Takes the share of the scan's points that lie behind walls. True where the scan contradicts the map
    /// after a break, and also where the map does not know what the scan shows and nothing else tells its
    /// pose.
    bool isContradicted(ScanReport::Outcome outcome, double hidden, bool isUnknown) {
        hidden_ = hidden;
        const bool isContradicted =
            isSuspect_ && !isMapped_ && (hidden - knownHidden_ > maxHidden || isUnknown);
        isSuspect_ = isSuspect_ && (isContradicted || outcome == ScanReport::Outcome::Lost);
        return isContradicted;
    }

private:
    static constexpr double usualShare = 0.2; // by which the usual follows a scan
    static constexpr double quiet = 0.3;      // of what tore the drive, in the scan after

    void follow(bool isCompared, double contradicted, bool isByTheSame, bool isLost) {
        // One that agrees with the same scan shows that the one between was bad.
        const bool isConfirmed =
            isByTheSame ? isLost && contradicted > maxTorn : contradicted < quiet * torn_;
        isTorn_ = isCompared && torn_ > 0 && isConfirmed;
        const bool mayBeTorn =
            isCompared && !isInsisted_ && !isMapped_ && contradicted > maxTorn + usualTorn * contradicted_;
        torn_ = mayBeTorn ? contradicted : 0;
        contradicted_ += usualShare * (contradicted - contradicted_);
    }
    double hidden_ = 0, knownHidden_ = 0; // of one of the last scans, and before the break
    double contradicted_ = 0, torn_ = 0;  // usually, and where the drive may be torn
    bool isSuspect_ = false, isInsisted_ = false, isMapped_ = false, isTorn_ = false;
};

} // namespace vectorlib
