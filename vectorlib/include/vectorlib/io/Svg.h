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
        : m_title(std::move(title)) {}

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
        out << R"(<svg xmlns="http://www.w3.org/2000/svg" width=")" << Fixed{m_width, 0} << R"(" height=")"
            << Fixed{m_height, 0} << R"(" viewBox="0 0 )" << Fixed{m_width, 0} << ' ' << Fixed{m_height, 0}
            << R"(" font-family="sans-serif" font-size="13" fill="#333">)"
            << "\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
        writeGrid(out);
        for (const Layer &layer : m_layers)
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

    Layer &add(Kind kind, Style style) {
        m_layers.push_back({kind, std::move(style), {}, 0});
        return m_layers.back();
    }
    void take(Layer &layer, Point p) {
        if (!p.isFinite())
            return;
        layer.vertices.push_back(p);
        m_low = m_any ? Point(std::min(m_low.x, p.x), std::min(m_low.y, p.y)) : p;
        m_high = m_any ? Point(std::max(m_high.x, p.x), std::max(m_high.y, p.y)) : p;
        m_any = true;
    }

    void layOut() {
        Point size = m_high - m_low;
        const double margin = std::max(0.03 * std::max(size.x, size.y), 0.2);
        size += Point(2 * margin, 2 * margin);
        m_origin = m_low - Point(margin, margin);
        m_scale = std::min(mostWide / size.x, mostHigh / size.y);
        m_plot = size * m_scale;
        m_width = std::max(left + m_plot.x + right, 480.0);
        m_top = 34 + rowHeight * static_cast<double>(legendRows());
        m_height = m_top + m_plot.y + bottom;
        m_step = niceStep(std::max(size.x, size.y) / 10);
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
        return {left + (p.x - m_origin.x) * m_scale, m_top + m_plot.y - (p.y - m_origin.y) * m_scale};
    }
    static void writePoint(std::ostream &out, Point p) { out << Fixed{p.x, 1} << ' ' << Fixed{p.y, 1}; }

    void writeGrid(std::ostream &out) const {
        const double low = m_top + m_plot.y, high = m_top;
        const int decimals = m_step < 0.1 ? 2 : m_step < 1 ? 1 : 0;
        out << "<g stroke=\"#e3e7ee\" stroke-width=\"1\" font-size=\"11\" fill=\"#6b7280\">\n";
        for (double x = std::ceil(m_origin.x / m_step) * m_step; x <= m_origin.x + m_plot.x / m_scale;
             x += m_step) {
            const double at = toPixel({x, 0}).x;
            out << "<path d=\"M" << Fixed{at, 1} << ' ' << Fixed{low, 1} << 'V' << Fixed{high, 1}
                << "\"/><text x=\"" << Fixed{at, 1} << "\" y=\"" << Fixed{low + 16, 1}
                << "\" stroke=\"none\" text-anchor=\"middle\">" << Fixed{rounded(x), decimals} << "</text>\n";
        }
        for (double y = std::ceil(m_origin.y / m_step) * m_step; y <= m_origin.y + m_plot.y / m_scale;
             y += m_step) {
            const double at = toPixel({0, y}).y;
            out << "<path d=\"M" << Fixed{left, 1} << ' ' << Fixed{at, 1} << 'H' << Fixed{left + m_plot.x, 1}
                << "\"/><text x=\"" << Fixed{left - 6, 1} << "\" y=\"" << Fixed{at + 4, 1}
                << "\" stroke=\"none\" text-anchor=\"end\">" << Fixed{rounded(y), decimals} << "</text>\n";
        }
        out << "</g>\n";
    }
    double rounded(double v) const { return std::abs(v) < m_step / 2 ? 0 : v; }

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
        const double y = m_height - 20, x = left, length = m_step * m_scale;
        out << "<path stroke=\"#333\" stroke-width=\"2\" fill=\"none\" d=\"M" << Fixed{x, 1} << ' '
            << Fixed{y - 5, 1} << "v10m0 -5h" << Fixed{length, 1} << "m0 -5v10\"/><text x=\""
            << Fixed{x + length + 8, 1} << "\" y=\"" << Fixed{y + 4, 1} << "\">" << Number(m_step)
            << " m</text>\n";
    }
    std::size_t legendRows() const {
        std::size_t rows = 0;
        for (const Layer &layer : m_layers)
            rows += !layer.style.label.empty();
        return rows;
    }
    void writeLegend(std::ostream &out) const {
        out << "<text x=\"" << left << "\" y=\"22\" font-size=\"15\" font-weight=\"bold\">"
            << escaped(m_title) << "</text>\n";
        double y = 40;
        for (const Layer &layer : m_layers) {
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
                << escaped(layer.style.label) << "</text>\n";
            y += rowHeight;
        }
    }
    static std::string escaped(const std::string &text) {
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

    std::string m_title;
    std::vector<Layer> m_layers;
    bool m_any = false;
    Point m_low, m_high;
    Point m_origin, m_plot; ///< lower left corner in metres; size in pixels
    double m_scale = 1;     ///< pixels a metre
    double m_step = 1;      ///< of the grid, metres
    double m_top = 0, m_width = 0, m_height = 0;
};

} // namespace vectorlib
