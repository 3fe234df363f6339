#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/io/Number.h"
#include "vectorlib/io/Picture.h"

#include <ostream>
#include <string>

namespace vectorlib {

/// Text as it must be written between the tags of XML.
std::string xmlText(const std::string &text);

/// A picture as SVG: layers over a grid in metres, with scale bar and legend.
class SvgPicture : public Picture {
public:
    using Picture::Picture;

    /// Writes the whole file.
    void write(std::ostream &out);

private:
    static constexpr double left = 56, right = 24, bottom = 62, rowHeight = 20, mostWide = 1200,
                            mostHigh = 1200, normalLength = 7;

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
