#include "daemons/scanmatcher/Scan.h"

#include <QJsonArray>
#include <algorithm>
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

} // namespace

double Scan::begin() const {
    return stamp + (seconds.empty() ? 0 : double(*std::min_element(seconds.begin(), seconds.end())));
}

double Scan::end() const {
    return stamp + (seconds.empty() ? 0 : double(*std::max_element(seconds.begin(), seconds.end())));
}

Result<Scan> parseScan(const QJsonObject &data) {
    Scan scan;
    const QJsonValue stamp = data.value("stamp");
    if (!stamp.isDouble() || !std::isfinite(stamp.toDouble()))
        return wrong("stamp", "no number", "seconds since the Unix epoch");
    scan.stamp = stamp.toDouble();
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
        scan.seconds = t.take();
    }
    scan.points.reserve(x->size());
    for (size_t i = 0; i < x->size(); ++i)
        scan.points.emplace_back((*x)[i], (*y)[i]);
    return scan;
}

} // namespace hermes
