#include "vectorlib/io/LatexPicture.h"

#include "vectorlib/io/LatexText.h"

#include <sstream>

namespace vectorlib {

VECTORLIB_BODY std::string latex::colour(const std::string &hex) {
    unsigned red = 0, green = 0, blue = 0;
    if (hex.size() != 7 || std::sscanf(hex.c_str(), "#%2x%2x%2x", &red, &green, &blue) != 3)
        red = green = blue = 0;
    return "{rgb,255:red," + std::to_string(red) + ";green," + std::to_string(green) + ";blue," +
           std::to_string(blue) + '}';
}

VECTORLIB_BODY LatexPicture::LatexPicture(const Picture &picture, const LatexFrame &frame)
    : picture_(picture)
    , low_(picture.box().low)
    , grid_(picture.gridStep()) {
    const Point size = picture.box().size();
    if (std::max(size.x, size.y) < mostLines * frame.grid) // a finer one would be a grey area
        grid_ = frame.grid;
    scale_ = std::min(frame.width / size.x, frame.height / size.y);
    size_ = size * scale_;
}

VECTORLIB_BODY void LatexPicture::write(std::ostream &out) const {
    out << "\\begin{tikzpicture}[line cap=round, line join=round]\n";
    writeGrid(out);
    for (const Picture::Layer &layer : picture_.layers())
        if (!layer.vertices.empty())
            writeLayer(out, layer);
    out << "\\end{tikzpicture}";
}

VECTORLIB_BODY void LatexPicture::writeLegend(std::ostream &out, const std::vector<Picture::Layer> &layers) {
    for (const Picture::Layer &layer : layers)
        if (!layer.style.label.empty()) {
            const std::string label = latexText(layer.style.label);
            const bool fits = label.size() < 80; // in one line
            out << (fits ? "\\mbox{" : "") << "\\tikz[baseline=-0.6ex, line cap=round]";
            writeSample(out, layer);
            out << '~' << label << (fits ? "}" : "") << "\\quad\n";
        }
}

VECTORLIB_BODY void LatexPicture::writeGrid(std::ostream &out) const {
    const Point high = low_ + size_ / scale_;
    for (const double x : Picture::gridLines(low_.x, high.x, grid_, mostLines))
        writeLine(out, at({x, low_.y}), at({x, high.y}));
    for (const double y : Picture::gridLines(low_.y, high.y, grid_, mostLines))
        writeLine(out, at({low_.x, y}), at({high.x, y}));
    const double step = picture_.gridStep();
    std::size_t widest = 1;
    for (const double x : Picture::gridLines(low_.x, high.x, step))
        writeNumber(out, at({x, low_.y}), "below", x);
    for (const double y : Picture::gridLines(low_.y, high.y, step))
        widest = std::max(widest, writeNumber(out, at({low_.x, y}), "left", y));
    out << "\\node[font=\\small] at " << At{{size_.x / 2, -0.75}} << " {x [m]};\n"
        << "\\node[font=\\small, rotate=90] at "
        << At{{-0.45 - 0.17 * static_cast<double>(widest), size_.y / 2}} << " {y [m]};\n";
}

VECTORLIB_BODY std::size_t LatexPicture::writeNumber(std::ostream &out, At at, const char *side,
                                                     double metres) {
    std::ostringstream number;
    number << Number(rounded(metres, 9));
    out << "\\node[" << side << ", font=\\scriptsize, inner sep=2pt] at " << at << " {$" << number.str()
        << "$};\n";
    return number.str().size();
}

VECTORLIB_BODY void LatexPicture::writeLayer(std::ostream &out, const Picture::Layer &layer) const {
    if (layer.kind == Kind::Pose)
        writePose(out, at(layer.vertices[0]).p, layer.heading, layer.style);
    else if (layer.kind == Kind::Area)
        writeArea(out, layer);
    else
        for (std::size_t i = 0; i < layer.vertices.size(); i += mostVertices)
            writePart(out, layer, i, std::min(i + mostVertices, layer.vertices.size()));
    if (layer.kind == Kind::Segments && layer.style.normals)
        writeNormals(out, layer);
}

VECTORLIB_BODY void LatexPicture::writePart(std::ostream &out, const Picture::Layer &layer, std::size_t from,
                                            std::size_t to) const {
    openDraw(out, layer.style);
    if (layer.kind == Kind::Path && from > 0)
        out << ' ' << at(layer.vertices[from - 1]);
    for (std::size_t i = from; i < to; ++i) {
        const bool starts =
            layer.kind == Kind::Points || (layer.kind == Kind::Segments ? i % 2 == 0 : i == 0);
        out << ((i - from) % 6 == 5 ? "\n" : "") << (starts ? " " : "--") << at(layer.vertices[i])
            << (layer.kind == Kind::Points ? "--+(0.001,0)" : "");
    }
    out << ";\n";
}

VECTORLIB_BODY void LatexPicture::writeArea(std::ostream &out, const Picture::Layer &layer) const {
    out << "\\fill[color=" << latex::colour(layer.style.colour) << ']';
    for (std::size_t i = 0; i < layer.vertices.size(); ++i)
        out << (i % 6 == 5 ? "\n" : "") << (i ? "--" : " ") << at(layer.vertices[i]);
    out << "--cycle;\n";
}

VECTORLIB_BODY void LatexPicture::writeNormals(std::ostream &out, const Picture::Layer &layer) const {
    Picture::Style thin = layer.style;
    thin.width = std::max(0.8, thin.width / 2);
    for (std::size_t i = 0; i + 1 < layer.vertices.size(); i += 2) {
        const LineSegment2D<double> segment(layer.vertices[i], layer.vertices[i + 1]);
        openDraw(out, thin);
        out << ' ' << at(segment.middle()) << "--+" << At{segment.normal() * 0.15} << ";\n";
    }
}

VECTORLIB_BODY void LatexPicture::openDraw(std::ostream &out, const Picture::Style &style) {
    out << "\\draw[color=" << latex::colour(style.colour) << ", line width=" << Fixed{style.width / 2, 2}
        << "pt" << (style.dashed ? ", dashed" : "") << ']';
}

VECTORLIB_BODY void LatexPicture::writePose(std::ostream &out, Point p, double heading,
                                            const Picture::Style &style) {
    out << "\\fill[color=" << latex::colour(style.colour) << "] " << At{p} << " circle (1.8pt);\n";
    openDraw(out, {style.colour, 2, ""});
    out << ' ' << At{p} << "--+" << At{Point(std::cos(heading), std::sin(heading)) * 0.25} << ";\n";
}

VECTORLIB_BODY void LatexPicture::writeSample(std::ostream &out, const Picture::Layer &layer) {
    out << '{';
    if (layer.kind == Kind::Area) {
        out << "\\fill[color=" << latex::colour(layer.style.colour) << "] (0,-0.12) rectangle (0.6,0.12);";
    } else if (layer.kind == Kind::Pose) {
        writePose(out, {0, 0}, 0, layer.style);
    } else {
        openDraw(out, layer.style);
        out << (layer.kind == Kind::Points ? " (0,0)--+(0.001,0) (0.2,0)--+(0.001,0) (0.4,0)--+(0.001,0);"
                                           : " (0,0)--(0.6,0);");
    }
    out << '}';
}

} // namespace vectorlib
