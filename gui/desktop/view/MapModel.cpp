#include "gui/desktop/view/MapModel.h"

#include "gui/desktop/view/Plausible.h"
#include "gui/desktop/widgets/ForeignText.h"
#include "protocol/wire/Fields.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hermes::desktop {
namespace {

constexpr std::chrono::milliseconds framePeriod{30}; // of the movement of a corrected map
constexpr int longestOutcome = 20;

std::optional<QLineF> toLine(double x1, double y1, double x2, double y2) {
    if (!isPlausible(x1) || !isPlausible(y1) || !isPlausible(x2) || !isPlausible(y2))
        return std::nullopt;
    return QLineF(x1, y1, x2, y2);
}

} // namespace

template <typename Message>
Client::TopicCallback MapModel::reader(void (MapModel::*take)(const Message &)) {
    return [this, take](const TopicUpdate &update) {
        ReadReport report;
        stamp_ = update.stamp;
        if (const auto message = readMessage<Message>(update.data, report))
            return (this->*take)(*message);
        ++ignored_;
        Q_EMIT changed();
    };
}

MapModel::MapModel(Fleet &fleet, QObject *parent)
    : QObject(parent)
    , maps_(fleet, "map", {{"queue", 100}}, reader(&MapModel::onMap), this)
    , graphs_(fleet, "graph", {{"queue", 100}}, reader(&MapModel::onGraph), this)
    , poses_(fleet, "pose", {}, reader(&MapModel::onPose), this)
    , results_(fleet, "scan", {{"max_rate_hz", 10}}, reader(&MapModel::onResult), this)
    , scans_(fleet, "scan2d", {{"max_rate_hz", 10}}, reader(&MapModel::onScan), this)
    , odometryFeed_(fleet, "odometry", {{"max_rate_hz", 10}}, reader(&MapModel::onOdometry), this)
    , truthFeed_(fleet, "truth", {{"max_rate_hz", 10}}, reader(&MapModel::onTruth), this) {
    connect(&maps_, &TopicFeed::sourceChanged, this, [this] { onMap({0, true, {}, {}, 0}); });
    connect(&graphs_, &TopicFeed::sourceChanged, this, [this] { onGraph({0, true, 0, {}, {}, {}, 0}); });
    connect(&poses_, &TopicFeed::sourceChanged, this, [this] {
        endGlide();
        pose_.reset();
        poseAge_.forget();
        trust_.reset();
        odometryFrame_.reset();
        aside_.clear();
        clearPaths();
    });
    connect(&results_, &TopicFeed::sourceChanged, this, [this] { onResult({}); });
    connect(&scans_, &TopicFeed::sourceChanged, this, [this] {
        rawScan_ = {};
        scanAge_.forget();
        scan_.clear();
        Q_EMIT changed();
    });
    connect(&odometryFeed_, &TopicFeed::sourceChanged, this, [this] { forgetPath(MovingMap::Odometry); });
    connect(&truthFeed_, &TopicFeed::sourceChanged, this, [this] { forgetPath(MovingMap::Truth); });
    frames_.setInterval(framePeriod);
    connect(&frames_, &QTimer::timeout, this, &MapModel::showGlide);
    wait_.setInterval(signWait);
    connect(&wait_, &QTimer::timeout, this, &MapModel::onWaitOver);
    notice_.setInterval(noticeTime);
    connect(&notice_, &QTimer::timeout, this, [this] {
        correction_m_.reset();
        Q_EMIT changed();
    });
    ageing_.setInterval(100);
    connect(&ageing_, &QTimer::timeout, this, [this] {
        const auto shown = [](const Freshness &age) { return std::pair(age.state(), age.text()); };
        const auto now = std::pair(shown(poseAge_), shown(scanAge_));
        if (std::exchange(shownAge_, now) != now)
            Q_EMIT changed();
    });
    ageing_.start();
    wait_.setSingleShot(true);
    notice_.setSingleShot(true);
}

QRectF MapModel::bounds() const {
    QRectF all;
    for (const QLineF &edge : edges()) {
        const QRectF one = QRectF(edge.p1(), edge.p2()).normalized();
        all = all.isNull()
                  ? one
                  : QRectF(QPointF(qMin(all.left(), one.left()), qMin(all.top(), one.top())),
                           QPointF(qMax(all.right(), one.right()), qMax(all.bottom(), one.bottom())));
    }
    return all;
}

