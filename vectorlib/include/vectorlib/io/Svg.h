#pragma once

#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/io/Number.h"

#include <string>
#include <vector>

namespace vectorlib {

/// Colours with a meaning, the same in every picture; they stay apart for the colour-blind.
namespace colour {
constexpr const char *map = "#1b2a41";      // what is known: segments of a map, of a world, of the static set
constexpr const char *points = "#8d99ae";   // what was measured
constexpr const char *outliers = "#d62828"; // what was left out
constexpr const char *estimate = "#0072b2"; // what was computed: trajectories, registered segments
constexpr const char *reference = "#e69f00"; // what it is compared with
constexpr const char *before = "#cc79a7";    // where the dynamic set was

/// For parts that need only be told from their neighbours, such as clusters.
inline const char *distinct(std::size_t i) {
    constexpr const char *cycle[] = {"#0072b2", "#e69f00", "#009e73", "#cc79a7",
                                     "#56b4e9", "#a0522d", "#7b5ea7", "#5f7a00"};
    return cycle[i % 8];
}
} // namespace colour

/// Text as it must be written between the tags of XML.
inline std::string xmlText(const std::string &text) {
    std::string result;
    for (const char c : text)
        if (c == '&')
            result += "&amp;";
        else if (c == '<')
            result += "&lt;";
        else if (c == '>')
            result += "&gt;";
        else
            result += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
    return result;
}

/// A picture of things in the plane: layers over a grid in metres, with scale bar and legend. The y axis
/// points up. Things that are not finite are left out.
class SvgPicture {
public:
    using Point = Vector2D<double>;

    struct Style {
        std::string colour;
        double width = 1.5; ///< pixels; diameter of points
        std::string label;  ///< in the legend; none when empty
        bool dashed = false;
    };

    explicit SvgPicture(std::string title)
        : title_(std::move(title)) {}

    template <typename Scalar>
    void points(Style style, const std::vector<Vector2D<Scalar>> &points) {
        Layer &layer = add(Kind::Points, std::move(style));
        for (const auto &p : points)
            take(layer, Point(p));
    }
    template <typename Scalar>
    void segments(Style style, const std::vector<LineSegment2D<Scalar>> &segments) {
        Layer &layer = add(Kind::Segments, std::move(style));
        for (const auto &s : segments)
            if (s.isFinite()) {
                take(layer, Point(s.begin()));
                take(layer, Point(s.end()));
            }
    }
    void path(Style style, const std::vector<Point> &path) {
        Layer &layer = add(Kind::Path, std::move(style));
        for (const Point &p : path)
            take(layer, p);
    }
    /// A sensor or robot: a circle with a tick in its heading.
    void pose(Style style, Point at, double heading) {
        Layer &layer = add(Kind::Pose, std::move(style));
        take(layer, at);
        layer.heading = heading;
    }

    void write(std::ostream &out) {
        layOut();
        out << R"(<svg xmlns="http://www.w3.org/2000/svg" width=")" << Fixed{width_, 0} << R"(" height=")"
            << Fixed{height_, 0} << R"(" viewBox="0 0 )" << Fixed{width_, 0} << ' ' << Fixed{height_, 0}
            << R"(" font-family="sans-serif" font-size="13" fill="#333">)"
            << "\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
        writeGrid(out);
        for (const Layer &layer : layers_)
            writeLayer(out, layer);
        writeScaleBar(out);
        writeLegend(out);
        out << "</svg>\n";
    }

private:
    enum class Kind { Points, Segments, Path, Pose };
    struct Layer {
        Kind kind;
        Style style;
        std::vector<Point> vertices;
        double heading = 0;
    };
    static constexpr double left = 56, right = 24, bottom = 62, rowHeight = 20, mostWide = 1200,
                            mostHigh = 1200;
    static constexpr int mostLines = 10; ///< of the grid, and one more

    Layer &add(Kind kind, Style style) {
        layers_.push_back({kind, std::move(style), {}, 0});
        return layers_.back();
    }
    void take(Layer &layer, Point p) {
        if (!p.isFinite())
            return;
        layer.vertices.push_back(p);
        low_ = any_ ? Point(std::min(low_.x, p.x), std::min(low_.y, p.y)) : p;
        high_ = any_ ? Point(std::max(high_.x, p.x), std::max(high_.y, p.y)) : p;
        any_ = true;
    }

    void layOut() {
        Point size = high_ - low_;
        const double margin = std::max(0.03 * std::max(size.x, size.y), 0.2);
        size += Point(2 * margin, 2 * margin);
        origin_ = low_ - Point(margin, margin);
        scale_ = std::min(mostWide / size.x, mostHigh / size.y);
        plot_ = size * scale_;
        width_ = std::max(left + plot_.x + right, 480.0);
        top_ = 34 + rowHeight * static_cast<double>(legendRows());
        height_ = top_ + plot_.y + bottom;
        step_ = niceStep(std::max(size.x, size.y) / mostLines);
    }
    /// 1, 2 or 5 times a power of ten, at least `wanted`.
    static double niceStep(double wanted) {
        const double power = std::pow(10, std::floor(std::log10(wanted)));
        for (const double factor : {1.0, 2.0, 5.0})
            if (factor * power >= wanted)
                return factor * power;
        return 10 * power;
    }
    Point toPixel(Point p) const {
        return {left + (p.x - origin_.x) * scale_, top_ + plot_.y - (p.y - origin_.y) * scale_};
    }
    static void writePoint(std::ostream &out, Point p) { out << Fixed{p.x, 1} << ' ' << Fixed{p.y, 1}; }

