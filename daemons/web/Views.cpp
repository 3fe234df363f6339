#include "daemons/web/Views.h"

#include "daemons/web/MapScene.h"
#include "daemons/web/PlainJson.h"
#include "protocol/messages/Daemons.h"
#include "protocol/messages/Fixes.h"
#include "protocol/messages/Turns.h"
#include "protocol/wire/Fields.h"
#include "protocol/wire/JsonText.h"

#include <QtEndian>

namespace hermes::web {
namespace {

/// One message of each.
template <QJsonObject (*make)(FrameTree &, const Origin &, ReadReport &)>
class EachView : public View {
public:
    explicit EachView(FrameTree &frames)
        : frames_(frames) {}
    QByteArray take(const Origin &origin, ReadReport &report) override {
        const QJsonObject message = make(frames_, origin, report);
        return message.isEmpty() ? QByteArray() : compactJson(message);
    }
    static std::unique_ptr<View> create(FrameTree &frames) { return std::make_unique<EachView>(frames); }

private:
    FrameTree &frames_;
};

/// foxglove.PointCloud of x, y, z and intensity as floats. z: empty where all are 0.
QJsonObject cloudJson(const TurnHeader &header, const QString &frame, const std::vector<float> &x,
                      const std::vector<float> &y, const std::vector<float> &z,
                      const std::vector<quint8> &intensity) {
    constexpr int float32 = 7, stride = 16;
    QByteArray data(stride * int(x.size()), 0);
    for (std::size_t i = 0; i < x.size(); ++i) {
        const std::array<float, 4> point{x[i], y[i], i < z.size() ? z[i] : 0,
                                         i < intensity.size() ? float(intensity[i]) : 0};
        qToLittleEndian<float>(point.data(), 4, data.data() + stride * int(i));
    }
    QJsonArray fields;
    for (const char *name : {"x", "y", "z", "intensity"})
        fields.append(QJsonObject{{"name", name}, {"offset", 4 * fields.size()}, {"type", float32}});
    return {{"timestamp", timeJson(header.stamp)},
            {"frame_id", frame},
            {"pose", poseJson({})},
            {"point_stride", stride},
            {"fields", fields},
            {"data", QString::fromLatin1(data.toBase64())}};
}

bool haveSameLength(const Origin &origin, std::size_t x, std::size_t y, ReadReport &report) {
    if (x != y)
        report.fail(origin.update.data, QString("x and y of the same length, not %1 and %2").arg(x).arg(y));
    return x == y;
}

QJsonObject scanJson(FrameTree &, const Origin &origin, ReadReport &report) {
    const auto scan = readMessage<ScanMessage>(origin.update.data, report);
    if (!scan || !haveSameLength(origin, scan->x.size(), scan->y.size(), report))
        return {};
    return cloudJson(scan->header, origin.daemon, scan->x, scan->y, {}, scan->intensity);
}

QJsonObject turnJson(FrameTree &, const Origin &origin, ReadReport &report) {
    const auto cloud = readMessage<CloudMessage>(origin.update.data, report);
    if (!cloud || !haveSameLength(origin, cloud->x.size(), cloud->y.size(), report))
        return {};
    return cloudJson(cloud->header, origin.daemon, cloud->x, cloud->y, cloud->z, cloud->intensity);
}

QJsonObject matchedPoseJson(FrameTree &, const Origin &origin, ReadReport &report) {
    const auto pose = readMessage<PoseMessage>(origin.update.data, report);
    if (!pose)
        return {};
    return {
        {"timestamp", timeJson(origin.update.stamp)}, {"frame_id", "map"}, {"pose", poseJson(pose->pose)}};
}

QJsonObject logJson(FrameTree &, const Origin &origin, ReadReport &report) {
    const auto record = readMessage<LogMessage>(origin.update.data, report);
    if (!record)
        return {};
    static const QStringList levels{"unknown", "debug", "info", "warning", "error"};
    return {{"timestamp", timeJson(record->stamp)},
            {"level", std::max(0, levels.indexOf(record->level))},
            {"message", record->text},
            {"name", origin.daemon + ' ' + record->source},
            {"file", ""},
            {"line", 0}};
}

/// Nothing where the receiver does not know its place.
QJsonObject fixJson(FrameTree &, const Origin &origin, ReadReport &report) {
    const auto fix = readMessage<FixMessage>(origin.update.data, report);
    if (!fix || !fix->values.valid || !fix->values.lat_deg || !fix->values.lon_deg)
        return {};
    return {{"timestamp", timeJson(origin.update.stamp)},
            {"frame_id", "gps"},
            {"latitude", *fix->values.lat_deg},
            {"longitude", *fix->values.lon_deg},
            {"altitude", fix->values.alt.value_or(0)},
            {"position_covariance", QJsonArray{0, 0, 0, 0, 0, 0, 0, 0, 0}},
            {"position_covariance_type", 0}};
}

QJsonObject framesJson(FrameTree &frames, const Origin &origin, ReadReport &report) {
    if (origin.update.topic == "odometry") {
        if (const auto odometry = readMessage<OdometryMessage>(origin.update.data, report))
            frames.setOdometry(odometry->pose);
    } else if (const auto pose = readMessage<PoseMessage>(origin.update.data, report)) {
        frames.setPose(*pose);
    }
    return report.hasFailed() ? QJsonObject() : frames.transforms(origin.update.stamp);
}

class PlainView : public View {
public:
    QByteArray take(const Origin &origin, ReadReport &) override {
        return plainJson(origin.update.data, origin.update.replayed);
    }
};

} // namespace

const std::vector<ViewKind> &viewKinds() {
    static const std::vector<ViewKind> all{
        {"scan2d", "", "PointCloud", EachView<scanJson>::create},
        {"cloud", "", "PointCloud", EachView<turnJson>::create},
        {"map", "", "SceneUpdate", [](FrameTree &) { return std::unique_ptr<View>(new MapScene); }},
        {"log", "", "Log", EachView<logJson>::create},
        {"pose", "/frame", "PoseInFrame", EachView<matchedPoseJson>::create},
        {"fix", "/place", "LocationFix", EachView<fixJson>::create},
    };
    return all;
}

const QSet<QString> &frameTopics() {
    static const QSet<QString> all{"odometry", "pose"};
    return all;
}

std::unique_ptr<View> makeFramesView(FrameTree &frames) {
    return EachView<framesJson>::create(frames);
}

std::unique_ptr<View> makePlainView() {
    return std::make_unique<PlainView>();
}

} // namespace hermes::web
