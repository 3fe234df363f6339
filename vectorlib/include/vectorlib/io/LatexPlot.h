#pragma once

#include "vectorlib/io/LatexPicture.h"
#include "vectorlib/io/Plot.h"

namespace vectorlib {

namespace latex {

inline void writeCoordinates(std::ostream &out, const Plot &plot,
                             const std::vector<std::pair<double, double>> &points) {
    out << " coordinates {";
    for (std::size_t i = 0; i < points.size(); ++i) {
        const PlotPlace place = placeOf(plot, points[i]);
        if (place == PlotPlace::Shown)
            out << (i % 8 ? ' ' : '\n') << '(' << Number(points[i].first) << ',' << Number(points[i].second)
                << ')';
        else if (place == PlotPlace::Break)
            out << "\n(nan,nan)"; // interrupts: unbounded coords=jump
    }
    out << '}';
}

/// One in space; what is not finite interrupts: unbounded coords=jump.
inline void writePoint(std::ostream &out, const std::array<double, 3> &point) {
    for (std::size_t i = 0; i < 3; ++i) {
        out << (i ? ',' : '(');
        if (std::abs(point[i]) < 1e300)
            out << Number(point[i]);
        else
            out << "nan";
    }
    out << ')';
}

constexpr const char *legendBelow =
    "legend columns=2, legend cell align=left,\n  legend style={at={(0.5,-0.18)}, anchor=north, draw=none, "
    "font=\\small, /tikz/every even column/.append style={column sep=1em}}";

inline bool hasPoints(const Plot &plot) {
    for (const Curve &curve : plot.curves)
        for (const auto &point : curve.points)
            if (placeOf(plot, point) == PlotPlace::Shown)
                return true;
    return false;
}

inline void writeCurve(std::ostream &out, const Plot &plot, const Curve &curve) {
    for (const auto &outline : outlinesOf(curve, plot)) {
        out << "\\addplot[draw=none, fill=" << colour(curve.colour) << ", fill opacity=0.25, forget plot]";
        writeCoordinates(out, plot, outline);
        out << "--cycle;\n";
    }
    out << "\\addplot[color=" << colour(curve.colour)
        << (plot.isDrawing ? ", line width=0.6pt" : ", mark=*, mark size=1pt, thick")
        << (curve.label.empty() ? ", forget plot]" : "]");
    writeCoordinates(out, plot, curve.points);
    out << ";\n";
    if (!curve.label.empty())
        out << "\\addlegendentry{" << latexText(curve.label) << "}\n";
}

} // namespace latex

/// A plot as a tikzpicture of pgfplots, its legend below; one without a point to show says so.
inline void writeLatex(std::ostream &out, const Plot &plot) {
    if (!latex::hasPoints(plot)) {
        out << latexText(plot.title) << ": nothing to show.";
        return;
    }
    out << "\\begin{tikzpicture}\n\\begin{axis}[width=14cm, height=" << (plot.isDrawing ? 14 : 9) << "cm, "
        << (plot.xLogarithmic ? "xmode=log, " : "") << (plot.yLogarithmic ? "ymode=log, " : "")
        << (plot.isDrawing ? "axis equal image, " : "") << "unbounded coords=jump, grid=major,\n  title={"
        << latexText(plot.title) << "}, xlabel={" << latexText(plot.xAxis) << "}, ylabel={"
        << latexText(plot.yAxis) << "},\n  " << latex::legendBelow << "]\n";
    for (const Curve &curve : plot.curves)
        latex::writeCurve(out, plot, curve);
    out << "\\end{axis}\n\\end{tikzpicture}";
}

/// A surface as a tikzpicture of pgfplots; one without a grid, or with other values than its grid has, says
/// so.
inline void writeLatex(std::ostream &out, const Surface &s) {
    if (s.x.size() < 2 || s.y.size() < 2 || s.z.size() != s.x.size() * s.y.size()) {
        out << latexText(s.title) << ": nothing to show.";
        return;
    }
    out << "\\begin{tikzpicture}\n\\begin{axis}[width=13cm, height=10cm, view={-30}{40}, unbounded "
           "coords=jump, grid=major,\n  title={"
        << latexText(s.title) << "}, xlabel={" << latexText(s.xAxis) << "}, ylabel={" << latexText(s.yAxis)
        << "}, zlabel={" << latexText(s.zAxis) << "}]\n\\addplot3[surf, mesh/cols=" << s.x.size()
        << "] coordinates {";
    for (std::size_t i = 0; i < s.z.size(); ++i) {
        out << (i % s.x.size() ? ' ' : '\n');
        latex::writePoint(out, {s.x[i % s.x.size()], s.y[i / s.x.size()], s.z[i]});
    }
    out << "};\n\\end{axis}\n\\end{tikzpicture}";
}

/// Lines in space as a tikzpicture of pgfplots, its legend below; without a line it says so.
inline void writeLatex(std::ostream &out, const SpacePlot &plot) {
    if (plot.curves.empty()) {
        out << latexText(plot.title) << ": nothing to show.";
        return;
    }
    out << "\\begin{tikzpicture}\n\\begin{axis}[width=13cm, height=10cm, view={35}{28}, unbounded "
           "coords=jump, grid=major,\n  title={"
        << latexText(plot.title) << "}, xlabel={" << latexText(plot.xAxis) << "}, ylabel={"
        << latexText(plot.yAxis) << "}, zlabel={" << latexText(plot.zAxis) << "},\n  " << latex::legendBelow
        << "]\n";
    for (const SpaceCurve &curve : plot.curves) {
        out << "\\addplot3[color=" << latex::colour(curve.colour) << ", thick, no marks"
            << (curve.label.empty() ? ", forget plot" : "") << "] coordinates {";
        for (const auto &point : curve.points) {
            out << '\n';
            latex::writePoint(out, point);
        }
        out << "};\n";
        if (!curve.label.empty())
            out << "\\addlegendentry{" << latexText(curve.label) << "}\n";
    }
    out << "\\end{axis}\n\\end{tikzpicture}";
}

} // namespace vectorlib
