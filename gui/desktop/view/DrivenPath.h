#pragma once

#include "gui/desktop/view/KeyScanGraph.h"

#include <QPolygonF>
#include <optional>

namespace hermes::desktop {

/// A point of the pose's own frame in the frame that the pose is given in; metres.
QPointF operator*(const Pose2D &pose, QPointF point);

/// When a pose held (s), and how fast the robot was then (m/s).
struct PathMoment {
    double stamp = 0, speed = 0;
};

/// A way in the map's frame, thinned to steps of 2 cm, the oldest of it forgotten after 100,000 of them. Each
/// point is fixed to a key scan and goes with it when the map is corrected. The way is broken where the robot
/// cannot have driven from one point to the next: it was placed or found elsewhere, or a replay jumped.
class DrivenPath {
public:
    static constexpr int loose = -1; ///< fixed to no key scan

    const QPolygonF &way() const { return way_; }
    /// Of each point the number of its key scan.
    const QVector<int> &keyScans() const { return keyScans_; }
    /// Numbers of the points that begin a new piece, ascending; the first of all is none of them.
    const QVector<int> &breaks() const { return breaks_; }
    void add(const Pose2D &pose, const PathMoment &moment, int keyScan);

    /// Where the frame that the poses come in lies in the map; absent before the first.
    std::optional<Pose2D> frame;
    /// The key scan that the frame is fixed to, and with it all of the way.
    int frameKeyScan = loose;

    /// The points that are fixed to none belong to this one.
    void fix(int keyScan);
    void loosen();
    /// The key scans were corrected.
    void correct(const QVector<Pose2D> &before, const QVector<Pose2D> &after);

private:
    bool isJump(double distance_m, const PathMoment &moment) const;
    void forgetOldest(int count);

    QPolygonF way_;
    QVector<int> breaks_;
    PathMoment last_;
    double lastGap_s_ = 0; // before it
    QVector<int> keyScans_;
};

} // namespace hermes::desktop
