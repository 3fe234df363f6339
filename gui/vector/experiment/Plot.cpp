#include "gui/vector/experiment/Plot.h"

#include "vectorlib/io/Number.h"

#include <algorithm>
#include <cctype>
#include <cmath>

namespace hermes::vector {

using vectorlib::Number;

namespace {

enum class Place { Shown, LeftOut, Break };

Place placeOf(const Plot &plot, std::pair<double, double> point) {
    if (!std::isfinite(point.first) || !std::isfinite(point.second))
        return Place::Break;
    return (!plot.xLogarithmic || point.first > 0) && (!plot.yLogarithmic || point.second > 0)
               ? Place::Shown
               : Place::LeftOut;
}

// The colour's name must be letters for LaTeX.
std::string colourName(std::size_t curve) {
    return std::string("curve") + static_cast<char>('A' + curve % 26);
}

// Plain text for LaTeX: m^2 with its exponent raised, signs with a meaning as themselves.
std::string latexText(const std::string &text) {
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i)
        if (text[i] == '^' && i + 1 < text.size())
            result += std::string("$^") + text[++i] + '$';
        else if (std::string("_%&#$").find(text[i]) != std::string::npos)
            result += std::string("\\") + text[i];
        else
            result += text[i];
    return result;
}

/// Where the band of a curve is shown: there and back again, a closed outline.
std::vector<std::pair<double, double>> outlineOf(const Curve &curve, const Plot &plot) {
    std::vector<std::pair<double, double>> low, outline;
    for (std::size_t i = 0; i < curve.band.size() && i < curve.points.size(); ++i) {
        const std::pair<double, double> below(curve.points[i].first, curve.band[i].first),
            above(curve.points[i].first, curve.band[i].second);
        if (placeOf(plot, below) != Place::Shown || placeOf(plot, above) != Place::Shown)
            continue;
        low.push_back(below);
        outline.push_back(above);
    }
    outline.insert(outline.end(), low.rbegin(), low.rend());
    return outline;
}

void writeBand(std::ostream &out, const Curve &curve, const std::string &colour, const Plot &plot) {
    const auto outline = outlineOf(curve, plot);
    if (outline.empty())
        return;
    out << "\\addplot[draw=none, fill=" << colour << ", fill opacity=0.25, forget plot] coordinates {";
    for (const auto &point : outline)
        out << " (" << Number(point.first) << ',' << Number(point.second) << ')';
    out << "} \\closedcycle;\n";
}

void writeLatex(std::ostream &out, const Curve &curve, const std::string &colour, const Plot &plot) {
    std::string rgb = curve.colour.substr(1);
    std::transform(rgb.begin(), rgb.end(), rgb.begin(), [](unsigned char c) { return std::toupper(c); });
    out << "\\definecolor{" << colour << "}{HTML}{" << rgb << "}\n";
    writeBand(out, curve, colour, plot);
    out << "\\addplot[color=" << colour << (plot.isDrawing ? "" : ", mark=*, mark size=1pt, thick")
        << (curve.label.empty() ? ", forget plot" : "") << "] coordinates {";
    for (const auto &point : curve.points) {
        const Place place = placeOf(plot, point);
        if (place == Place::Shown)
            out << " (" << Number(point.first) << ',' << Number(point.second) << ')';
        else if (place == Place::Break)
            out << "\n\n"; // pgfplots: an empty line
    }
    out << "};\n";
    if (!curve.label.empty())
        out << "\\addlegendentry{" << latexText(curve.label) << "}\n";
}

void writeLatex(std::ostream &out, const Plot &plot) {
    out << "\\begin{tikzpicture}\\begin{axis}[" << (plot.xLogarithmic ? "xmode=log, " : "")
        << (plot.yLogarithmic ? "ymode=log, " : "")
        << (plot.isDrawing ? "axis equal image, empty line=jump, " : "") << "title={" << latexText(plot.title)
        << "}, xlabel={" << latexText(plot.xAxis) << "}, ylabel={" << latexText(plot.yAxis)
        << "}, grid=major, legend pos=outer north east]\n";
    for (std::size_t i = 0; i < plot.curves.size(); ++i)
        writeLatex(out, plot.curves[i], colourName(i), plot);
    out << "\\end{axis}\\end{tikzpicture}\n\n";
}

void writeLatex(std::ostream &out, const Surface &s) {
    out << "\\begin{tikzpicture}\\begin{axis}[view={-30}{40}, title={" << latexText(s.title) << "}, xlabel={"
        << latexText(s.xAxis) << "}, ylabel={" << latexText(s.yAxis) << "}, zlabel={" << latexText(s.zAxis)
        << "}]\n\\addplot3[surf, mesh/cols=" << s.x.size() << "] coordinates {";
    for (std::size_t i = 0; i < s.z.size(); ++i)
        out << (i % s.x.size() ? ' ' : '\n') << '(' << Number(s.x[i % s.x.size()]) << ','
            << Number(s.y[i / s.x.size()]) << ',' << Number(s.z[i]) << ')';
    out << "};\n\\end{axis}\\end{tikzpicture}\n\n";
}

void writeRow(std::ostream &out, const std::vector<std::string> &cells) {
    for (std::size_t i = 0; i < cells.size(); ++i)
        out << (i ? " & " : "") << cells[i];
    out << " \\\\\n";
}

void writeLatex(std::ostream &out, const Table &table) {
    out << "\\subsection*{" << table.title << "}\n\\begin{tabular}{l"
        << std::string(table.header.size() - 1, 'r') << "}\n\\hline\n";
    writeRow(out, table.header);
    out << "\\hline\n";
    for (const auto &row : table.rows)
        writeRow(out, row);
    out << "\\hline\n\\end{tabular}\n\n";
}

} // namespace

