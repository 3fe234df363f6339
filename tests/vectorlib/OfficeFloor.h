#pragma once

#include "tests/vectorlib/DrawnBuilding.h"

/// A large floor drawn at random: corridors that cross, and between them blocks of rooms of many sizes, each
/// with a door to a corridor, some furnished; metres. The same state of the generator gives the same floor.
class OfficeFloor : public DrawnBuilding {
public:
    OfficeFloor(Point size, std::mt19937 &random)
        : DrawnBuilding(random)
        , columns_(corridors(size.x))
        , rows_(corridors(size.y)) {
        const Point low(columns_.front().low, rows_.front().low),
            high(columns_.back().high, rows_.back().high);
        box(low, high);
        doors_.resize(columns_.size() * rows_.size());
        for (std::size_t i = 0; i + 1 < columns_.size(); ++i)
            for (std::size_t k = 0; k + 1 < rows_.size(); ++k)
                block(i, k);
        index(high);
    }

    /// From crossing to crossing, into a room now and then: so many poses, one about every `step` metres.
    std::vector<vectorlib::Pose2D> drive(std::size_t scans, double step) {
        std::size_t i = 0, k = 0;
        DriveWay way({columns_[0].middle(), rows_[0].middle(), 0}, step);
        for (int before = -1; way.poses().size() < scans;) {
            const int turn = any(4); // east, north, west, south
            if (turn == (before + 2) % 4 && before >= 0)
                continue;
            const std::size_t toI = i + std::size_t(turn == 0) - std::size_t(turn == 2);
            const std::size_t toK = k + std::size_t(turn == 1) - std::size_t(turn == 3);
            if (toI >= columns_.size() || toK >= rows_.size())
                continue;
            if (turn % 2 == 0)
                visitRooms(way, std::min(i, toI), k, turn == 0);
            way.goTo({columns_[toI].middle(), rows_[toK].middle()});
            i = toI;
            k = toK;
            before = turn;
        }
        return {way.poses().begin(), way.poses().begin() + std::ptrdiff_t(scans)};
    }
    /// Around by the outermost corridors, counter-clockwise, and along the first of them again.
    std::vector<vectorlib::Pose2D> around(double step) const {
        const Point low(columns_.front().middle(), rows_.front().middle());
        const Point high(columns_.back().middle(), rows_.back().middle());
        DriveWay way({low.x, low.y, 0}, step);
        for (const Point &corner :
             {Point(high.x, low.y), high, Point(low.x, high.y), low, Point(high.x, low.y)})
            way.goTo(corner);
        return way.poses();
    }
    /// As ScanWorld sees: the rays from right to left; what is out of reach has no point.
    ScanWorld::Points scan(const vectorlib::Transformation2D &pose, const ScanWorld::Scanner &scanner) {
        return ScanWorld::see(pose, random_, scanner,
                              [&](Point from, Point ray) { return range(from, ray, scanner.reach); });
    }

private:
    struct Corridor {
        double low, high;
        double middle() const { return (low + high) / 2; }
    };

    std::vector<Corridor> corridors(double length) {
        std::vector<Corridor> result;
        for (double at = 0; at < length; at += between(14, 24)) {
            const double width = between(1.8, 3);
            result.push_back({at, at + width});
            at += width;
        }
        return result;
    }
    // Two rows of rooms back to back, with doors to the corridors below and above.
    void block(std::size_t i, std::size_t k) {
        const double x0 = columns_[i].high, x1 = columns_[i + 1].low;
        const double y0 = rows_[k].high, y1 = rows_[k + 1].low, back = y0 + (y1 - y0) * between(0.4, 0.6);
        wall({x0, y0}, {x0, y1});
        wall({x1, y0}, {x1, y1});
        wall({x0, back}, {x1, back});
        rooms({x0, y0}, x1, back, rows_[k].middle(), doors_[k * columns_.size() + i]);
        rooms({x0, y1}, x1, back, rows_[k + 1].middle(), doors_[(k + 1) * columns_.size() + i]);
    }
    void rooms(Point corner, double end, double back, double corridor, std::vector<Door> &doors) {
        constexpr double gap = 1, least = 2.6;
        for (double x = corner.x; x < end;) {
            double next = x + between(least, 7);
            if (end - next < least)
                next = end;
            const double door = between(x + 0.3, next - gap - 0.3);
            wall({x, corner.y}, {door, corner.y});
            wall({door + gap, corner.y}, {next, corner.y});
            if (next < end)
                wall({next, corner.y}, {next, back});
            const double deep = corner.y + (back - corner.y) * 0.4;
            doors.push_back({{door + gap / 2, corridor}, {door + gap / 2, deep}});
            for (int boxes = any(3); boxes > 0; --boxes)
                furnish({between(x + 0.1, next - 1.3), corner.y + (back - corner.y) * between(0.6, 0.8)});
            x = next;
        }
    }
    void furnish(Point low) {
        const double width = between(0.4, 1.2), depth = between(0.4, 0.9);
        box(low, low + Point(width, depth));
    }
    void visitRooms(DriveWay &way, std::size_t column, std::size_t row, bool eastward) {
        std::vector<Door> doors = doors_[row * columns_.size() + column];
        std::sort(doors.begin(), doors.end(), [eastward](const Door &a, const Door &b) {
            return eastward ? a.before.x < b.before.x : b.before.x < a.before.x;
        });
        for (const Door &door : doors)
            if (any(12) == 0)
                visit(door, way);
    }

    // Walls by cells, so that a ray asks only those on its way.
    void index(Point high) {
        width_ = int(high.x / cell_m) + 1;
        height_ = int(high.y / cell_m) + 1;
        cells_.resize(std::size_t(width_) * std::size_t(height_));
        for (std::size_t n = 0; n < world.walls.size(); ++n) {
            const Point a = world.walls[n].begin(), b = world.walls[n].end();
            for (int y = cellOf(std::min(a.y, b.y) - edge_m, height_);
                 y <= cellOf(std::max(a.y, b.y) + edge_m, height_); ++y)
                for (int x = cellOf(std::min(a.x, b.x) - edge_m, width_);
                     x <= cellOf(std::max(a.x, b.x) + edge_m, width_); ++x)
                    cells_[std::size_t(y * width_ + x)].push_back(n);
        }
    }
    static int cellOf(double v, int count) { return std::clamp(int(v / cell_m), 0, count - 1); }
    double range(Point from, Point ray, double reach) const {
        int x = cellOf(from.x, width_), y = cellOf(from.y, height_);
        const int stepX = ray.x > 0 ? 1 : -1, stepY = ray.y > 0 ? 1 : -1;
        double nearest = reach;
        for (;;) {
            for (const std::size_t n : cells_[std::size_t(y * width_ + x)])
                nearest = std::min(nearest, ScanWorld::rangeOf(world.walls[n], from, ray));
            const double nextX = (cell_m * (x + (stepX > 0)) - from.x) / ray.x;
            const double nextY = (cell_m * (y + (stepY > 0)) - from.y) / ray.y;
            if (std::min(nextX, nextY) >= nearest)
                return nearest;
            (nextX < nextY ? x : y) += nextX < nextY ? stepX : stepY;
            if (x < 0 || y < 0 || x >= width_ || y >= height_)
                return nearest;
        }
    }

    static constexpr double cell_m = 1, edge_m = 1e-6;
    std::vector<Corridor> columns_, rows_;
    std::vector<std::vector<Door>> doors_;        // of each corridor between two crossings along x
    std::vector<std::vector<std::size_t>> cells_; // numbers of walls
    int width_ = 0, height_ = 0;
};
