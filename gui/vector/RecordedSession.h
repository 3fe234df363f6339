#pragma once

#include "gui/vector/OdometryFeed.h"
#include "protocol/mcap/Reader.h"
#include "protocol/velodyne/ClockChoice.h"
#include "protocol/velodyne/TurnAssembler.h"
#include "vectorlib/mapping/ScanTracker.h"
#include "vectorlib/mapping/TimedScan.h"
#include "vectorlib/motion/Odometry.h"

#include <nlohmann/json.hpp>

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace hermes::vector {

/// The files of a recording of which this is one, from it on: NAME-0001.pcap, NAME-0002.pcap and so on. Of
/// any other file only itself.
std::vector<std::string> partsFrom(const std::string &path);

/// The first file of the capture in a folder, or nothing. Throws Failure where there are several captures.
std::optional<std::string> captureIn(const std::string &folder);

/// A session as the robot recorded it: a folder with the capture of its lidar and, in recorder-0001.mcap and
/// on, its odometry and the settings of its daemons; or one of these files alone.
class RecordedSession {
public:
    /// Throws Failure where a file of it cannot be read.
    explicit RecordedSession(const std::string &path);

    /// As the daemons had them when the recording began; where that is not known, as they are by default.
    vectorlib::ScanTrackerSettings tracker() const;
    velodyne::TurnAssembler::Options decoding() const;
    /// Whether the sensor hung so, or the second one.
    bool isUpsideDown(const char *sensor = "sensor") const {
        return number(matcherTopic, std::string(sensor) + ".upside_down").value_or(0) != 0;
    }
    /// Whose clock stamped the scans. The sensor's, where the recording is older than the choice.
    velodyne::ClockChoice clock() const;
    std::optional<double> sigma() const { return number(matcherTopic, "matcher.sigma_m"); }

    /// Topics of scans among those recorded, as of scanners without a capture.
    struct ScanTopics {
        std::string first;  ///< the one that the matcher took; empty: there is none
        std::string second; ///< of its second scanner; empty: there is none
        std::string others;
    };
    ScanTopics scanTopics() const;
    /// Gives all scans of the first, each with that of the second; partial: too little of a revolution.
    void readScans(const std::function<void(const vectorlib::TimedScan &scan, bool partial)> &take);

    /// The robot's way during a scan (seconds since the Unix epoch), when it is known. Scans in the order of
    /// time.
    std::optional<vectorlib::OdometryTrack> over(double begin, double end);
    /// Messages of the odometry that tell what no robot can.
    std::size_t refused() const { return refused_; }
    /// What could not be read; empty: nothing.
    std::string problems() const;

private:
    static constexpr const char *matcherTopic = "scanmatcher/settings";
    static constexpr const char *loggerTopic = "velodynelogger/settings";

    std::optional<double> number(const char *topic, std::string path) const;
    void readSettings();
    std::optional<vectorlib::OdometrySample> nextSample();

    std::vector<std::string> files_;
    std::vector<mcap::Reader> readers_;
    std::map<std::string, nlohmann::json> settings_; ///< by topic
    std::size_t reader_ = 0;
    OdometryFeed feed_;
    std::size_t refused_ = 0, refusedScans_ = 0;
};

} // namespace hermes::vector
