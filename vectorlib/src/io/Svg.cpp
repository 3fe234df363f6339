#include "vectorlib/io/Svg.h"

namespace vectorlib {

VECTORLIB_BODY const char *colour::distinct(std::size_t i) {
    constexpr const char *cycle[] = {"#0072b2", "#e69f00", "#009e73", "#cc79a7",
                                     "#56b4e9", "#a0522d", "#7b5ea7", "#5f7a00"};
    return cycle[i % 8];
}

VECTORLIB_BODY void Picture::path(Style style, const std::vector<Point> &path) {
    Layer &layer = add(Kind::Path, std::move(style));
    for (const Point &p : path)
        take(layer, p);
}

VECTORLIB_BODY void Picture::pose(Style style, Point at, double heading) {
    Layer &layer = add(Kind::Pose, std::move(style));
    if (std::isfinite(heading))
        take(layer, at);
    layer.heading = heading;
}

VECTORLIB_BODY Picture::Box Picture::box() const {
    const Point size = box_.size();
    double margin = std::max(0.03 * std::max(size.x, size.y), 0.2);
    for (const double far : {box_.low.x, box_.low.y, box_.high.x, box_.high.y})
        margin = std::max(margin, 1e-14 * std::abs(far)); // less would be lost by rounding
    return {box_.low - Point(margin, margin), box_.high + Point(margin, margin)};
}

VECTORLIB_BODY double Picture::gridStep() const {
    const Point size = box().size();
    const double wanted = std::max(size.x, size.y) / maxLines;
    const double power = std::pow(10, std::floor(std::log10(wanted)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * power >= wanted)
            return factor * power;
    return 10 * power;
}

VECTORLIB_BODY std::vector<double> Picture::gridLines(double low, double high, double step, int most) {
    std::vector<double> lines;
    // Counted: far from the origin a step more may be the same number.
    for (int i = 0; i <= most; ++i) {
        const double at = (std::ceil(low / step) + i) * step;
        if (at > high)
            break;
        lines.push_back(std::abs(at) < step / 2 ? 0 : at);
    }
    return lines;
}

VECTORLIB_BODY void Picture::take(Layer &layer, Point p) {
    if (!isPlace(p))
        return;
    layer.vertices.push_back(p);
    box_.low = any_ ? Point(std::min(box_.low.x, p.x), std::min(box_.low.y, p.y)) : p;
    box_.high = any_ ? Point(std::max(box_.high.x, p.x), std::max(box_.high.y, p.y)) : p;
    any_ = true;
}

VECTORLIB_BODY std::string xmlText(const std::string &text) {
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

VECTORLIB_BODY void SvgPicture::write(std::ostream &out) {
    layOut();
    out << R"(<svg xmlns="http://www.w3.org/2000/svg" width=")" << Fixed{width_, 0} << R"(" height=")"
        << Fixed{height_, 0} << R"(" viewBox="0 0 )" << Fixed{width_, 0} << ' ' << Fixed{height_, 0}
        << R"(" font-family="sans-serif" font-size="13" fill="#333">)"
        << "\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
    writeGrid(out);
    for (const Layer &layer : layers())
        writeLayer(out, layer);
    writeScaleBar(out);
    writeLegend(out);
    out << "</svg>\n";
}

VECTORLIB_BODY void SvgPicture::layOut() {
    const Box whole = box();
    const Point size = whole.size();
    origin_ = whole.low;
    scale_ = std::min(maxWide / size.x, maxHigh / size.y);
    plot_ = size * scale_;
    width_ =
        std::max({left + plot_.x + right, 480.0, left + 8.5 * static_cast<double>(title().size()) + right});
    top_ = 34 + rowHeight * static_cast<double>(legendRows());
    height_ = top_ + plot_.y + bottom;
    step_ = gridStep();
}

VECTORLIB_BODY void SvgPicture::writeGrid(std::ostream &out) const {
    const double low = top_ + plot_.y, high = top_;
    const int decimals = step_ < 0.1 ? 2 : step_ < 1 ? 1 : 0;
    out << "<g stroke=\"#e3e7ee\" stroke-width=\"1\" font-size=\"11\" fill=\"#6b7280\">\n";
    for (const double x : gridLines(origin_.x, origin_.x + plot_.x / scale_, step_)) {
        const double at = toPixel({x, 0}).x;
        out << "<path d=\"M" << Fixed{at, 1} << ' ' << Fixed{low, 1} << 'V' << Fixed{high, 1}
            << "\"/><text x=\"" << Fixed{at, 1} << "\" y=\"" << Fixed{low + 16, 1}
            << "\" stroke=\"none\" text-anchor=\"middle\">" << Fixed{x, decimals} << "</text>\n";
    }
    for (const double y : gridLines(origin_.y, origin_.y + plot_.y / scale_, step_)) {
        const double at = toPixel({0, y}).y;
        out << "<path d=\"M" << Fixed{left, 1} << ' ' << Fixed{at, 1} << 'H' << Fixed{left + plot_.x, 1}
            << "\"/><text x=\"" << Fixed{left - 6, 1} << "\" y=\"" << Fixed{at + 4, 1}
            << "\" stroke=\"none\" text-anchor=\"end\">" << Fixed{y, decimals} << "</text>\n";
    }
    out << "</g>\n";
}

VECTORLIB_BODY void SvgPicture::writeLayer(std::ostream &out, const Layer &layer) const {
    if (layer.vertices.empty())
        return;
    if (layer.kind == Kind::Pose) {
        const Point at = toPixel(layer.vertices.front());
        writePoseMark(out, at, layer.heading, layer.style);
        return;
    }
    if (layer.kind == Kind::Area)
        out << "<path fill=\"" << layer.style.colour << "\" d=\"";
    else
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
    if (layer.style.normals && layer.kind == Kind::Segments)
        writeNormals(out, layer);
    out << "\"/>\n";
}

VECTORLIB_BODY void SvgPicture::writeNormals(std::ostream &out, const Layer &layer) const {
    for (std::size_t i = 0; i + 1 < layer.vertices.size(); i += 2) {
        const LineSegment2D<double> segment(layer.vertices[i], layer.vertices[i + 1]);
        const Point foot = toPixel(segment.middle()), normal = segment.normal() * normalLength;
        out << 'M';
        writePoint(out, foot);
        out << 'l';
        writePoint(out, {normal.x, -normal.y});
    }
}

VECTORLIB_BODY void SvgPicture::writePoseMark(std::ostream &out, Point at, double heading,
                                              const Style &style) {
    const Point tip = at + Point(std::cos(heading), -std::sin(heading)) * 14;
    out << "<circle cx=\"" << Fixed{at.x, 1} << "\" cy=\"" << Fixed{at.y, 1} << "\" r=\"5\" fill=\""
        << style.colour << "\"/><path stroke=\"" << style.colour << "\" stroke-width=\"2.5\" d=\"M";
    writePoint(out, at);
    out << 'L';
    writePoint(out, tip);
    out << "\"/>\n";
}

VECTORLIB_BODY void SvgPicture::writeScaleBar(std::ostream &out) const {
    const double y = height_ - 20, x = left, length = step_ * scale_;
    out << "<path stroke=\"#333\" stroke-width=\"2\" fill=\"none\" d=\"M" << Fixed{x, 1} << ' '
        << Fixed{y - 5, 1} << "v10m0 -5h" << Fixed{length, 1} << "m0 -5v10\"/><text x=\""
        << Fixed{x + length + 8, 1} << "\" y=\"" << Fixed{y + 4, 1} << "\">" << Number(step_)
        << " m</text>\n";
}

VECTORLIB_BODY std::size_t SvgPicture::legendRows() const {
    std::size_t rows = 0;
    for (const Layer &layer : layers())
        rows += !layer.style.label.empty();
    return rows;
}

VECTORLIB_BODY void SvgPicture::writeLegend(std::ostream &out) const {
    out << "<text x=\"" << left << "\" y=\"22\" font-size=\"15\" font-weight=\"bold\">" << xmlText(title())
        << "</text>\n";
    double y = 40;
    for (const Layer &layer : layers()) {
        if (layer.style.label.empty())
            continue;
        if (layer.kind == Kind::Pose)
            writePoseMark(out, {left + 12, y - 4}, 0, layer.style);
        else if (layer.kind == Kind::Area)
            out << "<rect x=\"" << left << "\" y=\"" << Fixed{y - 9, 1}
                << "\" width=\"26\" height=\"10\" fill=\"" << layer.style.colour << "\"/>";
        else
            out << "<path fill=\"none\" stroke-linecap=\"round\" stroke=\"" << layer.style.colour
                << "\" stroke-width=\"" << Fixed{std::max(layer.style.width, 2.5), 1} << '"'
                << (layer.style.dashed ? " stroke-dasharray=\"6 4\"" : "") << " d=\"M" << left << ' '
                << Fixed{y - 4, 1} << (layer.kind == Kind::Points ? "h0m8 0h0m8 0h0m8 0h0" : "h26") << "\"/>";
        out << "<text x=\"" << left + 36 << "\" y=\"" << Fixed{y, 1} << "\">" << xmlText(layer.style.label)
            << "</text>\n";
        y += rowHeight;
    }
}

} // namespace vectorlib
