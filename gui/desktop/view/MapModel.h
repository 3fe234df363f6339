#pragma once

#include "gui/desktop/model/Freshness.h"
#include "gui/desktop/model/TopicFeed.h"
#include "gui/desktop/view/Glide.h"
#include "protocol/messages/Matching.h"
#include "protocol/messages/Turns.h"
#include "protocol/messages/VectorMap.h"

#include <QElapsedTimer>
#include <QTimer>
#include <deque>

namespace hermes::desktop {

/// Everything that the map view shows of the chosen robot, in the map's frame and in metres, as it comes from
/// the topics map, graph, pose, scan, scan2d, odometry and truth of whichever daemons have them. When the
/// map was corrected, edges, graph and paths are those of the picture that glides to the corrected map.
class MapModel : public QObject {
    Q_OBJECT
public:
    static constexpr int maxEdges = 200000;
    /// So long the picture waits for a corrected map, longer while parts of it come, and so long the notice
    /// of it stands.
    static constexpr std::chrono::milliseconds signWait{2000}, partsWait{10000}, noticeTime{4000};

    explicit MapModel(Fleet &fleet, QObject *parent = nullptr);

    /// The edges of the map, free space on their left.
    const QVector<QLineF> &edges() const { return isGliding() ? glide_.shown().edges : edges_; }
    /// A large map comes in parts.
    bool isWhole() const { return edges_.size() >= size_; }
    /// How the matcher put the drive together.
    const KeyScans &graph() const { return isGliding() ? glide_.shown().graph : graph_.known(); }
    /// The last scan's segments and points; the segments' partners in the map.
    const QVector<QLineF> &segments() const { return segments_; }
    const QPolygonF &scan() const { return scan_; }
    const QVector<QLineF> &correspondences() const { return correspondences_; }

    /// The sensor's pose as matched; absent before the first scan.
    const std::optional<Pose2D> &pose() const { return pose_; }
    /// Where the robot is shown: elsewhere only while a correction of the map is shown as a movement.
    std::optional<Pose2D> shownPose() const {
        return pose_ ? std::optional(glide_.shownPose(*pose_)) : std::nullopt;
    }
    bool isGliding() const { return glide_.phase() != Glide::Phase::Rests; }
    /// How far the key scan that moved most did (m); for a few seconds after the map was corrected.
    const std::optional<double> &correction_m() const { return correction_m_; }
    /// Of x, y and theta, row by row; absent when the last scan was lost.
    const std::optional<std::array<double, 9>> &covariance() const { return covariance_; }
    /// How old pose and match are, and the scan.
    const Freshness &poseAge() const { return poseAge_; }
    const Freshness &scanAge() const { return scanAge_; }
    /// "matched", "lost" or "skipped".
    const QString &outcome() const { return outcome_; }
    /// 0 to 1, and m^2, of the last match.
    double reliability() const { return reliability_; }
    double ambiguity() const { return ambiguity_; }
    /// 0 to 1, of the pose; absent when the matcher does not tell it.
    const std::optional<double> &trust() const { return trust_; }

    /// Ways so far, corrected as the map is. Odometry and truth have frames of their own: they are laid so
    /// that they begin where the matched path was at that time.
    const QPolygonF &matchedPath() const { return way(MovingMap::Matched); }
    const QPolygonF &odometryPath() const { return way(MovingMap::Odometry); }
    const QPolygonF &way(MovingMap::Path path) const {
        return isGliding() ? glide_.shown().ways[path] : paths_[path].way();
    }
    /// Numbers of the points at which a path begins anew, for the robot jumped.
    const QVector<int> &breaks(MovingMap::Path path) const { return paths_[path].breaks(); }
    /// Forgets the paths of the map that is shown.
    void clearPaths();

    /// What came and is not shown: values that are no numbers, or impossible coordinates (beyond farthest_m),
    /// edges beyond maxEdges, and of the graph what KeyScanGraph passes over.
    quint64 ignored() const { return ignored_; }

