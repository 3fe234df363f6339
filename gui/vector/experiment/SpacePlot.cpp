#include "gui/vector/experiment/SpacePlot.h"

#include "vectorlib/io/Number.h"

#include <algorithm>
#include <cctype>
#include <cmath>

namespace hermes::vector {

namespace {

void writePoint(std::ostream &out, const std::array<double, 3> &p, char between) {
    using vectorlib::Number;
    out << Number(p[0]) << between << Number(p[1]) << between << Number(p[2]);
}

bool isBreak(const std::array<double, 3> &p) {
    return !std::isfinite(p[0] + p[1] + p[2]);
}

// The colour's name must be letters, its value in capitals.
std::string colourName(const SpacePlot &plot, const SpaceCurve &curve) {
    return std::string("space") + static_cast<char>('A' + (&curve - plot.curves.data()) % 26);
}
std::string capitals(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::toupper(c); });
    return text;
}

} // namespace

void writeGnuplot(std::ostream &out, const SpacePlot &plot) {
    out << "set terminal svg size 900,640 font 'sans-serif,13' background '#ffffff'\n"
        << "set title '" << plot.title << "'\nset xlabel '" << plot.xAxis << "' offset 0,-1\nset ylabel '"
        << plot.yAxis << "' offset 0,-1\nset zlabel '" << plot.zAxis << "' rotate parallel\n"
        << "set view 62,35\nset ticslevel 0\nset grid x y z lc rgb '#dddddd'\nset key outside right "
           "top\nsplot";
    for (std::size_t i = 0; i < plot.curves.size(); ++i)
        out << (i ? "," : "") << " '-' using 1:2:3 with lines lw 2 lc rgb '" << plot.curves[i].colour
            << "' title '" << plot.curves[i].label << "'";
    out << '\n';
    for (const SpaceCurve &curve : plot.curves) {
        for (const auto &point : curve.points) {
            if (isBreak(point)) {
                out << "\n\n"; // one empty line alone would make a net of the lines
                continue;
            }
            writePoint(out, point, ' ');
            out << '\n';
        }
        out << "e\n";
    }
}

void writeLatex(std::ostream &out, const SpacePlot &plot) {
    out << "\\begin{tikzpicture}\\begin{axis}[view={35}{28}, grid=major, empty line=jump, title={"
        << plot.title << "}, xlabel={" << plot.xAxis << "}, ylabel={" << plot.yAxis << "}, zlabel={"
        << plot.zAxis << "}, legend pos=outer north east]\n";
    for (const SpaceCurve &curve : plot.curves) {
        const std::string colour = colourName(plot, curve);
        out << "\\definecolor{" << colour << "}{HTML}{" << capitals(curve.colour.substr(1))
            << "}\n\\addplot3[color=" << colour << ", thick, no marks"
            << (curve.label.empty() ? ", forget plot" : "") << "] coordinates {";
        for (const auto &point : curve.points) {
            if (isBreak(point)) {
                out << "\n\n"; // pgfplots: an empty line
                continue;
            }
            out << " (";
            writePoint(out, point, ',');
            out << ')';
        }
        out << "};\n";
        if (!curve.label.empty())
            out << "\\addlegendentry{" << curve.label << "}\n";
    }
    out << "\\end{axis}\\end{tikzpicture}\n\n";
}

} // namespace hermes::vector