    void writeGrid(std::ostream &out) const {
        const double low = top_ + plot_.y, high = top_;
        const int decimals = step_ < 0.1 ? 2 : step_ < 1 ? 1 : 0;
        out << "<g stroke=\"#e3e7ee\" stroke-width=\"1\" font-size=\"11\" fill=\"#6b7280\">\n";
        // Counted: far from the origin a step more may be the same number.
        for (int i = 0; i <= mostLines; ++i) {
            const double x = (std::ceil(origin_.x / step_) + i) * step_;
            if (x > origin_.x + plot_.x / scale_)
                break;
            const double at = toPixel({x, 0}).x;
            out << "<path d=\"M" << Fixed{at, 1} << ' ' << Fixed{low, 1} << 'V' << Fixed{high, 1}
                << "\"/><text x=\"" << Fixed{at, 1} << "\" y=\"" << Fixed{low + 16, 1}
                << "\" stroke=\"none\" text-anchor=\"middle\">" << Fixed{rounded(x), decimals} << "</text>\n";
        }
        for (int i = 0; i <= mostLines; ++i) {
            const double y = (std::ceil(origin_.y / step_) + i) * step_;
            if (y > origin_.y + plot_.y / scale_)
                break;
            const double at = toPixel({0, y}).y;
            out << "<path d=\"M" << Fixed{left, 1} << ' ' << Fixed{at, 1} << 'H' << Fixed{left + plot_.x, 1}
                << "\"/><text x=\"" << Fixed{left - 6, 1} << "\" y=\"" << Fixed{at + 4, 1}
                << "\" stroke=\"none\" text-anchor=\"end\">" << Fixed{rounded(y), decimals} << "</text>\n";
        }
        out << "</g>\n";
    }
    double rounded(double v) const { return std::abs(v) < step_ / 2 ? 0 : v; }

    void writeLayer(std::ostream &out, const Layer &layer) const {
        if (layer.vertices.empty())
            return;
        if (layer.kind == Kind::Pose) {
            const Point at = toPixel(layer.vertices.front());
            writePoseMark(out, at, layer.heading, layer.style);
            return;
        }
        out << "<path fill=\"none\" stroke-linecap=\"round\" stroke-linejoin=\"round\" stroke=\""
            << layer.style.colour << "\" stroke-width=\"" << Fixed{layer.style.width, 1} << '"'
            << (layer.style.dashed ? " stroke-dasharray=\"6 4\"" : "") << " d=\"";
        for (std::size_t i = 0; i < layer.vertices.size(); ++i) {
            const bool starts =
                layer.kind == Kind::Points || (layer.kind == Kind::Segments ? i % 2 == 0 : i == 0);
            out << (starts ? 'M' : 'L');
            writePoint(out, toPixel(layer.vertices[i]));
            if (layer.kind == Kind::Points)
                out << "h0";
        }
        out << "\"/>\n";
    }
    static void writePoseMark(std::ostream &out, Point at, double heading, const Style &style) {
        const Point tip = at + Point(std::cos(heading), -std::sin(heading)) * 14;
        out << "<circle cx=\"" << Fixed{at.x, 1} << "\" cy=\"" << Fixed{at.y, 1} << "\" r=\"5\" fill=\""
            << style.colour << "\"/><path stroke=\"" << style.colour << "\" stroke-width=\"2.5\" d=\"M";
        writePoint(out, at);
        out << 'L';
        writePoint(out, tip);
        out << "\"/>\n";
    }

    void writeScaleBar(std::ostream &out) const {
        const double y = height_ - 20, x = left, length = step_ * scale_;
        out << "<path stroke=\"#333\" stroke-width=\"2\" fill=\"none\" d=\"M" << Fixed{x, 1} << ' '
            << Fixed{y - 5, 1} << "v10m0 -5h" << Fixed{length, 1} << "m0 -5v10\"/><text x=\""
            << Fixed{x + length + 8, 1} << "\" y=\"" << Fixed{y + 4, 1} << "\">" << Number(step_)
            << " m</text>\n";
    }
    std::size_t legendRows() const {
        std::size_t rows = 0;
        for (const Layer &layer : layers_)
            rows += !layer.style.label.empty();
        return rows;
    }
    void writeLegend(std::ostream &out) const {
        out << "<text x=\"" << left << "\" y=\"22\" font-size=\"15\" font-weight=\"bold\">" << xmlText(title_)
            << "</text>\n";
        double y = 40;
        for (const Layer &layer : layers_) {
            if (layer.style.label.empty())
                continue;
            if (layer.kind == Kind::Pose)
                writePoseMark(out, {left + 12, y - 4}, 0, layer.style);
            else
                out << "<path fill=\"none\" stroke-linecap=\"round\" stroke=\"" << layer.style.colour
                    << "\" stroke-width=\"" << Fixed{std::max(layer.style.width, 2.5), 1} << '"'
                    << (layer.style.dashed ? " stroke-dasharray=\"6 4\"" : "") << " d=\"M" << left << ' '
                    << Fixed{y - 4, 1} << (layer.kind == Kind::Points ? "h0m8 0h0m8 0h0m8 0h0" : "h26")
                    << "\"/>";
            out << "<text x=\"" << left + 36 << "\" y=\"" << Fixed{y, 1} << "\">"
                << xmlText(layer.style.label) << "</text>\n";
            y += rowHeight;
        }
    }

    std::string title_;
    std::vector<Layer> layers_;
    bool any_ = false;
    Point low_, high_;
    Point origin_, plot_; ///< lower left corner in metres; size in pixels
    double scale_ = 1;    ///< pixels a metre
    double step_ = 1;     ///< of the grid, metres
    double top_ = 0, width_ = 0, height_ = 0;
};

} // namespace vectorlib
