#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/io/Number.h"

#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>
#include <vector>

namespace vectorlib {

/// Colours with a meaning, the same in every picture; they stay apart for the colour-blind.
namespace colour {
constexpr const char *map = "#1b2a41";    ///< what is known: segments of a map, of a world, of the static set
constexpr const char *points = "#8d99ae"; ///< what was measured
constexpr const char *outliers = "#d62828";  ///< what was left out
constexpr const char *estimate = "#0072b2";  ///< what was computed: trajectories, registered segments
constexpr const char *reference = "#e69f00"; ///< what it is compared with
constexpr const char *before = "#cc79a7";    ///< where the dynamic set was

/// For parts that need only be told from their neighbours, such as clusters.
const char *distinct(std::size_t i);
} // namespace colour

/// Things in the plane, in layers of one style each, metres, the y axis up: what SvgPicture and LatexExport
/// draw. What is not finite, or farther than any place (1e150), is left out.
class Picture {
public:
    static constexpr int maxLines = 10; ///< of the grid, and one more

    using Point = Vector2D<double>;

    /// How the things of a layer are drawn.
    struct Style {
        std::string colour; ///< as in CSS: `#rrggbb`
        double width = 1.5; ///< pixels; diameter of points
        std::string label;  ///< in the legend; none when empty
        bool dashed = false;
        bool normals = false; ///< of segments: a tick to the side that was free
    };
    /// What the points of a layer stand for.
    enum class Kind {
        Points,   ///< dots
        Segments, ///< lines between two points each
        Path,     ///< one line through all points
        Pose,     ///< a circle with a tick in its heading
        Area      ///< a filled polygon
    };
    /// Things of one kind and style, in the order in which they were added; metres.
    struct Layer {
        Kind kind;
        Style style;
        std::vector<Point> vertices; ///< of a pose one, of segments begins and ends in turn
        double heading = 0;          ///< of a pose
    };
    /// A rectangle along the axes, from its lower left corner to its upper right one; metres.
    struct Box {
        Point low, high;
        Point size() const { return high - low; }
    };

    explicit Picture(std::string title)
        : title_(std::move(title)) {}

    /// Adds a layer of dots.
    template <typename Scalar>
    void points(Style style, const std::vector<Vector2D<Scalar>> &points) {
        Layer &layer = add(Kind::Points, std::move(style));
        for (const auto &p : points)
            take(layer, Point(p));
    }
    /// Each in a colour that its neighbours have not. A legend of a dozen rows is still read; of more
    /// clusters none is named.
    template <typename Scalar>
    void clusters(double width, const std::vector<std::vector<Vector2D<Scalar>>> &clusters) {
        for (std::size_t c = 0; c < clusters.size(); ++c)
            points({colour::distinct(c), width,
                    clusters.size() > 12 ? ""
                                         : "cluster " + std::to_string(c) + ": " +
                                               std::to_string(clusters[c].size()) + " points"},
                   clusters[c]);
    }
    /// Adds a layer of segments.
    template <typename Scalar>
    void segments(Style style, const std::vector<LineSegment2D<Scalar>> &segments) {
        Layer &layer = add(Kind::Segments, std::move(style));
        for (const auto &s : segments)
            if (isPlace(Point(s.begin())) && isPlace(Point(s.end()))) {
                take(layer, Point(s.begin()));
                take(layer, Point(s.end()));
            }
    }
    /// Adds a layer with one line through all points.
    void path(Style style, const std::vector<Point> &path);
    /// A polygon that is filled.
    void area(Style style, const std::vector<Point> &corners) {
        Layer &layer = add(Kind::Area, std::move(style));
        for (const Point &p : corners)
            take(layer, p);
    }
    /// A sensor or robot: a circle with a tick in its heading.
    void pose(Style style, Point at, double heading);

    const std::string &title() const { return title_; }
    const std::vector<Layer> &layers() const { return layers_; }

    /// Of all that is shown, with a margin: never empty.
    Box box() const;
    /// From one line of a grid to the next, metres: 1, 2 or 5 times a power of ten, so that at most about ten
    /// lines cross the longer side of the box.
    double gridStep() const;
    /// Where the lines of a grid are from low to high, at most one more than `most`.
    static std::vector<double> gridLines(double low, double high, double step, int most = maxLines);

private:
    static bool isPlace(Point p) { return std::abs(p.x) <= 1e150 && std::abs(p.y) <= 1e150; }
    Layer &add(Kind kind, Style style) {
        layers_.push_back({kind, std::move(style), {}, 0});
        return layers_.back();
    }
    void take(Layer &layer, Point p);

    std::string title_;
    std::vector<Layer> layers_;
    bool any_ = false;
    Box box_;
};

/// Text as it must be written between the tags of XML.
std::string xmlText(const std::string &text);

/// A picture as SVG: layers over a grid in metres, with scale bar and legend.
class SvgPicture : public Picture {
public:
    using Picture::Picture;

    /// Writes the whole file.
    void write(std::ostream &out);

private:
    static constexpr double left = 56, right = 24, bottom = 62, rowHeight = 20, maxWide = 1200,
                            maxHigh = 1200, normalLength = 7;

    void layOut();
    Point toPixel(Point p) const {
        return {left + (p.x - origin_.x) * scale_, top_ + plot_.y - (p.y - origin_.y) * scale_};
    }
    static void writePoint(std::ostream &out, Point p) { out << Fixed{p.x, 1} << ' ' << Fixed{p.y, 1}; }

    void writeGrid(std::ostream &out) const;

    void writeLayer(std::ostream &out, const Layer &layer) const;
    void writeNormals(std::ostream &out, const Layer &layer) const;
    static void writePoseMark(std::ostream &out, Point at, double heading, const Style &style);

    void writeScaleBar(std::ostream &out) const;
    std::size_t legendRows() const;
    void writeLegend(std::ostream &out) const;

    Point origin_, plot_; ///< lower left corner in metres; size in pixels
    double scale_ = 1;    ///< pixels a metre
    double step_ = 1;     ///< of the grid, metres
    double top_ = 0, width_ = 0, height_ = 0;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/io/Svg.cpp")
