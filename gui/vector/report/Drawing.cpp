#include "gui/vector/report/Drawing.h"

#include "vectorlib/io/Svg.h"

#include <algorithm>

namespace hermes::vector {

using vectorlib::Fixed;
using Point = Drawing::Point;

namespace {

constexpr double gridStep = 0.5;    // metres
constexpr double margin = 0.25;     // metres
constexpr double poseLength = 0.35; // metres, from a robot's place to the tip of its heading

struct At {
    Point p;
    friend std::ostream &operator<<(std::ostream &out, const At &at) {
        return out << Fixed{at.p.x, 3} << ',' << Fixed{at.p.y, 3};
    }
};

} // namespace

void Drawing::area(const Ink &ink, std::vector<Point> corners) {
    shapes_.push_back({ink, std::move(corners)});
}

void Drawing::segment(const Ink &ink, const vectorlib::LineSegment2D<double> &segment) {
    shapes_.push_back({ink, {segment.begin(), segment.end()}});
}

void Drawing::segments(const Ink &ink, const std::vector<vectorlib::LineSegment2D<double>> &segments) {
    for (const vectorlib::LineSegment2D<double> &s : segments)
        segment(ink, s);
}

void Drawing::path(const Ink &ink, const std::vector<Point> &points) {
    shapes_.push_back({ink, points});
}

void Drawing::dots(const Ink &ink, const std::vector<Point> &points) {
    shapes_.push_back({ink, points});
}

void Drawing::pose(const Ink &ink, const vectorlib::Pose2D &pose) {
    const Point at(pose.x, pose.y);
    shapes_.push_back({ink, {at, at + Point(std::cos(pose.theta), std::sin(pose.theta)) * poseLength}});
}

Drawing::Frame Drawing::frame(double width, double height) const {
    Frame f{{}, {}, 1};
    bool any = false;
    for (const Shape &shape : shapes_)
        for (const Point &p : shape.points) {
            f.low = any ? Point(std::min(f.low.x, p.x), std::min(f.low.y, p.y)) : p;
            f.high = any ? Point(std::max(f.high.x, p.x), std::max(f.high.y, p.y)) : p;
            any = true;
        }
    f.low -= Point(margin, margin);
    f.high += Point(margin, margin);
    f.scale = std::min(width / (f.high.x - f.low.x), height / (f.high.y - f.low.y));
    return f;
}

void Drawing::writeSvg(std::ostream &out, double x, double y, double width, double height) const {
    const Frame f = frame(width, height);
    const auto at = [&](Point p) {
        return At{{x + (p.x - f.low.x) * f.scale, y + (f.high.y - p.y) * f.scale}};
    };
    out << "<path stroke=\"#e3e7ee\" stroke-width=\"0.6\" d=\"";
    for (double gx = std::ceil(f.low.x / gridStep) * gridStep; gx <= f.high.x; gx += gridStep)
        out << 'M' << at({gx, f.low.y}) << 'L' << at({gx, f.high.y});
    for (double gy = std::ceil(f.low.y / gridStep) * gridStep; gy <= f.high.y; gy += gridStep)
        out << 'M' << at({f.low.x, gy}) << 'L' << at({f.high.x, gy});
    out << "\"/>\n";
    for (const Shape &shape : shapes_) {
        const Ink &ink = shape.ink;
        if (ink.kind == Ink::Kind::Pose)
            out << "<circle fill=\"" << ink.colour << "\" r=\"" << Fixed{2 * ink.width, 1} << "\" cx=\""
                << Fixed{at(shape.points[0]).p.x, 3} << "\" cy=\"" << Fixed{at(shape.points[0]).p.y, 3}
                << "\"/>";
        out << "<path stroke-linecap=\"round\" "
            << (ink.kind == Ink::Kind::Area ? "fill=\"" : "fill=\"none\" stroke=\"") << ink.colour
            << "\" stroke-width=\"" << Fixed{ink.width, 2} << '"'
            << (ink.dashed ? " stroke-dasharray=\"4 3\"" : "") << " d=\"";
        for (std::size_t i = 0; i < shape.points.size(); ++i)
            out << (i == 0 || ink.kind == Ink::Kind::Dots ? 'M' : 'L') << at(shape.points[i])
                << (ink.kind == Ink::Kind::Dots ? "h0" : "");
        out << "\"/>\n";
    }
}

void Drawing::writeTikz(std::ostream &out, double width, double height) const {
    const Frame f = frame(width, height);
    const auto at = [&](Point p) { return At{(p - f.low) * f.scale}; };
    out << "\\begin{tikzpicture}\n\\draw[grid, line width=0.2pt]";
    for (double gx = std::ceil(f.low.x / gridStep) * gridStep; gx <= f.high.x; gx += gridStep)
        out << " (" << at({gx, f.low.y}) << ")--(" << at({gx, f.high.y}) << ')';
    for (double gy = std::ceil(f.low.y / gridStep) * gridStep; gy <= f.high.y; gy += gridStep)
        out << " (" << at({f.low.x, gy}) << ")--(" << at({f.high.x, gy}) << ')';
    out << ";\n";
    for (const Shape &shape : shapes_) {
        const Ink &ink = shape.ink;
        if (ink.kind == Ink::Kind::Area)
            out << "\\fill[" << ink.name << ']';
        else
            out << "\\draw[" << ink.name << ", line cap=round, line width=" << Fixed{ink.width / 2, 2} << "pt"
                << (ink.dashed ? ", dashed" : "") << ']';
        for (std::size_t i = 0; i < shape.points.size(); ++i) {
            const bool starts = i == 0 || ink.kind == Ink::Kind::Dots;
            out << (starts ? " (" : "--(") << at(shape.points[i]) << ')'
                << (ink.kind == Ink::Kind::Dots ? "--+(0.001,0)" : "");
        }
        out << ";\n";
        if (ink.kind == Ink::Kind::Pose)
            out << "\\fill[" << ink.name << "] (" << at(shape.points[0]) << ") circle ("
                << Fixed{ink.width, 2} << "pt);\n";
    }
    out << "\\end{tikzpicture}";
}

void defineColours(std::ostream &out, const std::vector<const Ink *> &inks) {
    out << "\\definecolor{grid}{HTML}{E3E7EE}\n";
    for (const Ink *ink : inks) {
        std::string hex = ink->colour.substr(1);
        std::transform(hex.begin(), hex.end(), hex.begin(),
                       [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
        out << "\\definecolor{" << ink->name << "}{HTML}{" << hex << "}\n";
    }
}

void writeTikzLegend(std::ostream &out, const std::vector<const Ink *> &inks) {
    for (const Ink *ink : inks) {
        out << "\\mbox{\\tikz[baseline=-0.6ex]";
        if (ink->kind == Ink::Kind::Area)
            out << "\\fill[" << ink->name << "] (0,-0.12) rectangle (0.6,0.12);";
        else if (ink->kind == Ink::Kind::Dots)
            out << "\\fill[" << ink->name
                << "] (0,0) circle (1pt) (0.2,0) circle (1pt) (0.4,0) circle (1pt);";
        else
            out << "\\draw[" << ink->name << ", line width=" << Fixed{std::max(0.5, ink->width / 2), 2}
                << "pt" << (ink->dashed ? ", dashed" : "") << "] (0,0)--(0.6,0);";
        out << "~" << latexText(ink->label) << "}\\quad\n";
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

std::string latexText(const std::string &text) {
    std::string result;
    for (const char c : text)
        if (c == '\\')
            result += "\\textbackslash{}";
        else if (c == '^' || c == '~')
            result += std::string("\\") + c + "{}";
        else if (std::string("#$%&_{}").find(c) != std::string::npos)
            result += std::string("\\") + c;
        else if (static_cast<unsigned char>(c) < ' ')
            result += ' ';
        else
            result += c;
    return result;
}

} // namespace hermes::vector
