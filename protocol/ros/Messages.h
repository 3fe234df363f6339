#pragma once

#include "protocol/ros/Common.h"

#include <limits>

namespace hermes::ros {

struct TfMessage {
    std::vector<TransformStamped> transforms;
};
constexpr auto tableOf(Of<TfMessage>) {
    return table("tf2_msgs/msg/TFMessage", field("transforms", &TfMessage::transforms));
}

struct Path {
    Header header;
    std::vector<PoseStamped> poses;
};
constexpr auto tableOf(Of<Path>) {
    return table("nav_msgs/msg/Path", field("header", &Path::header), field("poses", &Path::poses));
}

/// A ray's angle is angleMin + i * angleIncrement, its time that of the header + i * timeIncrement.
struct LaserScan {
    Header header; ///< stamp: of the first ray
    float angleMin = 0, angleMax = 0, angleIncrement = 0;
    float timeIncrement = 0, scanTime = 0; ///< s
    float rangeMin = 0, rangeMax = 0;
    std::vector<float> ranges; ///< outside rangeMin to rangeMax: no return
    std::vector<float> intensities;
};
constexpr auto tableOf(Of<LaserScan>) {
    return table("sensor_msgs/msg/LaserScan", field("header", &LaserScan::header),
                 field("angle_min", &LaserScan::angleMin), field("angle_max", &LaserScan::angleMax),
                 field("angle_increment", &LaserScan::angleIncrement),
                 field("time_increment", &LaserScan::timeIncrement), field("scan_time", &LaserScan::scanTime),
                 field("range_min", &LaserScan::rangeMin), field("range_max", &LaserScan::rangeMax),
                 field("ranges", &LaserScan::ranges), field("intensities", &LaserScan::intensities));
}

struct LaserEcho {
    std::vector<float> echoes; ///< the nearest one first
};
constexpr auto tableOf(Of<LaserEcho>) {
    return table("sensor_msgs/msg/LaserEcho", field("echoes", &LaserEcho::echoes));
}

/// As a LaserScan, with several returns of a ray.
struct MultiEchoLaserScan {
    Header header;
    float angleMin = 0, angleMax = 0, angleIncrement = 0;
    float timeIncrement = 0, scanTime = 0;
    float rangeMin = 0, rangeMax = 0;
    std::vector<LaserEcho> ranges, intensities;
};
constexpr auto tableOf(Of<MultiEchoLaserScan>) {
    using M = MultiEchoLaserScan;
    return table("sensor_msgs/msg/MultiEchoLaserScan", field("header", &M::header),
                 field("angle_min", &M::angleMin), field("angle_max", &M::angleMax),
                 field("angle_increment", &M::angleIncrement), field("time_increment", &M::timeIncrement),
                 field("scan_time", &M::scanTime), field("range_min", &M::rangeMin),
                 field("range_max", &M::rangeMax), field("ranges", &M::ranges),
                 field("intensities", &M::intensities));
}

struct PointField {
    enum Type : std::uint8_t { Int8 = 1, UInt8, Int16, UInt16, Int32, UInt32, Float32, Float64 };

    std::string name;
    std::uint32_t offset = 0; ///< in bytes, of a point
    std::uint8_t datatype = Float32;
    std::uint32_t count = 1;
};
constexpr auto tableOf(Of<PointField>) {
    return table("sensor_msgs/msg/PointField", field("name", &PointField::name),
                 field("offset", &PointField::offset), field("datatype", &PointField::datatype),
                 field("count", &PointField::count));
}

struct PointCloud {
    Header header;
    std::uint32_t height = 1, width = 0;
    std::vector<PointField> fields;
    bool isBigEndian = false;
    std::uint32_t pointStep = 0, rowStep = 0; ///< bytes
    std::vector<std::uint8_t> data;
    bool isDense = true; ///< no point is invalid
};
constexpr auto tableOf(Of<PointCloud>) {
    return table("sensor_msgs/msg/PointCloud2", field("header", &PointCloud::header),
                 field("height", &PointCloud::height), field("width", &PointCloud::width),
                 field("fields", &PointCloud::fields), field("is_bigendian", &PointCloud::isBigEndian),
                 field("point_step", &PointCloud::pointStep), field("row_step", &PointCloud::rowStep),
                 field("data", &PointCloud::data), field("is_dense", &PointCloud::isDense));
}

struct Odometry {
    Header header;
    std::string childFrameId;
    PoseWithCovariance pose;
    TwistWithCovariance twist; ///< in the child's frame
};
constexpr auto tableOf(Of<Odometry>) {
    return table("nav_msgs/msg/Odometry", field("header", &Odometry::header),
                 field("child_frame_id", &Odometry::childFrameId), field("pose", &Odometry::pose),
                 field("twist", &Odometry::twist));
}

struct MapMetaData {
    Time mapLoadTime;
    float resolution = 0; ///< m of a cell
    std::uint32_t width = 0, height = 0;
    Pose origin; ///< of the outer corner of the first cell
};
constexpr auto tableOf(Of<MapMetaData>) {
    return table("nav_msgs/msg/MapMetaData", field("map_load_time", &MapMetaData::mapLoadTime),
                 field("resolution", &MapMetaData::resolution), field("width", &MapMetaData::width),
                 field("height", &MapMetaData::height), field("origin", &MapMetaData::origin));
}

/// Cells row by row from the lower left: -1 unknown, 0 free, 100 occupied.
struct OccupancyGrid {
    Header header;
    MapMetaData info;
    std::vector<std::int8_t> data;
};
constexpr auto tableOf(Of<OccupancyGrid>) {
    return table("nav_msgs/msg/OccupancyGrid", field("header", &OccupancyGrid::header),
                 field("info", &OccupancyGrid::info), field("data", &OccupancyGrid::data));
}

/// What is not known is NaN.
struct BatteryState {
    static constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

