#pragma once

#include "vectorlib/geometry/Pose2D.h"
#include "vectorlib/io/Svg.h"

#include <ostream>
#include <string>
#include <vector>

namespace hermes::experiments {

/// How a kind of thing is drawn; the same in SVG and in LaTeX.
struct Ink {
    enum class Kind { Area, Lines, Dots, Pose };
    Kind kind;
    std::string name;   ///< for programs
    std::string colour; ///< #rrggbb
    double width;       ///< points; the diameter of dots
    std::string label;  ///< in the legend
    bool dashed = false;
};

/// A picture in metres over a grid of 50 cm, the y axis up, for a part of a page.
class Drawing {
public:
    using Point = vectorlib::Vector2D<double>;
    static constexpr double gridStep = 0.5; ///< metres

    void area(const Ink &ink, const std::vector<Point> &corners);
    void segment(const Ink &ink, const vectorlib::LineSegment2D<double> &segment);
    void segments(const Ink &ink, const std::vector<vectorlib::LineSegment2D<double>> &segments);
    void path(const Ink &ink, const std::vector<Point> &points);
    void dots(const Ink &ink, const std::vector<Point> &points);
    void pose(const Ink &ink, const vectorlib::Pose2D &pose);

    /// As a group with its upper left corner at (x, y), no larger than width x height; pixels.
    void writeSvg(std::ostream &out, double x, double y, double width, double height) const;
    const vectorlib::Picture &picture() const { return picture_; }

private:
    vectorlib::Picture picture_{""};
};

/// What the inks mean, in a line.
void writeSvgLegend(std::ostream &out, const std::vector<const Ink *> &inks, double x, double y);
/// The inks as empty layers, for the legend of a LaTeX document.
std::vector<vectorlib::Picture::Layer> layersOf(const std::vector<const Ink *> &inks);

} // namespace hermes::experiments
