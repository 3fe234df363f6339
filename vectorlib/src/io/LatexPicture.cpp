#include "vectorlib/io/LatexPicture.h"
#include "vectorlib/io/TextInput.h"

#include <algorithm>
#include <sstream>

namespace vectorlib {

VECTORLIB_BODY const char *latex::sign(char32_t c) {
    struct Sign {
        char32_t code;
        const char *latex;
    };
    static constexpr Sign signs[] = {{0xa0, "~"},
                                     {0xb0, "\\ensuremath{^\\circ}"},
                                     {0xb1, "\\ensuremath{\\pm}"},
                                     {0xb2, "\\ensuremath{^2}"},
                                     {0xb3, "\\ensuremath{^3}"},
                                     {0xb5, "\\ensuremath{\\mu}"},
                                     {0xb7, "\\ensuremath{\\cdot}"},
                                     {0xb9, "\\ensuremath{^1}"},
                                     {0xd7, "\\ensuremath{\\times}"},
                                     {0xf7, "\\ensuremath{\\div}"},
                                     {0x394, "\\ensuremath{\\Delta}"},
                                     {0x3a3, "\\ensuremath{\\Sigma}"},
                                     {0x3a9, "\\ensuremath{\\Omega}"},
                                     {0x3b1, "\\ensuremath{\\alpha}"},
                                     {0x3b2, "\\ensuremath{\\beta}"},
                                     {0x3b3, "\\ensuremath{\\gamma}"},
                                     {0x3b4, "\\ensuremath{\\delta}"},
                                     {0x3b5, "\\ensuremath{\\epsilon}"},
                                     {0x3b8, "\\ensuremath{\\theta}"},
                                     {0x3bb, "\\ensuremath{\\lambda}"},
                                     {0x3bc, "\\ensuremath{\\mu}"},
                                     {0x3c0, "\\ensuremath{\\pi}"},
                                     {0x3c1, "\\ensuremath{\\rho}"},
                                     {0x3c3, "\\ensuremath{\\sigma}"},
                                     {0x3c4, "\\ensuremath{\\tau}"},
                                     {0x3c6, "\\ensuremath{\\varphi}"},
                                     {0x3c9, "\\ensuremath{\\omega}"},
                                     {0x2013, "--"},
                                     {0x2014, "---"},
                                     {0x2026, "\\ensuremath{\\dots}"},
                                     {0x2192, "\\ensuremath{\\to}"},
                                     {0x2212, "\\ensuremath{-}"},
                                     {0x221a, "\\ensuremath{\\surd}"},
                                     {0x221e, "\\ensuremath{\\infty}"},
                                     {0x2248, "\\ensuremath{\\approx}"},
                                     {0x2264, "\\ensuremath{\\leq}"},
                                     {0x2265, "\\ensuremath{\\geq}"}};
    const auto *found =
        std::find_if(std::begin(signs), std::end(signs), [c](const Sign &s) { return s.code == c; });
    return found == std::end(signs) ? nullptr : found->latex;
}

VECTORLIB_BODY bool latex::isLetter(char32_t c) {
    static constexpr char32_t extended[] = {
        0x102, 0x103, 0x104, 0x105, 0x106, 0x107, 0x10c, 0x10d, 0x10e, 0x10f, 0x110, 0x111,
        0x118, 0x119, 0x11a, 0x11b, 0x11e, 0x11f, 0x130, 0x131, 0x139, 0x13a, 0x13d, 0x13e,
        0x141, 0x142, 0x143, 0x144, 0x147, 0x148, 0x150, 0x151, 0x152, 0x153, 0x154, 0x155,
        0x158, 0x159, 0x15a, 0x15b, 0x15e, 0x15f, 0x160, 0x161, 0x162, 0x163, 0x164, 0x165,
        0x16e, 0x16f, 0x170, 0x171, 0x178, 0x179, 0x17a, 0x17b, 0x17c, 0x17d, 0x17e};
    return (c >= 0xc0 && c <= 0xff) || std::binary_search(std::begin(extended), std::end(extended), c);
}

VECTORLIB_BODY std::string latex::plain(char c, char next) {
    if (c == '\\')
        return "\\textbackslash{}";
    if (c == '^' || c == '~')
        return std::string("\\") + c + "{}";
    if (std::string("#$%&_{}").find(c) != std::string::npos)
        return std::string("\\") + c;
    if (c == '[' || c == ']' || c == '*') // else an option where it follows a command, as the end of a line
        return std::string("{") + c + '}';
    if (static_cast<unsigned char>(c) < ' ' || c == 127)
        return " ";
    // Two of them together, or a quotation mark behind, would become another sign.
    const bool joins = (c == next && std::string("-`',<>").find(c) != std::string::npos) ||
                       (next == '`' && (c == '?' || c == '!'));
    return joins ? std::string(1, c) + "{}" : std::string(1, c);
}

VECTORLIB_BODY std::size_t latex::exponentLength(const std::string &text, std::size_t at) {
    std::size_t end = at;
    if (end < text.size() && text[end] == '-')
        ++end;
    const std::size_t digits = end;
    while (end < text.size() && text[end] >= '0' && text[end] <= '9')
        ++end;
    return end > digits ? end - at : 0;
}

VECTORLIB_BODY std::string latexText(const std::string &text) {
    std::string result;
    for (std::size_t i = 0; i < text.size();) {
        if (static_cast<unsigned char>(text[i]) < 0x80) {
            const std::size_t raised = text[i] == '^' ? latex::exponentLength(text, i + 1) : 0;
            result += raised > 0 ? "\\ensuremath{^{" + text.substr(i + 1, raised) + "}}"
                                 : latex::plain(text[i], i + 1 < text.size() ? text[i + 1] : '\0');
            i += 1 + raised;
            continue;
        }
        const Utf8Character c = nextCharacter(text, i);
        if (!c.isValid()) {
            result += '?';
        } else if (const char *sign = latex::sign(c.code)) {
            result += sign;
        } else if (latex::isLetter(c.code)) {
            result += text.substr(i, c.length);
        } else {
            char number[24];
            std::snprintf(number, sizeof number, "{[}U+%04X{]}", static_cast<unsigned>(c.code));
            result += number;
        }
        i += c.length;
    }
    return result;
}

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
    if (std::max(size.x, size.y) < maxLines * frame.grid) // a finer one would be a grey area
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
    for (const double x : Picture::gridLines(low_.x, high.x, grid_, maxLines))
        writeLine(out, at({x, low_.y}), at({x, high.y}));
    for (const double y : Picture::gridLines(low_.y, high.y, grid_, maxLines))
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
        for (std::size_t i = 0; i < layer.vertices.size(); i += maxVertices)
            writePart(out, layer, i, std::min(i + maxVertices, layer.vertices.size()));
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