    Header header;
    float voltage = unknown, temperature = unknown;
    float current = unknown; ///< A; negative: it is discharged
    float charge = unknown, capacity = unknown, designCapacity = unknown;
    float percentage = unknown; ///< from 0 to 1
    std::uint8_t status = 0, health = 0, technology = 0;
    bool present = true;
    std::vector<float> cellVoltage, cellTemperature;
    std::string location, serialNumber;
};
constexpr auto tableOf(Of<BatteryState>) {
    using M = BatteryState;
    return table("sensor_msgs/msg/BatteryState", field("header", &M::header), field("voltage", &M::voltage),
                 field("temperature", &M::temperature), field("current", &M::current),
                 field("charge", &M::charge), field("capacity", &M::capacity),
                 field("design_capacity", &M::designCapacity), field("percentage", &M::percentage),
                 field("power_supply_status", &M::status), field("power_supply_health", &M::health),
                 field("power_supply_technology", &M::technology), field("present", &M::present),
                 field("cell_voltage", &M::cellVoltage), field("cell_temperature", &M::cellTemperature),
                 field("location", &M::location), field("serial_number", &M::serialNumber));
}

struct NavSatStatus {
    std::int8_t status = -1; ///< -1: no fix; 0: one; 1: with corrections from satellites; 2: from the ground
    std::uint16_t service = 1; ///< GPS
};
constexpr auto tableOf(Of<NavSatStatus>) {
    return table("sensor_msgs/msg/NavSatStatus", field("status", &NavSatStatus::status),
                 field("service", &NavSatStatus::service));
}

struct NavSatFix {
    Header header;
    NavSatStatus status;
    double latitude = 0, longitude = 0; ///< degrees, WGS84
    double altitude = 0;                ///< m above the ellipsoid; NaN: not known
    std::array<double, 9> positionCovariance{};
    std::uint8_t positionCovarianceType = 0; ///< 0: unknown; 1: a guess; 2: the diagonal; 3: all of it
};
constexpr auto tableOf(Of<NavSatFix>) {
    return table("sensor_msgs/msg/NavSatFix", field("header", &NavSatFix::header),
                 field("status", &NavSatFix::status), field("latitude", &NavSatFix::latitude),
                 field("longitude", &NavSatFix::longitude), field("altitude", &NavSatFix::altitude),
                 field("position_covariance", &NavSatFix::positionCovariance),
                 field("position_covariance_type", &NavSatFix::positionCovarianceType));
}

struct JointState {
    Header header;
    std::vector<std::string> name;
    std::vector<double> position, velocity, effort; ///< rad, rad/s, N m
};
constexpr auto tableOf(Of<JointState>) {
    return table("sensor_msgs/msg/JointState", field("header", &JointState::header),
                 field("name", &JointState::name), field("position", &JointState::position),
                 field("velocity", &JointState::velocity), field("effort", &JointState::effort));
}

struct KeyValue {
    std::string key, value;
};
constexpr auto tableOf(Of<KeyValue>) {
    return table("diagnostic_msgs/msg/KeyValue", field("key", &KeyValue::key),
                 field("value", &KeyValue::value));
}

struct DiagnosticStatus {
    enum Level : std::uint8_t { Ok, Warn, Error, Stale };

    Octet level{};
    std::string name, message, hardwareId;
    std::vector<KeyValue> values;
};
constexpr auto tableOf(Of<DiagnosticStatus>) {
    return table("diagnostic_msgs/msg/DiagnosticStatus", field("level", &DiagnosticStatus::level),
                 field("name", &DiagnosticStatus::name), field("message", &DiagnosticStatus::message),
                 field("hardware_id", &DiagnosticStatus::hardwareId),
                 field("values", &DiagnosticStatus::values));
}

struct DiagnosticArray {
    Header header;
    std::vector<DiagnosticStatus> status;
};
constexpr auto tableOf(Of<DiagnosticArray>) {
    return table("diagnostic_msgs/msg/DiagnosticArray", field("header", &DiagnosticArray::header),
                 field("status", &DiagnosticArray::status));
}

struct Log {
    enum Level : std::uint8_t { Debug = 10, Info = 20, Warn = 30, Error = 40, Fatal = 50 };

    Time stamp;
    std::uint8_t level = Info;
    std::string name, message, file, function;
    std::uint32_t line = 0;
};
constexpr auto tableOf(Of<Log>) {
    return table("rcl_interfaces/msg/Log", field("stamp", &Log::stamp), field("level", &Log::level),
                 field("name", &Log::name), field("msg", &Log::message), field("file", &Log::file),
                 field("function", &Log::function), field("line", &Log::line));
}

struct Clock {
    Time clock;
};
constexpr auto tableOf(Of<Clock>) {
    return table("rosgraph_msgs/msg/Clock", field("clock", &Clock::clock));
}

} // namespace hermes::ros