void MapModel::onMap(const MapMessage &map) {
    if (map.cleared && map.map != map_.first) {
        turnTo({map.map, map_.second});
        edges_.clear(); // the new one is no correction of them
    }
    if (map.cleared) {
        if (map.size <= 0)
            endGlide(); // the map was cleared, not corrected
        else if (!edges_.isEmpty() && !isMapRenewed_ && graph_.known().size() > 0)
            expectCorrection(MapSign);
        isMapRenewed_ = false;
        edges_.clear();
        rows_.clear();
        ids_.clear();
    } else if (double(map.revision) > revision_ + 1) {
        revision_ = std::numeric_limits<double>::infinity(); // changes were lost: the whole map anew, once
        isMapRenewed_ = true;
        return maps_.renew();
    }
    revision_ = double(map.revision);
    size_ = int(qMin<qint64>(map.size, maxEdges));
    for (const MapEdgeMessage &edge : map.edges)
        addEdge(edge);
    for (qint64 removed : map.removed)
        removeEdge(removed);
    resume();
    Q_EMIT changed();
}

void MapModel::addEdge(const MapEdgeMessage &edge) {
    const auto line = toLine(edge.x1, edge.y1, edge.x2, edge.y2);
    const auto row = rows_.constFind(edge.id);
    const bool isNew = row == rows_.constEnd();
    if (!line || (isNew && edges_.size() >= maxEdges)) {
        ++ignored_;
        return;
    }
    if (!isNew) {
        edges_[*row] = *line;
        return;
    }
    rows_.insert(edge.id, edges_.size());
    edges_.append(*line);
    ids_.append(edge.id);
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

void MapModel::onPose(const PoseMessage &message) {
    if (!isPlausible(message.pose)) {
        ++ignored_;
        return Q_EMIT changed();
    }
    takeLeap(message);
    pose_ = message.pose;
    poseAge_.heard(poses_.source());
    takeTrust(message.trust);
    outcome_ = shortLine(message.outcome, longestOutcome);
    covariance_ = message.covariance;
    const auto isVariance = [](double v) { return std::abs(v) <= farthest_m * farthest_m; };
    if (covariance_ && !std::all_of(covariance_->begin(), covariance_->end(), isVariance)) {
        covariance_.reset();
        ++ignored_;
    }
    const bool isMoving = isPlausible(message.twist);
    twist_ = isMoving ? message.twist : Twist2D();
    ignored_ += !isMoving;
    poseScan_ = message.scan;
    handedness_ = message.upsideDown ? -1 : 1;
    if (poseLead_ == 0)
        paths_[MovingMap::Matched].add(*pose_, moment(twist_), newestKeyScan());
    placeScan();
    resume();
    Q_EMIT changed();
}

void MapModel::takeTrust(double trust) {
    trust_.reset();
    if (!graphs_.source())
        return; // a matcher without a graph has no trust to tell
    if (trust >= 0 && trust <= 1)
        trust_ = trust;
    else
        ++ignored_;
}

void MapModel::onResult(const ScanResult &result) {
    reliability_ = result.match.reliability;
    ambiguity_ = result.match.ambiguity;
    segments_.clear();
    for (const auto &[x1, y1, x2, y2] : result.segments)
        if (const auto line = toLine(x1, y1, x2, y2))
            segments_.append(*line);
        else
            ++ignored_;
    correspondences_.clear();
    for (const auto &[edge, segment] : result.match.pairs) {
        const int row = rows_.value(edge, -1);
        if (row >= 0 && segment >= 0 && segment < segments_.size())
            correspondences_.append(QLineF(segments_[int(segment)].center(), edges_[row].center()));
    }
    Q_EMIT changed();
}

void MapModel::onScan(const ScanMessage &scan) {
    if (scan.header.replayed != map_.second)
        turnTo({map_.first, scan.header.replayed});
    rawScan_ = scan;
    scanAge_.heard(scans_.source());
    placeScan();
    if (!poses_.source())
        Q_EMIT changed();
}

// A scan is drawn where the matcher found it, each point where the sensor was when it was measured: the pose
// is that of the middle of the turn.
void MapModel::placeScan() {
    if (poses_.source() && rawScan_.header.turn != poseScan_)
        return;
    const Pose2D at = pose_.value_or(Pose2D());
    const double middle = rawScan_.header.duration_s / 2;
    const std::size_t count = qMin(rawScan_.x.size(), rawScan_.y.size());
    scan_.clear();
    scan_.reserve(int(count));
    for (std::size_t i = 0; i < count; ++i) {
        const double dt = rawScan_.t && i < rawScan_.t->size() ? double((*rawScan_.t)[i]) - middle : 0;
        const QPointF point =
            at * (twist_.motion(dt) * QPointF(double(rawScan_.x[i]), handedness_ * double(rawScan_.y[i])));
        if (isPlausible(point.x()) && isPlausible(point.y()))
            scan_.append(point);
        else
            ++ignored_;
    }
}

} // namespace hermes::desktop
