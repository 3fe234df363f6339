#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/edges/EdgeRaw2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/io/Number.h"
#include "vectorlib/io/Tum.h"

#include <iosfwd>
#include <optional>
#include <string>
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
                                                double resolution = 0.05, double driven = 0.25);

    /// Writes the picture; occupied cells are black, free ones white.
    void writePgm(std::ostream &out) const {
        out << "P5\n" << width_ << ' ' << height_ << "\n255\n";
        out.write(reinterpret_cast<const char *>(cells_.data()), static_cast<std::streamsize>(cells_.size()));
    }
    /// picture: name of the PGM file as the YAML file shall refer to it, UTF-8.
    void writeYaml(std::ostream &out, const std::string &picture) const {
        out << "image: " << yamlText(picture) << "\nresolution: " << Number(resolution_) << "\norigin: ["
            << Number(origin_.x) << ", " << Number(origin_.y)
            << ", 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
    }

private:
    // Plain where that is unambiguous, else in double quotes.
    static std::string yamlText(const std::string &text);

    static constexpr unsigned char occupiedCell = 0, unknownCell = 205, freeCell = 254;
    static constexpr double margin = 1; // metres around everything drawn

    bool frame(const std::vector<MapEdge> &map, const std::vector<StampedPose> &trajectory);
    void line(Vector2D<double> a, Vector2D<double> b, double radius, unsigned char value);
    void disc(Vector2D<double> centre, double radius, unsigned char value);
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

#include VECTORLIB_BODIES("vectorlib/src/io/Pgm.cpp")
