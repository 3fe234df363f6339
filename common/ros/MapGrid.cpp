#include "common/ros/MapGrid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hermes::ros {
namespace {

constexpr std::int8_t unknownCell = -1, freeCell = 0, wallCell = 100;
constexpr double maxCells = 16e6;
constexpr int border = 10;         // cells around the map
constexpr int directions = 720;    // from each place
constexpr float lineWidth = 0.03f; // m, of markers

} // namespace

/// Cells while they are drawn. Positions are in cells, from the corner of the first one.
struct MapGrid::Drawing {
    std::int64_t width, height;
    std::vector<std::int8_t> &cells;
    std::vector<std::size_t> passed; // by the ray that is being followed

    std::size_t at(std::int64_t column, std::int64_t row) const { return std::size_t(row * width + column); }

    /// Calls see(cell) for each cell that the way from (x, y) touches, in order, until it gives false or the
    /// way leaves the grid. Source: Amanatides and Woo, A Fast Voxel Traversal Algorithm, 1987.
    template <typename See>
    void follow(double x, double y, double dx, double dy, const See &see) const {
        std::int64_t column = std::int64_t(std::floor(x)), row = std::int64_t(std::floor(y));
        const std::int64_t stepX = dx < 0 ? -1 : 1, stepY = dy < 0 ? -1 : 1;
        constexpr double never = std::numeric_limits<double>::infinity();
        const double everyX = dx == 0 ? never : std::abs(1 / dx), everyY = dy == 0 ? never : std::abs(1 / dy);
        double nextX = dx == 0 ? never : (dx < 0 ? x - double(column) : double(column) + 1 - x) * everyX;
        double nextY = dy == 0 ? never : (dy < 0 ? y - double(row) : double(row) + 1 - y) * everyY;
        while (column >= 0 && row >= 0 && column < width && row < height) {
            if (!see(at(column, row)))
                return;
            if (std::min(nextX, nextY) > 1)
                return; // the end of the way
            if (nextX < nextY) {
                column += stepX;
                nextX += everyX;
            } else {
                row += stepY;
                nextY += everyY;
            }
        }
    }

    void drawWall(double x1, double y1, double x2, double y2) {
        follow(x1, y1, x2 - x1, y2 - y1, [this](std::size_t cell) {
            cells[cell] = wallCell;
            return true;
        });
    }

    /// What lies between a place and the walls about it.
    void lookFrom(double x, double y, double reachInCells) {
        for (int i = 0; i < directions; ++i) {
            const double angle = 2 * M_PI * i / directions;
            passed.clear();
            bool ends = false;
            follow(x, y, reachInCells * std::cos(angle), reachInCells * std::sin(angle),
                   [&](std::size_t cell) {
                       ends = cells[cell] == wallCell;
                       passed.push_back(cell);
                       return !ends;
                   });
            if (!ends)
                continue; // nobody knows how far it goes
            passed.pop_back();
            for (const std::size_t cell : passed)
                cells[cell] = freeCell;
        }
    }
};

void MapGrid::clear() {
    edges_.clear();
}

void MapGrid::set(const MapEdgeMessage &edge) {
    edges_[edge.id] = edge;
}

void MapGrid::remove(qint64 id) {
    edges_.erase(id);
}

void MapGrid::draw(OccupancyGrid &grid) const {
    grid.info = {};
    grid.data.clear();
    grid.info.resolution = float(cell_);
    if (edges_.empty())
        return;
    double left = std::numeric_limits<double>::max(), bottom = left, right = -left, top = -left;
    for (const auto &[id, edge] : edges_) {
        left = std::min({left, edge.x1, edge.x2});
        right = std::max({right, edge.x1, edge.x2});
        bottom = std::min({bottom, edge.y1, edge.y2});
        top = std::max({top, edge.y1, edge.y2});
    }
    double cell = cell_;
    while ((right - left) / cell * ((top - bottom) / cell) > maxCells)
        cell *= 2;
    // The corner of the first cell lies on a multiple of cells: a map that grows keeps its cells.
    const double x0 = (std::floor(left / cell) - border) * cell,
                 y0 = (std::floor(bottom / cell) - border) * cell;
    const auto width = std::int64_t((right - x0) / cell) + 1 + border;
    const auto height = std::int64_t((top - y0) / cell) + 1 + border;
    grid.info.resolution = float(cell);
    grid.info.width = std::uint32_t(width);
    grid.info.height = std::uint32_t(height);
    grid.info.origin.position = {x0, y0, 0};
    grid.data.assign(std::size_t(width * height), unknownCell);
    Drawing drawing{width, height, grid.data, {}};
    for (const auto &[id, edge] : edges_)
        drawing.drawWall((edge.x1 - x0) / cell, (edge.y1 - y0) / cell, (edge.x2 - x0) / cell,
                         (edge.y2 - y0) / cell);
    for (const Place &place : places_)
        drawing.lookFrom((place.x - x0) / cell, (place.y - y0) / cell, reach / cell);
}

void MapGrid::draw(Marker &marker) const {
    marker.space = "walls";
    marker.type = Marker::LineList;
    marker.scale = {lineWidth, 0, 0};
    marker.color = {0.9f, 0.9f, 0.2f, 1};
    marker.points.clear();
    for (const auto &[id, edge] : edges_) {
        marker.points.push_back({edge.x1, edge.y1, 0});
        marker.points.push_back({edge.x2, edge.y2, 0});
    }
}

} // namespace hermes::ros
