#include "gui/desktop/view/MapModel.h"

#include "gui/desktop/widgets/ForeignText.h"

#include <QJsonArray>
#include <QtMath>
#include <algorithm>
#include <limits>

namespace hermes {
namespace {

constexpr double pathStep_m = 0.02;
constexpr int mostPathPoints = 100000;

constexpr int longestOutcome = 20;

bool isPlausible(double metresOrRadians) {
    return std::abs(metresOrRadians) <= MapModel::farthest_m; // not NaN
}

/// NaN: it is no number.
double toNumber(const QJsonValue &value) {
    return value.toDouble(std::numeric_limits<double>::quiet_NaN());
}

std::optional<MapPose> toPose(const QJsonValue &value) {
    const MapPose pose{toNumber(value["x"]), toNumber(value["y"]), toNumber(value["theta"])};
    if (!isPlausible(pose.x) || !isPlausible(pose.y) || !isPlausible(pose.theta))
        return std::nullopt;
    return pose;
}

std::optional<QLineF> toLine(const QJsonValue &x1, const QJsonValue &y1, const QJsonValue &x2,
                             const QJsonValue &y2) {
    const QLineF line(toNumber(x1), toNumber(y1), toNumber(x2), toNumber(y2));
    if (!isPlausible(line.x1()) || !isPlausible(line.y1()) || !isPlausible(line.x2()) ||
        !isPlausible(line.y2()))
        return std::nullopt;
    return line;
}

/// Whole numbers that a double holds; negative: it is none.
qint64 toId(const QJsonValue &value) {
    const double number = value.toDouble(-1);
    return number >= 0 && number <= 9007199254740992.0 ? qint64(number) : -1;
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
          fleet, "map", {{"queue", 100}}, [this](const TopicUpdate &u) { onMap(u.json()); }, this)
    , poses_(
          fleet, "pose", {}, [this](const TopicUpdate &u) { onPose(u.json()); }, this)
    , matches_(
          fleet, "match", {{"max_rate_hz", 10}}, [this](const TopicUpdate &u) { onMatch(u.json()); }, this)
    , segmentFeed_(
          fleet, "segments", {{"max_rate_hz", 10}}, [this](const TopicUpdate &u) { onSegments(u.json()); },
          this)
    , scans_(
          fleet, "scan2d", {{"max_rate_hz", 10}}, [this](const TopicUpdate &u) { onScan(u.json()); }, this)
    , odometryFeed_(
          fleet, "odometry", {{"max_rate_hz", 10}},
          [this](const TopicUpdate &u) { follow(odometry_, u.json()["pose"]); }, this)
    , truthFeed_(
          fleet, "truth", {{"max_rate_hz", 10}}, [this](const TopicUpdate &u) { follow(truth_, u.json()); },
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
        return maps_.renew();
    }
    revision_ = revision;
    size_ = data["size"].toInt();
    for (const QJsonValue &edge : data["edges"].toArray())
        addEdge(edge);
    for (const QJsonValue &removed : data["removed"].toArray())
        removeEdge(toId(removed));
    Q_EMIT changed();
}

void MapModel::addEdge(const QJsonValue &edge) {
    const qint64 id = toId(edge["id"]);
    const auto line = toLine(edge["x1"], edge["y1"], edge["x2"], edge["y2"]);
    const auto row = rows_.constFind(id);
    const bool isNew = row == rows_.constEnd();
    if (!line || id < 0 || (isNew && edges_.size() >= mostEdges)) {
        ++ignored_;
        return;
    }
    if (!isNew) {
        edges_[*row] = *line;
        return;
    }
    rows_.insert(id, edges_.size());
    edges_.append(*line);
    ids_.append(id);
}

void MapModel::removeEdge(qint64 id) {
    const auto found = rows_.find(id);
    if (found == rows_.end())
        return;
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

void MapModel::onPose(const QJsonValue &data) {
    const auto pose = toPose(data);
    if (!pose) {
        ++ignored_;
        return Q_EMIT changed();
    }
    pose_ = pose;
    outcome_ = shortLine(data["outcome"].toString(), longestOutcome);
    covariance_.reset();
    const QJsonArray covariance = data["covariance"].toArray();
    if (covariance.size() == 9) {
        covariance_.emplace();
        for (int i = 0; i < 9; ++i)
            (*covariance_)[size_t(i)] = toNumber(covariance[i]);
        const auto isVariance = [](double v) { return std::abs(v) <= farthest_m * farthest_m; };
        if (!std::all_of(covariance_->begin(), covariance_->end(), isVariance)) {
            covariance_.reset();
            ++ignored_;
        }
    }
    const QJsonValue twist = data["twist"];
    const MapPose velocity{twist["vx"].toDouble(), twist["vy"].toDouble(), twist["omega"].toDouble()};
    const bool isMoving = isPlausible(velocity.x) && isPlausible(velocity.y) && isPlausible(velocity.theta);
    twist_ = isMoving ? velocity : MapPose();
    ignored_ += !isMoving;
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
        pairs_.append({toId(pair[0]), pair[1].toInt(-1)});
}

// The segments of a scan come right after its match.
void MapModel::onSegments(const QJsonValue &data) {
    segments_.clear();
    for (const QJsonValue &segment : data.toArray())
        if (const auto line = toLine(segment[0], segment[1], segment[2], segment[3]))
            segments_.append(*line);
        else
            ++ignored_;
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
    const int count = qMin(x.size(), y.size());
    scan_.clear();
    scan_.reserve(count);
    for (int i = 0; i < count; ++i) {
        const double dt = i < t.size() ? t.at(i).toDouble() - middle : 0;
        const MapPose moved{twist_.x * dt, twist_.y * dt, twist_.theta * dt};
        const QPointF point = at * (moved * QPointF(toNumber(x.at(i)), toNumber(y.at(i))));
        if (isPlausible(point.x()) && isPlausible(point.y()))
            scan_.append(point);
        else
            ++ignored_;
    }
}

void MapModel::follow(Path &path, const QJsonValue &value) {
    if (!pose_ && poses_.source())
        return; // nothing to lay it against yet
    const auto pose = toPose(value);
    if (!pose) {
        ++ignored_;
        return Q_EMIT changed();
    }
    if (!path.frame)
        path.frame = pose_ ? *pose_ * pose->inverse() : MapPose();
    path.add(*path.frame * *pose);
}

} // namespace hermes