    /// All edges; null rectangle without any.
    QRectF bounds() const;
    /// Who has the topics pose and map; null: nobody.
    DaemonLink *matcher() const { return poses_.source(); }

Q_SIGNALS:
    void changed();
    /// By another map, not a corrected one.
    void replaced();

private:
    using Paths = std::array<DrivenPath, 3>; // by MovingMap::Path
    /// Which map, and whether what is matched is a replay: paths belong to both.
    using MapKey = std::pair<qint64, bool>;
    /// What tells that the map was corrected, in any order.
    enum Sign { MapSign = 1, GraphSign = 2, PoseSign = 4, AllSigns = 7 };

    template <typename Message>
    Client::TopicCallback reader(void (MapModel::*take)(const Message &));
    void onMap(const MapMessage &map);
    void onGraph(const GraphMessage &message);
    void onPose(const PoseMessage &message);
    void onResult(const ScanResult &result);
    void onScan(const ScanMessage &scan);
    void onOdometry(const OdometryMessage &odometry) {
        follow(paths_[MovingMap::Odometry], odometry.pose, odometry.twist);
    }
    void onTruth(const TruthMessage &truth) { follow(paths_[MovingMap::Truth], truth.pose, truth.twist); }
    void takeTrust(double trust);
    void addEdge(const MapEdgeMessage &edge);
    void removeEdge(qint64 id);
    void follow(DrivenPath &path, const Pose2D &pose, const Twist2D &twist);
    PathMoment moment(const Twist2D &twist) const;
    void placeScan();

    void forgetPath(MovingMap::Path path);
    void turnTo(MapKey map);
    int newestKeyScan() const;
    void expectCorrection(Sign sign);
    void takeLeap(const PoseMessage &message);
    void graphIsWhole();
    void correctPaths(const QVector<Pose2D> &before);
    void forgetGraph();
    void resume();
    void onWaitOver();
    void startGlide();
    void showGlide();
    void endGlide();

    QVector<QLineF> edges_, segments_, correspondences_;
    QHash<qint64, int> rows_;   // of an edge in edges_, by its id
    QVector<qint64> ids_;       // of each row
    double revision_ = 0;       // of the map, counts its changes
    bool isMapRenewed_ = false; // asked for anew, not corrected
    int size_ = 0;              // edges that the daemon's map has
    ScanMessage rawScan_;       // waits for its pose
    QPolygonF scan_;
    Twist2D twist_;                  // of the sensor
    quint64 poseScan_ = ~quint64(0); // the number of the scan that the pose belongs to
    double handedness_ = 1;          // of the scan: -1 where the scanner hangs upside down
    std::optional<Pose2D> pose_;
    std::optional<std::array<double, 9>> covariance_;
    QString outcome_;
    double stamp_ = 0; // of the message that is being read
    quint64 ignored_ = 0;
    double reliability_ = 0, ambiguity_ = 0;
    std::optional<double> trust_;
    Freshness poseAge_, scanAge_;
    QTimer ageing_; // shows that nothing comes
    std::pair<std::pair<Freshness::State, QString>, std::pair<Freshness::State, QString>> shownAge_;
    Paths paths_;
    MapKey map_{0, false};                       // that the paths are of
    static constexpr std::size_t maxAside = 3;   // of sets of paths
    std::deque<std::pair<MapKey, Paths>> aside_; // until their map is back; the oldest first

    KeyScanGraph graph_;
    QVector<Pose2D> before_;              // key scans before the correction that is coming in
    std::optional<Pose2D> odometryFrame_; // in the map
    int poseLead_ = 0; // corrections that the pose is ahead of the graph; the path waits until they agree
    int signs_ = 0;    // of the correction that the picture waits for
    std::optional<double> correction_m_;
    Glide glide_;
    QElapsedTimer glideClock_; // since it holds or moves
    QTimer frames_, wait_, notice_;
    TopicFeed maps_, graphs_, poses_, results_, scans_, odometryFeed_, truthFeed_;
};

} // namespace hermes::desktop
