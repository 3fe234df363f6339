#include "gui/vector/BagScan.h"

#include "gui/vector/BagMessages.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

namespace hermes::vector {

namespace {

/// A point of a cloud while they are put in order.
struct CloudPoint {
    vectorlib::Vector2D<float> point;
    float seconds = 0;
    double angle = 0;
};

/// Whether a scan of so many rays can be; tells why not.
template <typename M>
std::string faultOfRays(const M &message) {
    const auto number = [](double value) { return std::to_string(value); };
    if (message.ranges.size() > BagScan::mostRays)
        return "found " + std::to_string(message.ranges.size()) + " rays, expected at most " +
               std::to_string(BagScan::mostRays);
    if (!std::isfinite(message.angleMin) || !(std::abs(message.angleIncrement) > 0) ||
        !(std::abs(message.angleIncrement) * float(message.ranges.size()) < 7))
        return "found the angles " + number(double(message.angleMin)) + " + i * " +
               number(double(message.angleIncrement)) + " of " + std::to_string(message.ranges.size()) +
               " rays, expected at most a turn";
    return {};
}

/// range(i): that of a ray, or NaN.
template <typename M, typename Range>
std::string readRays(const M &message, const Range &range, vectorlib::TimedScan &scan) {
    if (std::string fault = faultOfRays(message); !fault.empty())
        return fault;
    const std::size_t rays = message.ranges.size();
    const double each_s = double(message.timeIncrement);
    const bool isTimed = each_s != 0 && std::abs(each_s) * double(rays) < BagScan::longestScan_s;
    const bool isClockwise = message.angleIncrement < 0;
    scan.points.clear();
    scan.seconds.clear();
    for (std::size_t k = 0; k < rays; ++k) {
        const std::size_t i = isClockwise ? rays - 1 - k : k;
        const double distance = range(i);
        if (!std::isfinite(distance))
            continue;
        const double angle = double(message.angleMin) + double(i) * double(message.angleIncrement);
        scan.points.emplace_back(float(distance * std::cos(angle)), float(distance * std::sin(angle)));
        if (isTimed)
            scan.seconds.push_back(float(double(i) * each_s));
    }
    scan.rays = rays;
    scan.fieldOfView = std::abs(double(message.angleIncrement)) * double(rays);
    scan.closed = scan.fieldOfView > 2 * vectorlib::pi - 1e-3;
    return {};
}

/// The range, or NaN where there is no return: a scanner gives the longest one where it saw nothing.
template <typename M>
double returnOf(const M &message, float range) {
    const bool isReturn = range > 0 && range >= message.rangeMin &&
                          (range < message.rangeMax || !(message.rangeMax > message.rangeMin));
    return isReturn && std::isfinite(range) ? double(range) : std::nan("");
}

/// A number of each point of a cloud.
class CloudField {
public:
    /// Not there: isThere() is false.
    CloudField(const ros::PointCloud &cloud, const char *name)
        : isSwapped_(cloud.isBigEndian) {
        for (const ros::PointField &field : cloud.fields)
            if (field.name == name && size(field.datatype) > 0 && field.offset <= cloud.pointStep &&
                size(field.datatype) <= cloud.pointStep - field.offset) {
                offset_ = field.offset;
                type_ = field.datatype;
            }
    }
    bool isThere() const { return type_ != 0; }
    std::uint8_t type() const { return type_; }
    /// point: as many bytes as a point of the cloud has.
    double of(const std::uint8_t *point) const {
        using F = ros::PointField;
        switch (type_) {
        case F::Int8:
            return as<std::int8_t>(point);
        case F::UInt8:
            return as<std::uint8_t>(point);
        case F::Int16:
            return as<std::int16_t>(point);
        case F::UInt16:
            return as<std::uint16_t>(point);
        case F::Int32:
            return as<std::int32_t>(point);
        case F::UInt32:
            return as<std::uint32_t>(point);
        case F::Float32:
            return double(as<float>(point));
        default:
            return as<double>(point);
        }
    }

private:
    static std::size_t size(std::uint8_t type) {
        constexpr std::size_t sizes[] = {0, 1, 1, 2, 2, 4, 4, 4, 8};
        return type < std::size(sizes) ? sizes[type] : 0;
    }
    template <typename T>
    T as(const std::uint8_t *point) const {
        std::uint8_t bytes[sizeof(T)];
        std::memcpy(bytes, point + offset_, sizeof(T));
        if (isSwapped_)
            std::reverse(std::begin(bytes), std::end(bytes));
        T value;
        std::memcpy(&value, bytes, sizeof(T));
        return value;
    }

    bool isSwapped_;
    std::uint32_t offset_ = 0;
    std::uint8_t type_ = 0;
};

/// Reads the points of a cloud one by one.
struct Cloud {
    const ros::PointCloud &message;
    CloudField x{message, "x"}, y{message, "y"}, z{message, "z"}, ring{message, "ring"}, t{message, "t"},
        time{message, "time"};