void writeGnuplot(std::ostream &out, const Plot &plot) {
    out << "set terminal svg size " << (plot.isDrawing ? "900,720" : "720,460")
        << " font 'sans-serif,13' background '#ffffff'\n"
        << "set title '" << plot.title << "'\nset xlabel '" << plot.xAxis << "'\nset ylabel '" << plot.yAxis
        << "'\n"
        << "set grid lc rgb '#dddddd'\nset key outside right top\n"
        << (plot.xLogarithmic ? "set logscale x\n" : "") << (plot.yLogarithmic ? "set logscale y\n" : "")
        << (plot.isDrawing ? "set size ratio -1\n" : "") << "plot";
    for (const Curve &curve : plot.curves)
        if (!outlineOf(curve, plot).empty())
            out << " '-' using 1:2 with filledcurves closed fs transparent solid 0.25 noborder lc rgb '"
                << curve.colour << "' notitle,";
    for (std::size_t i = 0; i < plot.curves.size(); ++i)
        out << (i ? "," : "") << " '-' using 1:2 with "
            << (plot.isDrawing ? "lines lw 1.5" : "linespoints pt 7 ps 0.5 lw 2") << " lc rgb '"
            << plot.curves[i].colour << "' title '" << plot.curves[i].label << "'";
    out << '\n';
    for (const Curve &curve : plot.curves)
        if (const auto outline = outlineOf(curve, plot); !outline.empty()) {
            for (const auto &point : outline)
                out << Number(point.first) << ' ' << Number(point.second) << '\n';
            out << "e\n";
        }
    for (const Curve &curve : plot.curves) {
        for (const auto &point : curve.points) {
            const Place place = placeOf(plot, point);
            if (place == Place::Shown)
                out << Number(point.first) << ' ' << Number(point.second) << '\n';
            else if (place == Place::Break)
                out << '\n';
        }
        out << "e\n";
    }
}

void writeGnuplot(std::ostream &out, const Surface &s) {
    out << "set terminal svg size 720,560 font 'sans-serif,13' background '#ffffff'\n"
        << "set title '" << s.title << "'\nset xlabel '" << s.xAxis << "'\nset ylabel '" << s.yAxis
        << "'\nset zlabel '" << s.zAxis << "' norotate offset 6,7\n"
        << "set view 55,330\nset hidden3d\nset ticslevel 0\nunset key\n"
        << "splot '-' using 1:2:3 with lines lc rgb '#0072b2'\n";
    for (std::size_t i = 0; i < s.z.size(); ++i)
        out << (i && i % s.x.size() == 0 ? "\n" : "") << Number(s.x[i % s.x.size()]) << ' '
            << Number(s.y[i / s.x.size()]) << ' ' << Number(s.z[i]) << '\n';
    out << "e\n";
}

void writeLatex(std::ostream &out, const std::string &title, const Figures &figures) {
    out << "\\documentclass{article}\n\\usepackage{pgfplots}\n\\pgfplotsset{compat=1.16}\n\\begin{document}\n"
        << "\\section*{" << latexText(title) << "}\n";
    for (const Table &table : figures.tables)
        writeLatex(out, table);
    for (const Plot &plot : figures.plots)
        writeLatex(out, plot);
    for (const Surface &surface : figures.surfaces)
        writeLatex(out, surface);
    for (const SpacePlot &space : figures.spaces)
        writeLatex(out, space);
    out << "\\end{document}\n";
}

} // namespace hermes::vector
