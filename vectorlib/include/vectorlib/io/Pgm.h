#pragma once

#include "vectorlib/edges/MapEdge.h"
#include "vectorlib/io/InputError.h"
#include "vectorlib/io/Number.h"
#include "vectorlib/io/Tum.h"

#include <algorithm>
#include <optional>
#include <vector>

namespace vectorlib {

/// A map as the cells that ROS map_server loads: a PGM picture and a YAML file beside it. Cells under a
/// segment are occupied, cells where the robot drove are free, all others are unknown: nothing is guessed.
class OccupancyPicture {
public:
    static constexpr std::size_t maxCells = 100'000'000;

    /// Draws the map; nothing when it would have over maxCells cells. resolution: metres a cell; driven:
    /// metres to either side of the trajectory that count as free.
    static std::optional<OccupancyPicture> draw(const std::vector<MapEdge> &map,
                                                const std::vector<StampedPose> &trajectory,
                                                double resolution = 0.05, double driven = 0.25) {
        OccupancyPicture p;
        p.resolution_ = resolution;
        if (!p.frame(map, trajectory))
            return std::nullopt;
        for (std::size_t i = 0; i + 1 < trajectory.size(); ++i)
            if (!trajectory[i + 1].isApart)
                p.line({trajectory[i].pose.x, trajectory[i].pose.y},
                       {trajectory[i + 1].pose.x, trajectory[i + 1].pose.y}, driven, freeCell);
        for (const MapEdge &m : map)
            p.line(m.segment.begin(), m.segment.end(), 0, occupiedCell);
        return p;
    }

    /// Writes the picture; occupied cells are black, free ones white.
    void writePgm(std::ostream &out) const {
        out << "P5\n" << width_ << ' ' << height_ << "\n255\n";
        out.write(reinterpret_cast<const char *>(cells_.data()), static_cast<std::streamsize>(cells_.size()));
    }
    /// picture: name of the PGM file as the YAML file shall refer to it.
    void writeYaml(std::ostream &out, const std::string &picture) const {
        out << "image: " << picture << "\nresolution: " << Number(resolution_) << "\norigin: ["
            << Number(origin_.x) << ", " << Number(origin_.y)
            << ", 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
    }

private:
    static constexpr unsigned char occupiedCell = 0, unknownCell = 205, freeCell = 254;
    static constexpr double margin = 1; // metres around everything drawn

    bool frame(const std::vector<MapEdge> &map, const std::vector<StampedPose> &trajectory) {
        Vector2D<double> low, high;
        bool any = false;
        const auto include = [&](Vector2D<double> p) {
            low = any ? Vector2D<double>(std::min(low.x, p.x), std::min(low.y, p.y)) : p;
            high = any ? Vector2D<double>(std::max(high.x, p.x), std::max(high.y, p.y)) : p;
            any = true;
        };
        for (const MapEdge &m : map) {
            include(m.segment.begin());
            include(m.segment.end());
        }
        for (const StampedPose &s : trajectory)
            include({s.pose.x, s.pose.y});
        origin_ = low - Vector2D<double>(margin, margin);
        const double width = std::ceil((high.x - low.x + 2 * margin) / resolution_);
        const double height = std::ceil((high.y - low.y + 2 * margin) / resolution_);
        if (!(width * height <= static_cast<double>(maxCells)))
            return false;
        width_ = static_cast<std::size_t>(width);
        height_ = static_cast<std::size_t>(height);
        cells_.assign(width_ * height_, unknownCell);
        return true;
    }
    void line(Vector2D<double> a, Vector2D<double> b, double radius, unsigned char value) {
        const double length = (b - a).norm();
        const auto steps = static_cast<std::size_t>(std::ceil(length / resolution_ * 2)) + 1;
        for (std::size_t i = 0; i <= steps; ++i)
            disc(a + (b - a) * (static_cast<double>(i) / static_cast<double>(steps)), radius, value);
    }
    void disc(Vector2D<double> centre, double radius, unsigned char value) {
        const int reach = static_cast<int>(std::floor(radius / resolution_));
        const int column = static_cast<int>((centre.x - origin_.x) / resolution_);
        const int row = static_cast<int>((centre.y - origin_.y) / resolution_);
        for (int dy = -reach; dy <= reach; ++dy)
            for (int dx = -reach; dx <= reach; ++dx)
                if (dx * dx + dy * dy <= reach * reach)
                    set(column + dx, row + dy, value);
    }
    // The picture's first row is the map's highest.
    void set(int column, int row, unsigned char value) {
        if (column < 0 || row < 0 || column >= static_cast<int>(width_) || row >= static_cast<int>(height_))
            return;
        cells_[(height_ - 1 - static_cast<std::size_t>(row)) * width_ + static_cast<std::size_t>(column)] =
            value;
    }

    double resolution_ = 0.05;
    Vector2D<double> origin_; ///< lower left corner
    std::size_t width_ = 0;
    std::size_t height_ = 0;
    std::vector<unsigned char> cells_;
};

} // namespace vectorlib
