#pragma once

#include "gui/desktop/view/KeyScanGraph.h"

#include <QPolygonF>
#include <optional>

namespace hermes::desktop {

/// A point of the pose's own frame in the frame that the pose is given in; metres.
QPointF operator*(const Pose2D &pose, QPointF point);

/// A way in the map's frame, thinned to steps of 2 cm, the oldest of it forgotten after 100,000 of them. Each
/// point is fixed to a key scan and goes with it when the map is corrected.
class DrivenPath {
public:
    static constexpr int loose = -1; ///< fixed to no key scan

    const QPolygonF &way() const { return way_; }
    /// Of each point the number of its key scan.
    const QVector<int> &keyScans() const { return keyScans_; }
    void add(const Pose2D &pose, int keyScan);

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
    QPolygonF way_;
    QVector<int> keyScans_;
};

} // namespace hermes::desktop
