#include "vectorlib/experiments/report/Drawing.h"

#include "vectorlib/io/Svg.h"

#include <algorithm>

namespace hermes::experiments {

using vectorlib::Fixed;
using vectorlib::Picture;
using Point = Drawing::Point;
using Kind = Picture::Kind;

namespace {

constexpr int maxLines = 200;       // of the grid, each way
constexpr double poseLength = 0.35; // metres, from a robot's place to the tip of its heading

struct At {
    Point p;
    friend std::ostream &operator<<(std::ostream &out, const At &at) {
        return out << Fixed{at.p.x, 3} << ',' << Fixed{at.p.y, 3};
    }
};

Picture::Style styleOf(const Ink &ink, const std::string &label = "") {
    return {ink.colour, ink.width, label, ink.dashed};
}

} // namespace

void Drawing::area(const Ink &ink, const std::vector<Point> &corners) {
    picture_.area(styleOf(ink), corners);
}

void Drawing::segment(const Ink &ink, const vectorlib::LineSegment2D<double> &segment) {
    segments(ink, {segment});
}

void Drawing::segments(const Ink &ink, const std::vector<vectorlib::LineSegment2D<double>> &segments) {
    picture_.segments(styleOf(ink), segments);
}

void Drawing::path(const Ink &ink, const std::vector<Point> &points) {
    picture_.path(styleOf(ink), points);
}

void Drawing::dots(const Ink &ink, const std::vector<Point> &points) {
    picture_.points(styleOf(ink), points);
}

void Drawing::pose(const Ink &ink, const vectorlib::Pose2D &pose) {
    picture_.pose(styleOf(ink), {pose.x, pose.y}, pose.theta);
}

void Drawing::writeSvg(std::ostream &out, double x, double y, double width, double height) const {
    const Picture::Box box = picture_.box();
    const double scale = std::min(width / box.size().x, height / box.size().y);
    const auto at = [&](Point p) {
        return At{{x + (p.x - box.low.x) * scale, y + (box.high.y - p.y) * scale}};
    };
    out << "<path stroke=\"#e3e7ee\" stroke-width=\"0.6\" d=\"";
    for (const double gx : Picture::gridLines(box.low.x, box.high.x, gridStep, maxLines))
        out << 'M' << at({gx, box.low.y}) << 'L' << at({gx, box.high.y});
    for (const double gy : Picture::gridLines(box.low.y, box.high.y, gridStep, maxLines))
        out << 'M' << at({box.low.x, gy}) << 'L' << at({box.high.x, gy});
    out << "\"/>\n";
    for (const Picture::Layer &layer : picture_.layers()) {
        std::vector<Point> vertices = layer.vertices;
        if (vertices.empty())
            continue;
        if (layer.kind == Kind::Pose) {
            const Point place = at(vertices[0]).p;
            vertices.push_back(vertices[0] +
                               Point(std::cos(layer.heading), std::sin(layer.heading)) * poseLength);
            out << "<circle fill=\"" << layer.style.colour << "\" r=\"" << Fixed{2 * layer.style.width, 1}
                << "\" cx=\"" << Fixed{place.x, 3} << "\" cy=\"" << Fixed{place.y, 3} << "\"/>";
        }
        out << "<path stroke-linecap=\"round\" "
            << (layer.kind == Kind::Area ? "fill=\"" : "fill=\"none\" stroke=\"") << layer.style.colour
            << "\" stroke-width=\"" << Fixed{layer.style.width, 2} << '"'
            << (layer.style.dashed ? " stroke-dasharray=\"4 3\"" : "") << " d=\"";
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const bool starts =
                i == 0 || layer.kind == Kind::Points || (layer.kind == Kind::Segments && i % 2 == 0);
            out << (starts ? 'M' : 'L') << at(vertices[i]) << (layer.kind == Kind::Points ? "h0" : "");
        }
        out << "\"/>\n";
    }
}

void writeSvgLegend(std::ostream &out, const std::vector<const Ink *> &inks, double x, double y) {
    for (const Ink *ink : inks) {
        if (ink->kind == Ink::Kind::Area)
            out << "<rect fill=\"" << ink->colour << "\" width=\"26\" height=\"10\" x=\"" << Fixed{x, 1}
                << "\" y=\"" << Fixed{y - 9, 1} << "\"/>";
        else
            out << "<path fill=\"none\" stroke-linecap=\"round\" stroke=\"" << ink->colour
                << "\" stroke-width=\"" << Fixed{std::max(2.0, ink->width), 1} << '"'
                << (ink->dashed ? " stroke-dasharray=\"4 3\"" : "") << " d=\"M" << Fixed{x, 1} << ' '
                << Fixed{y - 4, 1} << (ink->kind == Ink::Kind::Dots ? "h0m8 0h0m8 0h0m8 0h0" : "h26")
                << "\"/>";
        out << "<text x=\"" << Fixed{x + 34, 1} << "\" y=\"" << Fixed{y, 1} << "\">"
            << vectorlib::xmlText(ink->label) << "</text>\n";
        x += 60 + 6.2 * static_cast<double>(ink->label.size());
    }
}

std::vector<Picture::Layer> layersOf(const std::vector<const Ink *> &inks) {
    std::vector<Picture::Layer> layers;
    for (const Ink *ink : inks) {
        const Kind kind = ink->kind == Ink::Kind::Area   ? Kind::Area
                          : ink->kind == Ink::Kind::Dots ? Kind::Points
                          : ink->kind == Ink::Kind::Pose ? Kind::Pose
                                                         : Kind::Segments;
        layers.push_back({kind, styleOf(*ink, ink->label), {}, 0});
    }
    return layers;
}

} // namespace hermes::experiments