    std::string fault() const {
        const std::uint64_t rowBytes = std::uint64_t(message.width) * message.pointStep;
        if (!x.isThere() || !y.isThere() || !z.isThere())
            return "found no fields x, y and z of numbers within a point";
        return message.rowStep < rowBytes ||
                       std::uint64_t(message.rowStep) * message.height > message.data.size()
                   ? "found " + std::to_string(message.data.size()) + " bytes, expected " +
                         std::to_string(message.height) + " rows of " + std::to_string(message.width) +
                         " points of " + std::to_string(message.pointStep) + " bytes"
                   : "";
    }
    /// Whether there are rings: by a field, or as the rows of the cloud.
    bool hasRings() const { return ring.isThere() || (message.height > 1 && message.height <= 256); }
    /// Gives each point, and the number of its ring.
    template <typename Take>
    void each(const Take &take) const {
        for (std::uint32_t row = 0; message.width > 0 && row < message.height; ++row)
            for (std::uint32_t i = 0; i < message.width; ++i) {
                const std::uint8_t *const point = message.data.data() + std::size_t(row) * message.rowStep +
                                                  std::size_t(i) * message.pointStep;
                take(point, ring.isThere() ? ringOf(point) : int(row));
            }
    }
    int ringOf(const std::uint8_t *point) const {
        const double number = ring.of(point);
        return number >= 0 && number < 1e6 ? int(number) : -1;
    }
    /// Seconds after the stamp of the message.
    float secondsOf(const std::uint8_t *point) const {
        const double seconds = t.type() == ros::PointField::UInt32       ? 1e-9 * t.of(point)
                               : time.type() == ros::PointField::Float32 ? time.of(point)
                                                                         : 0;
        return std::abs(seconds) < BagScan::longestScan_s ? float(seconds) : 0;
    }
    bool isTimed() const {
        return t.type() == ros::PointField::UInt32 || time.type() == ros::PointField::Float32;
    }
};

/// The ring whose points are nearest to the horizon of the sensor; nothing where none has points.
std::optional<int> horizonRing(const Cloud &cloud) {
    constexpr double leastShare = 0.2; // of the points of the fullest ring
    struct Sum {
        double elevation = 0;
        std::size_t points = 0;
    };
    std::map<int, Sum> rings;
    cloud.each([&](const std::uint8_t *point, int ring) {
        const double flat = std::hypot(cloud.x.of(point), cloud.y.of(point)), z = cloud.z.of(point);
        if (!(flat > 0.1) || !std::isfinite(flat) || !std::isfinite(z))
            return;
        rings[ring].elevation += std::atan2(z, flat);
        ++rings[ring].points;
    });
    std::size_t most = 0;
    for (const auto &[ring, sum] : rings)
        most = std::max(most, sum.points);
    std::optional<int> found;
    double least = 0;
    for (const auto &[ring, sum] : rings) {
        const double elevation = std::abs(sum.elevation / double(sum.points));
        if (double(sum.points) < leastShare * double(most) || (found && elevation >= least))
            continue;
        found = ring;
        least = elevation;
    }
    return found;
}

void putInOrder(std::vector<CloudPoint> &points, bool isTimed, vectorlib::TimedScan &scan) {
    std::sort(points.begin(), points.end(),
              [](const CloudPoint &a, const CloudPoint &b) { return a.angle < b.angle; });
    scan.points.clear();
    scan.seconds.clear();
    for (const CloudPoint &point : points) {
        scan.points.push_back(point.point);
        if (isTimed)
            scan.seconds.push_back(point.seconds);
    }
    scan.fieldOfView = 2 * vectorlib::pi;
    scan.closed = true;
}

/// In each direction the nearest point.
void keepNearest(std::vector<CloudPoint> &points, std::size_t directions) {
    std::map<std::size_t, CloudPoint> nearest;
    for (const CloudPoint &point : points) {
        const auto at = std::size_t((point.angle + vectorlib::pi) / (2 * vectorlib::pi) * double(directions));
        const auto [known, isNew] = nearest.emplace(at, point);
        if (!isNew && point.point.norm() < known->second.point.norm())
            known->second = point;
    }
    points.clear();
    for (const auto &[at, point] : nearest)
        points.push_back(point);
}

} // namespace

std::string BagScan::read(const ros::LaserScan &message, vectorlib::TimedScan &scan) const {
    return readRays(
        message, [&](std::size_t i) { return returnOf(message, message.ranges[i]); }, scan);
}

std::string BagScan::read(const ros::MultiEchoLaserScan &message, vectorlib::TimedScan &scan) const {
    const auto first = [&](std::size_t i) {
        for (const float echo : message.ranges[i].echoes)
            if (const double range = returnOf(message, echo); std::isfinite(range))
                return range;
        return std::nan("");
    };
    return readRays(message, first, scan);
}

std::string BagScan::read(const ros::PointCloud &message, vectorlib::TimedScan &scan) {
    constexpr std::size_t directions = 1440; // of a slice
    const Cloud cloud{message};
    if (std::string fault = cloud.fault(); !fault.empty())
        return fault;
    const bool hasRings = cloud.hasRings();
    if (hasRings && !ring_)
        ring_ = options_.laser ? options_.laser : horizonRing(cloud);
    std::vector<CloudPoint> points;
    std::size_t rays = 0;
    cloud.each([&](const std::uint8_t *point, int ring) {
        if (hasRings && (!ring_ || ring != *ring_))
            return;
        ++rays;
        const double x = cloud.x.of(point), y = cloud.y.of(point), z = cloud.z.of(point);
        if (!std::isfinite(x) || !std::isfinite(y) || !(std::hypot(x, y) > 0.01) ||
            (!hasRings && !(std::abs(z - options_.height) <= slice_m)))
            return;
        points.push_back({{float(x), float(y)}, cloud.secondsOf(point), std::atan2(y, x)});
    });
    if (!hasRings)
        keepNearest(points, directions);
    if (points.size() > mostRays)
        return "found " + std::to_string(points.size()) + " points in a ring, expected at most " +
               std::to_string(mostRays);
    putInOrder(points, cloud.isTimed(), scan);
    scan.rays = hasRings ? rays : directions;
    return {};
}

void hangUpsideDown(vectorlib::TimedScan &scan) {
    scan.turnOver();
    std::reverse(scan.points.begin(), scan.points.end());
    std::reverse(scan.seconds.begin(), scan.seconds.end());
}

} // namespace hermes::vector
