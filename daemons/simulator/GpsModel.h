#pragma once

#include "protocol/messages/Motion.h"
#include "protocol/nmea/Gga.h"
#include "protocol/nmea/Rmc.h"
#include "protocol/velodyne/PositionPacket.h"
#include "vectorlib/geometry/Pose2D.h"

#include <cstdint>
#include <random>
#include <string>

namespace hermes::simulator {

/// A GPS receiver on the robot: fixes at equal intervals of UTC, told as RMC and GGA a moment later, and the
/// RMC of each whole second for the lidar that it is wired to. The world's x points east, its y north. Knows
/// no line and no clock.
class GpsModel {
public:
    struct Options {
        nmea::Position origin{50, 10}; ///< of the world
        double altitude = 300;         ///< m
        double sigma = 0.5;            ///< standard deviation of each coordinate of a fix, m
        int rate_hz = 5;               ///< 1 to 10
        std::uint64_t seed = 1;
    };
    struct Fault {
        enum class Kind {
            None,
            Silence, ///< dead
            NoFix,   ///< it tells the time, and that it knows no position
            Corrupt, ///< a share of the sentences has one bit flipped
        };
        Kind kind = Kind::None;
        double share = 0;
    };
    /// From a fix to its sentences. A Velodyne awaits them 50 to 500 ms after the pulse of the second.
    static constexpr std::int64_t delay_ns = 60000000;

    GpsModel() = default;
    explicit GpsModel(const Options &options)
        : options_(options)
        , random_(options.seed) {}

    void setFault(const Fault &fault) { fault_ = fault; }
    const Fault &fault() const { return fault_; }
    void setSigma(double sigma) { options_.sigma = sigma; }

    /// Whether take() has something to do; now_ns: since the Unix epoch.
    bool isDue(std::int64_t now_ns) const { return now_ns >= nextFix_ns_ || now_ns >= due_ns_; }
    /// Lets time come to now, when the robot is at that pose and moves so. The sentences that are to be sent
    /// now, most often none; valid until the next call.
    std::string_view take(std::int64_t now_ns, const Pose2D &pose, const Twist2D &twist);

    /// What the lidar got last: a $GPRMC without CR LF, at most 72 characters.
    const std::string &lidarSentence() const { return lidarSentence_; }
    /// How the lidar's clock follows the pulses of this receiver.
    velodyne::Pps pps() const {
        if (fault_.kind == Fault::Kind::Silence || fault_.kind == Fault::Kind::NoFix)
            return velodyne::Pps::Absent;
        return lidarSentence_.empty() ? velodyne::Pps::Synchronizing : velodyne::Pps::Locked;
    }

private:
    static constexpr std::int64_t never = INT64_MAX;

    std::int64_t timeOfFix(std::int64_t number) const;
    void fix(std::int64_t time_ns, const Pose2D &pose, const Twist2D &twist);
    nmea::Position positionOf(double east, double north) const;
    void tell(const std::optional<nmea::SentenceText> &sentence);

    Options options_;
    Fault fault_;
    std::mt19937_64 random_;
    std::normal_distribution<double> normal_;
    std::int64_t number_ = 0;     ///< of the next fix, since the Unix epoch
    std::int64_t nextFix_ns_ = 0; ///< 0: none yet, the time is unknown
    std::int64_t due_ns_ = never; ///< when what is pending is to be sent
    std::string pending_, told_;  ///< on the line
    std::string pendingLidar_, lidarSentence_;
};

} // namespace hermes::simulator
