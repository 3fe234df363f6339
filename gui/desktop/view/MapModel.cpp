#include "gui/desktop/view/MapModel.h"

#include <QJsonArray>
#include <QtMath>
#include <limits>

namespace hermes {
namespace {

constexpr double pathStep_m = 0.02;
constexpr int mostPathPoints = 100000;

MapPose toPose(const QJsonValue &value) {
    return {value["x"].toDouble(), value["y"].toDouble(), value["theta"].toDouble()};
}

QLineF toLine(const QJsonArray &numbers) {
    return {numbers.at(0).toDouble(), numbers.at(1).toDouble(), numbers.at(2).toDouble(),
            numbers.at(3).toDouble()};
}

} // namespace

QPointF MapPose::operator*(QPointF p) const {
    const double c = std::cos(theta), s = std::sin(theta);
    return {x + c * p.x() - s * p.y(), y + s * p.x() + c * p.y()};
}

MapPose MapPose::operator*(const MapPose &inner) const {
    const QPointF p = *this * QPointF(inner.x, inner.y);
    return {p.x(), p.y(), std::remainder(theta + inner.theta, 2 * M_PI)};
}

MapPose MapPose::inverse() const {
    const double c = std::cos(theta), s = std::sin(theta);
    return {-c * x - s * y, s * x - c * y, -theta};
}

void MapModel::Path::add(const MapPose &pose) {
    const QPointF point(pose.x, pose.y);
    if (!way.isEmpty() && QLineF(way.back(), point).length() < pathStep_m)
        return;
    if (way.size() >= mostPathPoints)
        way.remove(0, mostPathPoints / 10);
    way.append(point);
}

MapModel::MapModel(Fleet &fleet, QObject *parent)
    : QObject(parent)
    , maps_(
          fleet, "map", {{"queue", 100}}, [this](const TopicUpdate &u) { onMap(u.data); }, this)
    , poses_(
          fleet, "pose", {}, [this](const TopicUpdate &u) { onPose(u.data); }, this)
    , matches_(
          fleet, "match", {{"max_rate_hz", 10}}, [this](const TopicUpdate &u) { onMatch(u.data); }, this)
    , segmentFeed_(
          fleet, "segments", {{"max_rate_hz", 10}}, [this](const TopicUpdate &u) { onSegments(u.data); },
          this)
    , scans_(
          fleet, "scan2d", {{"max_rate_hz", 10}}, [this](const TopicUpdate &u) { onScan(u.data); }, this)
    , odometryFeed_(
          fleet, "odometry", {{"max_rate_hz", 10}},
          [this](const TopicUpdate &u) { follow(odometry_, u.data["pose"]); }, this)
    , truthFeed_(
          fleet, "truth", {{"max_rate_hz", 10}}, [this](const TopicUpdate &u) { follow(truth_, u.data); },
          this) {
    connect(&maps_, &TopicFeed::sourceChanged, this, [this] { onMap(QJsonObject{{"cleared", true}}); });
    connect(&poses_, &TopicFeed::sourceChanged, this, [this] {
        pose_.reset();
        clearPaths();
    });
}

void MapModel::clearPaths() {
    matched_ = odometry_ = truth_ = {};
    Q_EMIT changed();
}

QRectF MapModel::bounds() const {
    QRectF all;
    for (const QLineF &edge : edges_) {
        const QRectF one = QRectF(edge.p1(), edge.p2()).normalized();
        all = all.isNull()
                  ? one
                  : QRectF(QPointF(qMin(all.left(), one.left()), qMin(all.top(), one.top())),
                           QPointF(qMax(all.right(), one.right()), qMax(all.bottom(), one.bottom())));
    }
    return all;
}

void MapModel::onMap(const QJsonValue &data) {
    const double revision = data["revision"].toDouble();
    if (data["cleared"].toBool()) {
        edges_.clear();
        rows_.clear();
        ids_.clear();
    } else if (revision > revision_ + 1) {
        revision_ = std::numeric_limits<double>::infinity(); // changes were lost: the whole map anew, once
        QMetaObject::invokeMethod(&maps_, &TopicFeed::renew, Qt::QueuedConnection); // not from its callback
        return;
    }
    revision_ = revision;
    size_ = data["size"].toInt();
    for (const QJsonValue &edge : data["edges"].toArray()) {
        const qint64 id = qint64(edge["id"].toDouble());
        const QLineF line(edge["x1"].toDouble(), edge["y1"].toDouble(), edge["x2"].toDouble(),
                          edge["y2"].toDouble());
        const auto row = rows_.constFind(id);
        if (row != rows_.constEnd()) {
            edges_[*row] = line;
            continue;
        }
        rows_.insert(id, edges_.size());
        edges_.append(line);
        ids_.append(id);
    }
    for (const QJsonValue &removed : data["removed"].toArray()) {
        const auto found = rows_.find(qint64(removed.toDouble()));
        if (found == rows_.end())
            continue;
        const int row = *found; // the last edge takes its place
        rows_.erase(found);
        if (row != edges_.size() - 1) {
            edges_[row] = edges_.back();
            ids_[row] = ids_.back();
            rows_[ids_[row]] = row;
        }
        edges_.removeLast();
        ids_.removeLast();
    }
    Q_EMIT changed();
}

void MapModel::onPose(const QJsonValue &data) {
    pose_ = toPose(data);
    outcome_ = data["outcome"].toString();
    covariance_.reset();
    const QJsonArray covariance = data["covariance"].toArray();
    if (covariance.size() == 9) {
        covariance_.emplace();
        for (int i = 0; i < 9; ++i)
            (*covariance_)[size_t(i)] = covariance[i].toDouble();
    }
    const QJsonValue twist = data["twist"];
    twist_ = {twist["vx"].toDouble(), twist["vy"].toDouble(), twist["omega"].toDouble()};
    poseScan_ = data["scan"].toDouble();
    matched_.add(*pose_);
    placeScan();
    Q_EMIT changed();
}

void MapModel::onMatch(const QJsonValue &data) {
    reliability_ = data["reliability"].toDouble();
    ambiguity_ = data["ambiguity"].toDouble();
    pairs_.clear();
    for (const QJsonValue &pair : data["pairs"].toArray())
        pairs_.append({qint64(pair[0].toDouble()), pair[1].toInt()});
}

// The segments of a scan come right after its match.
void MapModel::onSegments(const QJsonValue &data) {
    segments_.clear();
    for (const QJsonValue &segment : data.toArray())
        segments_.append(toLine(segment.toArray()));
    correspondences_.clear();
    for (const auto &[edge, segment] : qAsConst(pairs_)) {
        const int row = rows_.value(edge, -1);
        if (row < 0 || segment < 0 || segment >= segments_.size())
            continue;
        correspondences_.append(QLineF(segments_[segment].center(), edges_[row].center()));
    }
    Q_EMIT changed();
}

void MapModel::onScan(const QJsonValue &data) {
    rawScan_ = data;
    placeScan();
    if (!poses_.source())
        Q_EMIT changed();
}

// A scan is drawn where the matcher found it, each point where the sensor was when it was measured: the pose
// is that of the middle of the turn.
void MapModel::placeScan() {
    if (poses_.source() && rawScan_["turn"].toDouble() != poseScan_)
        return;
    const MapPose at = pose_.value_or(MapPose());
    const QJsonArray x = rawScan_["x"].toArray(), y = rawScan_["y"].toArray(), t = rawScan_["t"].toArray();
    const double middle = rawScan_["duration_s"].toDouble() / 2;
    scan_.resize(qMin(x.size(), y.size()));
    for (int i = 0; i < scan_.size(); ++i) {
        const double dt = i < t.size() ? t.at(i).toDouble() - middle : 0;
        const MapPose moved{twist_.x * dt, twist_.y * dt, twist_.theta * dt};
        scan_[i] = at * (moved * QPointF(x.at(i).toDouble(), y.at(i).toDouble()));
    }
}

void MapModel::follow(Path &path, const QJsonValue &value) {
    if (!pose_ && poses_.source())
        return; // nothing to lay it against yet
    const MapPose pose = toPose(value);
    if (!path.frame)
        path.frame = pose_ ? *pose_ * pose.inverse() : MapPose();
    path.add(*path.frame * pose);
}

} // namespace hermes
