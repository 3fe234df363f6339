#pragma once

#include "protocol/messages/Motion.h"
#include "protocol/messages/VectorMap.h"

#include <QVector>
#include <utility>

namespace hermes::desktop {

/// Key scans by their numbers, in the map's frame: poses, how far to trust each (0 to 1), and places that
/// were met again.
struct KeyScans {
    /// The matcher refused loops that weigh less: the poses do not follow them.
    static constexpr double leastWeight = 0.25;

    QVector<Pose2D> poses;
    QVector<double> trust;
    QVector<GraphLoop> loops; // between numbers of poses

    int size() const { return poses.size(); }
};

/// The graph of the drive, as the topic `graph` tells it part by part. Nothing that comes is trusted to make
/// sense.
class KeyScanGraph {
public:
    static constexpr int maxKeyScans = 200000, maxLoops = 200000;

    /// Takes a message. False: messages before it were lost, the whole is to be asked for; what comes until
    /// then is passed over.
    bool take(const GraphMessage &message);
    void clear();

    const KeyScans &known() const { return known_; }
    /// A large graph comes in parts.
    bool isWhole() const { return !isBehind_ && known_.size() >= size_; }
    /// Since the last call: values that are no numbers, impossible coordinates, loops between key scans that
    /// there are not, what is beyond maxKeyScans and maxLoops.
    quint64 takeIgnored() { return std::exchange(ignored_, 0); }

private:
    void addPoses(const GraphMessage &message);
    void addLoops(const std::vector<GraphLoop> &loops);

    KeyScans known_;
    double revision_ = 0;
    int size_ = 0; // key scans that the matcher's graph has
    bool isBehind_ = false;
    quint64 ignored_ = 0;
};

} // namespace hermes::desktop
