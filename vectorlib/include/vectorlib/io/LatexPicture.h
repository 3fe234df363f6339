#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/io/Number.h"
#include "vectorlib/io/Svg.h"

#include <cstdio>
#include <ostream>
#include <string>
#include <vector>

namespace vectorlib {

namespace latex {

/// What stands for a character that is no letter; nothing where there is none.
const char *sign(char32_t c);

/// Letters beyond ASCII that the fonts of the T1 encoding have.
bool isLetter(char32_t c);

/// One character of ASCII; control characters are blanks.
std::string plain(char c, char next);

/// Whether an exponent begins behind a ^: m^2, s^-1.
std::size_t exponentLength(const std::string &text, std::size_t at);

} // namespace latex

/// Any UTF-8 text as it must be written in a LaTeX document with the T1 encoding; `^2` and the like are
/// raised. What pdflatex has no sign for stands as its number, [U+4E2D]; bytes that are no UTF-8 as ?.
std::string latexText(const std::string &text);

/// How large a picture is in a document, and its grid.
struct LatexFrame {
    double width = 14, height = 17; ///< at most; centimetres, numbers and names of axes not counted
    double grid = 0;                ///< metres from line to line; 0: as the numbers along the axes
};

namespace latex {

/// `#rrggbb` as an expression of a colour, which needs no definition; what is no colour is black.
std::string colour(const std::string &hex);

} // namespace latex

/// A picture as a tikzpicture: its layers over a grid, with metres along the axes.
class LatexPicture {
public:
    LatexPicture(const Picture &picture, const LatexFrame &frame);

    /// Writes the picture and its grid, without a legend.
    void write(std::ostream &out) const;

    /// What the layers with a label mean, in lines that TeX breaks.
    static void writeLegend(std::ostream &out, const std::vector<Picture::Layer> &layers);

private:
    using Point = Picture::Point;
    using Kind = Picture::Kind;
    static constexpr std::size_t maxVertices = 400; ///< of one command: TeX keeps all of a path at once

    static constexpr int maxLines = 200; ///< of a grid that is asked for

    struct At {
        Point p;
        friend std::ostream &operator<<(std::ostream &out, const At &at) {
            return out << '(' << Fixed{at.p.x + 0, 3} << ',' << Fixed{at.p.y + 0, 3} << ')'; // -0 is 0
        }
    };
    At at(Point p) const { return {(p - low_) * scale_}; }

    void writeGrid(std::ostream &out) const;
    static void writeLine(std::ostream &out, At from, At to) {
        out << "\\draw[black!12, line width=0.4pt] " << from << "--" << to << ";\n";
    }
    /// Returns how many characters it has.
    static std::size_t writeNumber(std::ostream &out, At at, const char *side, double metres);

    void writeLayer(std::ostream &out, const Picture::Layer &layer) const;
    void writePart(std::ostream &out, const Picture::Layer &layer, std::size_t from, std::size_t to) const;
    void writeArea(std::ostream &out, const Picture::Layer &layer) const;
    void writeNormals(std::ostream &out, const Picture::Layer &layer) const;
    static void openDraw(std::ostream &out, const Picture::Style &style) {
        out << "\\draw[color=" << latex::colour(style.colour) << ", line width=" << Fixed{style.width / 2, 2}
            << "pt" << (style.dashed ? ", dashed" : "") << ']';
    }
    static void writePose(std::ostream &out, Point p, double heading, const Picture::Style &style) {
        out << "\\fill[color=" << latex::colour(style.colour) << "] " << At{p} << " circle (1.8pt);\n";
        openDraw(out, {style.colour, 2, ""});
        out << ' ' << At{p} << "--+" << At{Point(std::cos(heading), std::sin(heading)) * 0.25} << ";\n";
    }
    static void writeSample(std::ostream &out, const Picture::Layer &layer);

    const Picture &picture_;
    Point low_, size_; ///< metres; centimetres
    double grid_;      ///< metres
    double scale_ = 1; ///< centimetres a metre
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/io/LatexPicture.cpp")
