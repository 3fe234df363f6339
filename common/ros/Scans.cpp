#include "common/ros/Scans.h"

#include "common/ros/Mapping.h"
#include "protocol/velodyne/SensorModel.h"

#include <cmath>
#include <cstring>

namespace hermes::ros {
namespace {

constexpr float leastRange = 0.05f, greatestRange = 130; // m: no scanner that Hermes knows sees farther
constexpr float noReturn = std::numeric_limits<float>::infinity();
constexpr float unknownRange = std::numeric_limits<float>::quiet_NaN();
constexpr double fullCircle = 2 * M_PI;
/// Each ray of ROS has one of the scanner at least, also when it turns unevenly.
constexpr double leastShare = 0.9;

/// A usual number that the scanner's rays fill.
std::size_t binsFor(std::size_t rays) {
    for (const std::size_t count :
         {3600, 2880, 2400, 1800, 1440, 1080, 900, 720, 600, 540, 450, 360, 300, 240, 180})
        if (double(count) <= leastShare * double(rays))
            return count;
    return 90;
}

/// Of each laser of a sensor: how many look below it. Empty: the sensor is not known, its lasers count as
/// they are.
std::vector<std::uint16_t> ringsOf(const QString &model) {
    std::vector<std::uint16_t> rings;
    for (const velodyne::SensorModel *const one : velodyne::sensorModels())
        if (model == QLatin1String(one->name))
            for (int laser = 0; laser < one->lasers; ++laser)
                rings.push_back(std::uint16_t(one->ring(laser)));
    return rings;
}

} // namespace

bool ScanBins::operator()(const ScanMessage &in, const Told &told, LaserScan &out) {
    const std::size_t points = std::min({in.x.size(), in.y.size(), in.intensity.size()});
    if (isSeen_.empty()) {
        if (in.header.partial || points == 0)
            return false; // it says nothing of how many rays there are
        isSeen_.resize(binsFor(std::size_t(in.header.rays.value_or(points))));
    }
    const std::size_t count = isSeen_.size();
    const double increment = fullCircle / double(count);
    out.header = headerOf(in.header.stamp, told.robot.sensorFrame(told.daemon));
    out.angleMin = float(-M_PI);
    out.angleIncrement = float(increment);
    out.angleMax = float(-M_PI + double(count - 1) * increment);
    out.scanTime = float(in.header.duration_s);
    out.rangeMin = leastRange;
    out.rangeMax = greatestRange;
    out.ranges.assign(count, noReturn);
    out.intensities.assign(count, 0);
    for (std::size_t i = 0; i < points; ++i) {
        const double angle = std::atan2(double(in.y[i]), double(in.x[i]));
        const float range = std::hypot(in.x[i], in.y[i]);
        if (!(range >= leastRange && range <= greatestRange))
            continue;
        const std::size_t bin = std::size_t((angle + M_PI) / increment + 0.5) % count;
        isSeen_[bin] = true;
        if (range < out.ranges[bin]) {
            out.ranges[bin] = range;
            out.intensities[bin] = in.intensity[i];
        }
    }
    const bool hasGaps = in.header.partial || in.header.lostPackets != 0;
    for (std::size_t i = 0; i < count; ++i)
        if (out.ranges[i] == noReturn && (hasGaps || !isSeen_[i]))
            out.ranges[i] = unknownRange;
    return true;
}

bool CloudPoints::operator()(const CloudMessage &in, const Told &told, PointCloud &out) {
    using F = PointField;
    const std::size_t points =
        std::min({in.x.size(), in.y.size(), in.z.size(), in.laser.size(), in.intensity.size()});
    out.header = headerOf(in.header.stamp, told.robot.sensorFrame(told.daemon));
    out.width = std::uint32_t(points);
    out.fields = {{"x", 0, F::Float32, 1},          {"y", 4, F::Float32, 1},    {"z", 8, F::Float32, 1},
                  {"intensity", 12, F::Float32, 1}, {"ring", 16, F::UInt16, 1}, {"time", 18, F::Float32, 1}};
    constexpr std::uint32_t step = 22;
    out.pointStep = step;
    out.rowStep = std::uint32_t(points) * step;
    out.data.resize(points * step);
    const std::vector<std::uint16_t> rings = ringsOf(in.model);
    for (std::size_t i = 0; i < points; ++i) {
        const std::uint16_t ring = in.laser[i] < rings.size() ? rings[in.laser[i]] : in.laser[i];
        const float values[] = {in.x[i], in.y[i], in.z[i], float(in.intensity[i])};
        // The points are in the order of measuring, and were thinned evenly.
        const float time = float(in.header.duration_s * double(i) / double(points));
        std::uint8_t *const to = out.data.data() + i * step;
        std::memcpy(to, values, sizeof values);
        std::memcpy(to + 16, &ring, 2);
        std::memcpy(to + 18, &time, 4);
    }
    return true;
}

} // namespace hermes::ros
