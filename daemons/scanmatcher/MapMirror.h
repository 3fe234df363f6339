#pragma once

#include "protocol/messages/VectorMap.h"
#include "vectorlib/edges/EdgeRaw2D.h"
#include "vectorlib/io/Tum.h"
#include "vectorlib/mapping/VectorMap.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

namespace hermes::scanmatcher {

/// A copy of the drive's graph for the main thread: what subscriptions to `graph` begin with.
class GraphMirror {
public:
    void replace(GraphMessage &&graph) {
        const qint64 revision = all_.revision + 1;
        all_ = std::move(graph);
        all_.revision = revision;
    }
    /// Exchanges what is mirrored; the revision goes on.
    void swap(GraphMirror &other) {
        const qint64 revision = all_.revision + 1;
        std::swap(all_, other.all_);
        all_.revision = revision;
    }
    /// Takes new key scans in and gives the data of the topic.
    GraphMessage grow(GraphMessage &&more);
    /// At most partKeys key scans from the number `cursor` on, which moves behind them, or below 0 with the
    /// last; `cleared` is true in the first part, from 0 on.
    GraphMessage part(qint64 &cursor) const;
    static constexpr qint64 partKeys = 1000;

private:
    GraphMessage all_;
};

/// What changed in a map since the last time.
struct MapChanges {
    std::vector<vectorlib::MapEdge> changed; ///< new and altered edges
    std::vector<qint64> removed;             ///< edges that were merged into others
};

MapChanges takeChanges(vectorlib::VectorMap &map);

/// A copy of the worker's map and trajectory for the main thread, kept up to date by changes: what replies
/// and subscriptions are made from without disturbing the matching.
class MapMirror {
public:
    using Edges = std::map<qint64, vectorlib::MapEdge>;

    /// Takes the edges of another map over, of this number, and forgets the trajectory; `other` has the old
    /// edges afterwards.
    void replace(Edges &other, qint64 number);
    /// Exchanges what is mirrored; the revision goes on.
    void swap(MapMirror &other) {
        edges_.swap(other.edges_);
        poses_.swap(other.poses_);
        std::swap(number_, other.number_);
        std::swap(isSaved_, other.isSaved_);
        ++revision_;
    }
    /// Takes the edges of the same map over, made anew, and where the scans of these numbers lie now; those
    /// between and after them move with the one before.
    void correct(Edges &other, const std::vector<quint64> &numbers,
                 const std::vector<vectorlib::Pose2D> &poses);
    /// Takes the changes in and gives the data of the topic `map`.
    MapMessage apply(const MapChanges &changes);
    void addPose(const vectorlib::StampedPose &pose) { poses_.push_back(pose); }

    /// The full state in the same form, `cleared` true.
    MapMessage full() const;
    /// At most partEdges of them, from the id `cursor` on, which moves behind them, or below 0 with the last;
    /// `cleared` is true in the first part, from 0 on.
    MapMessage part(qint64 &cursor) const;
    static constexpr std::size_t partEdges = 1000;
    const std::vector<vectorlib::StampedPose> &trajectory() const { return poses_; }
    size_t size() const { return edges_.size(); }
    /// Whether a file holds all of it: nothing changed since one was written or read.
    bool isSaved() const { return isSaved_ || edges_.empty(); }
    void setSaved(bool isSaved) { isSaved_ = isSaved; }

private:
    MapMessage message(bool cleared) const;

    Edges edges_;
    std::vector<vectorlib::StampedPose> poses_;
    qint64 revision_ = 0;
    qint64 number_ = 0; ///< which map it is
    bool isSaved_ = true;
};

} // namespace hermes::scanmatcher
