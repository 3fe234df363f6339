#include "daemons/scanmatcher/ReadMessages.h"

#include <QJsonArray>
#include <array>
#include <cmath>

namespace hermes {

namespace {

constexpr int maxPoints = 1000000;

Error wrong(const QString &member, const QString &found, const QString &expected) {
    return {ErrorCode::InvalidParams,
            QString("scan, member %1: found %2, expected %3").arg(member, found, expected)};
}

// Empty when a member is absent; otherwise exactly `count` finite numbers (any number of them when count <
// 0).
Result<std::vector<float>> numbers(const QJsonObject &data, const char *member, int count) {
    const QJsonValue value = data.value(QLatin1String(member));
    if (!value.isArray())
        return wrong(member, value.isUndefined() ? "nothing" : "no array", "an array of numbers");
    const QJsonArray array = value.toArray();
    if (array.size() > maxPoints)
        return wrong(member, QString("%1 numbers").arg(array.size()), QString("at most %1").arg(maxPoints));
    if (count >= 0 && array.size() != count)
        return wrong(member, QString("%1 numbers").arg(array.size()),
                     QString("%1, as many as in x").arg(count));
    std::vector<float> result;
    result.reserve(size_t(array.size()));
    for (const QJsonValue &v : array) {
        if (!v.isDouble() || !std::isfinite(float(v.toDouble())))
            return wrong(member, QString("an element %1 that is no number").arg(result.size()),
                         "finite numbers");
        result.push_back(float(v.toDouble()));
    }
    return result;
}

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

Result<Scan> readScan(const QJsonObject &data) {
    Scan scan;
    const QJsonValue stamp = data.value("stamp");
    if (!stamp.isDouble() || !std::isfinite(stamp.toDouble()))
        return wrong("stamp", "no number", "seconds since the Unix epoch");
    scan.data.stamp = stamp.toDouble();
    scan.number = quint64(std::max(0.0, data.value("turn").toDouble()));
    scan.partial = data.value("partial").toBool();
    const auto x = numbers(data, "x", -1);
    if (!x)
        return x.error();
    const auto y = numbers(data, "y", int(x->size()));
    if (!y)
        return y.error();
    if (data.contains("t")) {
        auto t = numbers(data, "t", int(x->size()));
        if (!t)
            return t.error();
        scan.data.seconds = t.take();
    }
    scan.data.points.reserve(x->size());
    for (size_t i = 0; i < x->size(); ++i)
        scan.data.points.emplace_back((*x)[i], (*y)[i]);
    scan.data.rays = x->size();
    if (data.contains("rays")) {
        const double rays = data.value("rays").toDouble(-1);
        if (!(rays >= 0 && rays <= maxPoints))
            return wrong("rays", data.value("rays").isDouble() ? QString::number(rays) : "no number",
                         QString("a count up to %1").arg(maxPoints));
        scan.data.rays = size_t(rays);
    }
    return scan;
}

Result<vectorlib::OdometrySample> readOdometry(const QJsonObject &data, double stamp) {
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
    vectorlib::OdometrySample sample{*time,
                                     {pose.value()[0], pose.value()[1], pose.value()[2]},
                                     {twist.value()[0], twist.value()[1], twist.value()[2]},
                                     Eigen::Matrix3d(Eigen::Matrix3d::Zero())};
    for (int i = 0; i < 9; ++i) {
        const bool diagonal = i % 4 == 0;
        const auto value = number(covariance[i], QString("covariance[%1]").arg(i), diagonal ? 0 : -largest);
        if (!value)
            return value.error();
        (*sample.covariance)(i / 3, i % 3) = *value;
    }
    return sample;
}

} // namespace hermes
