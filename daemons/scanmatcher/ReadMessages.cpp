#include "daemons/scanmatcher/ReadMessages.h"

#include "protocol/messages/Motion.h"
#include "protocol/messages/Turns.h"
#include "protocol/wire/Fields.h"

namespace hermes::scanmatcher {

namespace {

constexpr double latest = 1e10; // seconds since the epoch: beyond it stamps lose their digits

Error wrong(const char *what, const QString &text) {
    return {ErrorCode::InvalidParams, QString("%1, %2").arg(what, text)};
}

Error wrongSize(const char *member, std::size_t found, std::size_t expected) {
    return wrong("scan", QString("member %1: found an array of %2, expected %3, as many as in x")
                             .arg(member)
                             .arg(found)
                             .arg(expected));
}

} // namespace

Result<Scan> readScan(WireView data, quint64 &unknown) {
    ReadReport report;
    auto message = readMessage<ScanMessage>(data, report);
    unknown += report.unknown;
    if (!message)
        return wrong("scan", report.text());
    const std::size_t count = message->x.size();
    if (message->y.size() != count)
        return wrongSize("y", message->y.size(), count);
    if (message->t && message->t->size() != count)
        return wrongSize("t", message->t->size(), count);
    Scan scan;
    scan.number = message->header.turn;
    scan.partial = message->header.partial;
    scan.replayed = message->header.replayed;
    scan.data.stamp = message->header.stamp;
    scan.data.rays = std::size_t(message->header.rays.value_or(count));
    if (message->t)
        scan.data.seconds = std::move(*message->t);
    scan.data.points.reserve(count);
    for (std::size_t i = 0; i < count; ++i)
        scan.data.points.emplace_back(message->x[i], message->y[i]);
    return scan;
}

Result<vectorlib::OdometrySample> readOdometry(WireView data, double stamp, quint64 &unknown) {
    if (!(stamp >= 0 && stamp <= latest))
        return wrong("odometry",
                     QString("stamp: found %1, expected seconds since the Unix epoch").arg(stamp));
    ReadReport report;
    const auto message = readMessage<OdometryMessage>(data, report);
    unknown += report.unknown;
    if (!message)
        return wrong("odometry", report.text());
    vectorlib::OdometrySample sample{stamp,
                                     message->pose,
                                     {message->twist.vx, message->twist.vy, message->twist.omega},
                                     Eigen::Matrix3d(Eigen::Matrix3d::Zero())};
    for (int i = 0; i < 9; ++i) {
        const double value = message->covariance[std::size_t(i)];
        if (i % 4 == 0 && value < 0)
            return wrong("odometry",
                         QString("member covariance.%1: found %2, expected a variance of at least 0")
                             .arg(i)
                             .arg(value));
        (*sample.covariance)(i / 3, i % 3) = value;
    }
    return sample;
}

} // namespace hermes::scanmatcher
