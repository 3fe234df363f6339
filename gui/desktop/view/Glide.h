#pragma once

#include "gui/desktop/view/DrivenPath.h"

#include <QHash>
#include <QLineF>
#include <QTransform>
#include <array>

namespace hermes::desktop {

/// What of the map's picture moves when the map is corrected; metres, in the map's frame.
struct MovingMap {
    enum Path { Matched, Odometry, Truth };

    QVector<QLineF> edges;
    KeyScans graph;
    std::array<QPolygonF, 3> ways; // by Path
};

/// Shows a correction of the map as a movement. It holds the picture until all that was corrected is here,
/// then lets it glide there: each key scan from where it was shown, edges with the key scan near them, paths
/// with the key scans they are fixed to.
class Glide {
public:
    static constexpr double duration_s = 0.5;
    /// Nobody sees less (m), on the scale at which a map is looked at.
    static constexpr double leastMove_m = 0.01;
    /// Larger maps are not animated: each picture of the movement would take too long.
    static constexpr int maxEdges = 10000, maxKeyScans = 20000;

    enum class Phase { Rests, Holds, Moves };

    Phase phase() const { return phase_; }
    /// Unless it rests.
    const MovingMap &shown() const { return shown_; }
    /// Where the robot is shown that is at this pose of the corrected map.
    Pose2D shownPose(const Pose2D &pose) const;

    /// Holds what is shown: this, or the middle of a movement. pose: the robot's.
    void hold(const MovingMap &now, const Pose2D &pose);
    /// The robot's pose became leap * pose; it did not move.
    void leap(const Pose2D &leap) { robot_ = robot_ * leap.inverse(); }
    /// From what it holds to the corrected map. False, and it rests: nothing moves, or too much.
    bool start(int edges, const KeyScans &corrected);
    /// The picture after a part of the duration, 0 to 1.
    void show(double part, const QVector<QLineF> &edges, const KeyScans &graph,
              const std::array<DrivenPath, 3> &paths);
    void end();

private:
    using Cell = QPair<int, int>;

    static Cell cellOf(QPointF point);
    int nearest(QPointF point) const;
    void showKeyScans(const KeyScans &graph);
    void showWay(QPolygonF &shown, const DrivenPath &path) const;
    const QTransform &undoing(int keyScan) const { return undoing_[qMin(keyScan, undoing_.size() - 1)]; }

    Phase phase_ = Phase::Rests;
    MovingMap shown_;
    QVector<Pose2D> from_;        // key scans as they were shown at the start
    QVector<QTransform> undoing_; // of each key scan: from the corrected map to what is shown
    QHash<Cell, int> cells_;      // the first key scan in each
    Pose2D robot_;                // undoes the robot's leaps
    double part_ = 0;
};

} // namespace hermes::desktop
