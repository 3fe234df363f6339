#pragma once

#include "protocol/ros/Common.h"

namespace hermes::ros {

struct CompressedImage {
    Header header;
    std::string format;
    std::vector<std::uint8_t> data;
};
constexpr auto tableOf(Of<CompressedImage>) {
    return table("sensor_msgs/msg/CompressedImage", field("header", &CompressedImage::header),
                 field("format", &CompressedImage::format), field("data", &CompressedImage::data));
}

struct UvCoordinate {
    float u = 0, v = 0;
};
constexpr auto tableOf(Of<UvCoordinate>) {
    return table("visualization_msgs/msg/UVCoordinate", field("u", &UvCoordinate::u),
                 field("v", &UvCoordinate::v));
}

struct MeshFile {
    std::string filename;
    std::vector<std::uint8_t> data;
};
constexpr auto tableOf(Of<MeshFile>) {
    return table("visualization_msgs/msg/MeshFile", field("filename", &MeshFile::filename),
                 field("data", &MeshFile::data));
}

/// Something to be drawn.
struct Marker {
    enum Type : std::int32_t { LineList = 5 };
    enum Action : std::int32_t { Add = 0, DeleteAll = 3 };

    Header header;
    std::string space; ///< of ids
    std::int32_t id = 0, type = LineList, action = Add;
    Pose pose;
    Vector3 scale; ///< of lines: x is their width
    Color color;
    Duration lifetime; ///< 0: for ever
    bool frameLocked = false;
    std::vector<Point> points; ///< of a line list: two of each line
    std::vector<Color> colors;
    std::string textureResource;
    CompressedImage texture;
    std::vector<UvCoordinate> uvCoordinates;
    std::string text, meshResource;
    MeshFile meshFile;
    bool meshUseEmbeddedMaterials = false;
};
constexpr auto tableOf(Of<Marker>) {
    using M = Marker;
    return table("visualization_msgs/msg/Marker", field("header", &M::header), field("ns", &M::space),
                 field("id", &M::id), field("type", &M::type), field("action", &M::action),
                 field("pose", &M::pose), field("scale", &M::scale), field("color", &M::color),
                 field("lifetime", &M::lifetime), field("frame_locked", &M::frameLocked),
                 field("points", &M::points), field("colors", &M::colors),
                 field("texture_resource", &M::textureResource), field("texture", &M::texture),
                 field("uv_coordinates", &M::uvCoordinates), field("text", &M::text),
                 field("mesh_resource", &M::meshResource), field("mesh_file", &M::meshFile),
                 field("mesh_use_embedded_materials", &M::meshUseEmbeddedMaterials));
}

struct MarkerArray {
    std::vector<Marker> markers;
};
constexpr auto tableOf(Of<MarkerArray>) {
    return table("visualization_msgs/msg/MarkerArray", field("markers", &MarkerArray::markers));
}

} // namespace hermes::ros
