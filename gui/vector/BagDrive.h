#pragma once

#include "gui/vector/BagOdometry.h"
#include "gui/vector/BagScan.h"
#include "gui/vector/FrameTree.h"
#include "gui/vector/OdometryFeed.h"
#include "protocol/bag/Reader.h"
#include "vectorlib/mapping/TimedScan.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace hermes::vector {

/// Which scanner of a bag is read, and how.
struct BagOptions {
    std::string topic; ///< empty: the only one
    CloudOptions cloud;

    bool isGiven() const { return !topic.empty() || cloud.laser || cloud.height != 0; }
};

/// What a bag tells of one of its scanners.
struct BagScanner {
    std::string topic, type;
    std::uint64_t messages = 0;
    std::string frame; ///< of its first scan
    std::size_t rays = 0;
    double fieldOfView = 0;                 ///< radians
    std::string base;                       ///< the robot's frame
    std::optional<vectorlib::Pose2D> mount; ///< in the robot's frame; nothing: the bag does not tell
    bool isUpsideDown = false;
    double tilt = 0;            ///< of its plane from that of the robot; radians
    bool isMountMoving = false; ///< the first place counts
    std::string problem;        ///< why its first scan is none; empty: it is one
};

/// The drive of a robot by a bag: scans of one scanner, the odometry, and where the scanner is on the robot.
class BagDrive {
public:
    /// Reads the frames. Throws Failure where the bag cannot be read at all.
    explicit BagDrive(const std::string &path);

    const bag::Reader &reader() const { return *reader_; }
    const std::vector<BagScanner> &scanners() const { return scanners_; }
    /// For people; empty: there is none.
    std::string odometry() const;

    /// Throws Failure, which lists all scanners, where it is not clear which one is meant, or there is none.
    void choose(const BagOptions &options);
    /// The one that was chosen.
    const BagScanner &scanner() const { return scanners_[chosen_]; }
    /// Gives all its scans, with the odometry of their times.
    void readScans(const std::function<void(vectorlib::TimedScan &scan)> &take);

    /// Before the next two, which are another way to read it: scans and odometry apart.
    void begin();
    /// The time of the next scan in the bag, and that scan without odometry; nothing at the end.
    std::optional<std::uint64_t> nextScan(vectorlib::TimedScan &scan);
    /// The same of the odometry.
    std::optional<std::pair<std::uint64_t, vectorlib::OdometrySample>> nextSample() {
        return odometry_ ? odometry_->next() : std::nullopt;
    }

    /// Where the robot was at the stamp of the scan by a program that made a map: in the frame map of tf,
    /// where there is one and the bag tells of that time.
    std::optional<vectorlib::Pose2D> poseAt(const vectorlib::TimedScan &scan);

    std::size_t odometryRefused() const { return odometry_ ? odometry_->refused() : 0; }
    /// What was left out and what could not be read, for people; empty: nothing. isPlaced: somebody told
    /// where the scanner is.
    std::string notices(bool isPlaced) const;

private:
    void listTopics();
    void readFrames();
    bool isNeeded(const bag::Topic &topic) const;
    void takeFrames(const bag::Topic &topic, const bag::Message &message);
    void readFirstScan(const bag::Topic &topic, const bag::Message &message);
    std::vector<std::string> wayTo(const char *name) const;
    std::string baseOf(const std::string &frame) const;
    void placeScanner(BagScanner &scanner);
    std::string readScan(const bag::Topic &topic, const bag::Message &message, BagScan &reading,
                         vectorlib::TimedScan &scan, std::string &frame) const;
    void note(const std::string &what);

    std::string path_;
    std::unique_ptr<bag::Reader> reader_;
    std::unique_ptr<BagOdometry> odometry_; ///< null: there is none, or nothing was read
    std::unique_ptr<BagOdometry> poses_;    ///< null: they were not asked for
    std::vector<BagScanner> scanners_;
    std::size_t chosen_ = 0;
    CloudOptions cloud_;
    BagScan reading_;
    const bag::Topic *scanTopic_ = nullptr;
    std::string odometryTopic_; ///< empty: none
    std::string base_;          ///< the robot's frame, as the odometry tells; empty: it does not
    FrameTree frames_;
    std::vector<std::string> way_;      ///< frames from the robot's up to that of the odometry, by tf
    std::vector<std::string> wayToMap_; ///< the same up to that of a map
    OdometryFeed feed_, poseFeed_;
    std::vector<std::string> notices_;
    std::size_t scans_ = 0, refusedScans_ = 0, unstamped_ = 0, withoutOdometry_ = 0, refusedFrames_ = 0,
                refusedFrameMessages_ = 0;
    std::string firstRefused_;
};

} // namespace hermes::vector
