#pragma once

#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Pose2D.h"

#include <ostream>
#include <string>
#include <vector>

namespace hermes::vector {

/// How a kind of thing is drawn; the same in SVG and in LaTeX.
struct Ink {
    enum class Kind { Area, Lines, Dots, Pose };
    Kind kind;
    std::string name;   ///< letters only: also of the colour in LaTeX
    std::string colour; ///< #rrggbb
    double width;       ///< points; the diameter of dots
    std::string label;  ///< in the legend
    bool dashed = false;
};

/// A picture in metres over a grid of 50 cm, the y axis up, that is written as SVG and as TikZ alike.
class Drawing {
public:
    using Point = vectorlib::Vector2D<double>;

    void area(const Ink &ink, std::vector<Point> corners);
    void segment(const Ink &ink, const vectorlib::LineSegment2D<double> &segment);
    void segments(const Ink &ink, const std::vector<vectorlib::LineSegment2D<double>> &segments);
    void path(const Ink &ink, const std::vector<Point> &points);
    void dots(const Ink &ink, const std::vector<Point> &points);
    void pose(const Ink &ink, const vectorlib::Pose2D &pose);

    /// As a group with its upper left corner at (x, y), no larger than width x height; pixels.
    void writeSvg(std::ostream &out, double x, double y, double width, double height) const;
    /// As a tikzpicture no larger than width x height; centimetres. The colours are named as the inks.
    void writeTikz(std::ostream &out, double width, double height) const;

private:
    struct Shape {
        Ink ink;
        std::vector<Point> points; ///< of dots any number, of a pose its place and its tip
    };
    struct Frame {
        Point low, high; ///< metres
        double scale;    ///< units of the page a metre
    };
    Frame frame(double width, double height) const;

    std::vector<Shape> shapes_;
};

/// The colours of the inks for the preamble of a LaTeX document.
void defineColours(std::ostream &out, const std::vector<const Ink *> &inks);
/// A line or two that tell what the inks mean.
void writeTikzLegend(std::ostream &out, const std::vector<const Ink *> &inks);
void writeSvgLegend(std::ostream &out, const std::vector<const Ink *> &inks, double x, double y);

/// Text as it must be written in LaTeX.
std::string latexText(const std::string &text);

} // namespace hermes::vector
