#include "daemons/scanmatcher/OdometrySample.h"

#include <QJsonArray>
#include <array>

namespace hermes {

namespace {

constexpr double largest = 1e10; // beyond it differences of poses lose their digits

Result<double> number(const QJsonValue &value, const QString &member, double least = -largest) {
    if (value.isDouble() && value.toDouble() >= least && value.toDouble() <= largest)
        return value.toDouble();
    const QString found = value.isDouble() ? QString::number(value.toDouble()) : QString("no number");
    return Error(ErrorCode::InvalidParams,
                 QString("odometry, member %1: found %2, expected a number from %3 to %4")
                     .arg(member, found)
                     .arg(least)
                     .arg(largest));
}

Result<std::array<double, 3>> three(const QJsonObject &data, const char *object,
                                    const std::array<const char *, 3> &members) {
    const QJsonObject values = data.value(QLatin1String(object)).toObject();
    std::array<double, 3> result{};
    for (std::size_t i = 0; i < 3; ++i) {
        const auto value =
            number(values.value(QLatin1String(members[i])), QString("%1.%2").arg(object, members[i]));
        if (!value)
            return value.error();
        result[i] = *value;
    }
    return result;
}

} // namespace

Result<OdometrySample> parseOdometry(const QJsonObject &data, double stamp) {
    const auto time = number(stamp, "stamp", 0);
    if (!time)
        return time.error();
    const auto pose = three(data, "pose", {"x", "y", "theta"});
    if (!pose)
        return pose.error();
    const auto twist = three(data, "twist", {"vx", "vy", "omega"});
    if (!twist)
        return twist.error();
    const QJsonArray covariance = data.value("covariance").toArray();
    if (covariance.size() != 9)
        return Error(
            ErrorCode::InvalidParams,
            QString("odometry, member covariance: found %1 numbers, expected 9").arg(covariance.size()));
    OdometrySample sample{*time,
                          {pose.value()[0], pose.value()[1], pose.value()[2]},
                          {twist.value()[0], twist.value()[1], twist.value()[2]},
                          Eigen::Matrix3d::Zero()};
    for (int i = 0; i < 9; ++i) {
        const bool diagonal = i % 4 == 0;
        const auto value = number(covariance[i], QString("covariance[%1]").arg(i), diagonal ? 0 : -largest);
        if (!value)
            return value.error();
        sample.covariance(i / 3, i % 3) = *value;
    }
    return sample;
}

} // namespace hermes
