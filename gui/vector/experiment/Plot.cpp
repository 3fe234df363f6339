#include "gui/vector/experiment/Plot.h"

#include "vectorlib/io/Number.h"

#include <algorithm>
#include <cctype>

namespace hermes {

using vectorlib::Number;

namespace {

bool hasPlace(const Plot &plot, std::pair<double, double> point) {
    return (!plot.xLogarithmic || point.first > 0) && (!plot.yLogarithmic || point.second > 0);
}

// The colour's name must be letters for LaTeX.
std::string colourName(std::size_t curve) {
    return std::string("curve") + static_cast<char>('A' + curve % 26);
}

} // namespace

void writeGnuplot(std::ostream &out, const Plot &plot) {
    out << "set terminal svg size 720,460 font 'sans-serif,13' background '#ffffff'\n"
        << "set title '" << plot.title << "'\nset xlabel '" << plot.xAxis << "'\nset ylabel '" << plot.yAxis
        << "'\n"
        << "set grid lc rgb '#dddddd'\nset key outside right top\n"
        << (plot.xLogarithmic ? "set logscale x\n" : "") << (plot.yLogarithmic ? "set logscale y\n" : "")
        << "plot";
    for (std::size_t i = 0; i < plot.curves.size(); ++i)
        out << (i ? "," : "") << " '-' using 1:2 with linespoints pt 7 ps 0.5 lw 2 lc rgb '"
            << plot.curves[i].colour << "' title '" << plot.curves[i].label << "'";
    out << '\n';
    for (const Curve &curve : plot.curves) {
        for (const auto &point : curve.points)
            if (hasPlace(plot, point))
                out << Number(point.first) << ' ' << Number(point.second) << '\n';
        out << "e\n";
    }
}

void writeLatex(std::ostream &out, const std::string &title, const std::vector<Plot> &plots) {
    out << "\\documentclass{article}\n\\usepackage{pgfplots}\n\\pgfplotsset{compat=1.16}\n\\begin{document}\n"
        << "\\section*{" << title << "}\n";
    for (const Plot &plot : plots) {
        out << "\\begin{tikzpicture}\\begin{axis}[" << (plot.xLogarithmic ? "xmode=log, " : "")
            << (plot.yLogarithmic ? "ymode=log, " : "") << "title={" << plot.title << "}, xlabel={"
            << plot.xAxis << "}, ylabel={" << plot.yAxis << "}, grid=major, legend pos=outer north east]\n";
        for (std::size_t i = 0; i < plot.curves.size(); ++i) {
            const Curve &curve = plot.curves[i];
            std::string rgb = curve.colour.substr(1);
            std::transform(rgb.begin(), rgb.end(), rgb.begin(),
                           [](unsigned char c) { return std::toupper(c); });
            out << "\\definecolor{" << colourName(i) << "}{HTML}{" << rgb
                << "}\n\\addplot[color=" << colourName(i) << ", mark=*, mark size=1pt, thick] coordinates {";
            for (const auto &point : curve.points)
                if (hasPlace(plot, point))
                    out << " (" << Number(point.first) << ',' << Number(point.second) << ')';
            out << "};\n\\addlegendentry{" << curve.label << "}\n";
        }
        out << "\\end{axis}\\end{tikzpicture}\n\n";
    }
    out << "\\end{document}\n";
}

} // namespace hermes
