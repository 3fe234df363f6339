#pragma once

#include "gui/desktop/model/TopicFeed.h"
#include "protocol/messages/Matching.h"
#include "protocol/messages/Turns.h"
#include "protocol/messages/VectorMap.h"

#include <QLineF>
#include <QPolygonF>
#include <QVector>
#include <array>
#include <optional>

namespace hermes::desktop {

/// A point of the pose's own frame in the frame that the pose is given in; metres.
QPointF operator*(const Pose2D &pose, QPointF point);

/// Everything that the map view shows of the chosen robot, in the map's frame and in metres, as it comes from
/// the topics map, pose, scan, scan2d, odometry and truth of whichever daemons have them.
class MapModel : public QObject {
    Q_OBJECT
public:
    static constexpr double farthest_m = 1e6;
    static constexpr int mostEdges = 200000;

    explicit MapModel(Fleet &fleet, QObject *parent = nullptr);

    /// The edges of the map, free space on their left.
    const QVector<QLineF> &edges() const { return edges_; }
    /// A large map comes in parts.
    bool isWhole() const { return edges_.size() >= size_; }
    /// The last scan's segments and points; the segments' partners in the map.
    const QVector<QLineF> &segments() const { return segments_; }
    const QPolygonF &scan() const { return scan_; }
    const QVector<QLineF> &correspondences() const { return correspondences_; }

    /// The sensor's pose as matched; absent before the first scan.
    const std::optional<Pose2D> &pose() const { return pose_; }
    /// Of x, y and theta, row by row; absent when the last scan was lost.
    const std::optional<std::array<double, 9>> &covariance() const { return covariance_; }
    /// "matched", "lost" or "skipped".
    const QString &outcome() const { return outcome_; }
    /// 0 to 1, and m^2, of the last match.
    double reliability() const { return reliability_; }
    double ambiguity() const { return ambiguity_; }

    /// Ways so far, thinned to steps of 2 cm. Odometry and truth have frames of their own: they are laid so
    /// that they begin where the matched path was at that time.
    const QPolygonF &matchedPath() const { return matched_.way; }
    const QPolygonF &odometryPath() const { return odometry_.way; }
    const QPolygonF &truthPath() const { return truth_.way; }
    /// Forgets the paths.
    void clearPaths();

    /// What came and is not shown: values that are no numbers or beyond any place on Earth (farthest_m),
    /// edges beyond mostEdges.
    quint64 ignored() const { return ignored_; }

    /// All edges; null rectangle without any.
    QRectF bounds() const;
    /// Who has the topics pose and map; null: nobody.
    DaemonLink *matcher() const { return poses_.source(); }

Q_SIGNALS:
    void changed();

private:
    /// A path and the frame it comes in.
    struct Path {
        QPolygonF way;
        std::optional<Pose2D> frame; // of the source, in the map

        void add(const Pose2D &pose);
    };

    template <typename Message>
    Client::TopicCallback reader(void (MapModel::*take)(const Message &));
    void onMap(const MapMessage &map);
    void onPose(const PoseMessage &message);
    void onResult(const ScanResult &result);
    void onScan(const ScanMessage &scan);
    void onOdometry(const OdometryMessage &odometry);
    void onTruth(const TruthMessage &truth);
    void addEdge(const MapEdgeMessage &edge);
    void removeEdge(qint64 id);
    void follow(Path &path, const Pose2D &pose);
    void placeScan();

    QVector<QLineF> edges_, segments_, correspondences_;
    QHash<qint64, int> rows_; // of an edge in edges_, by its id
    QVector<qint64> ids_;     // of each row
    double revision_ = 0;     // of the map, counts its changes
    int size_ = 0;            // edges that the daemon's map has
    ScanMessage rawScan_;     // waits for its pose
    QPolygonF scan_;
    Twist2D twist_;                  // of the sensor
    quint64 poseScan_ = ~quint64(0); // the number of the scan that the pose belongs to
    std::optional<Pose2D> pose_;
    std::optional<std::array<double, 9>> covariance_;
    QString outcome_;
    quint64 ignored_ = 0;
    double reliability_ = 0, ambiguity_ = 0;
    Path matched_, odometry_, truth_;
    TopicFeed maps_, poses_, results_, scans_, odometryFeed_, truthFeed_;
};

} // namespace hermes::desktop
