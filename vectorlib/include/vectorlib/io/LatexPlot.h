#pragma once

#include "vectorlib/io/LatexPicture.h"
#include "vectorlib/io/Plot.h"

#include <optional>

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

/// The box of all points that a plot shows; nothing when there is none.
inline std::optional<Picture::Box> boxOf(const Plot &plot) {
    std::optional<Picture::Box> box;
    for (const Curve &curve : plot.curves)
        for (const auto &point : curve.points)
            if (placeOf(plot, point) == PlotPlace::Shown) {
                const Picture::Point p(point.first, point.second);
                if (!box)
                    box = Picture::Box{p, p};
                box->low = {std::min(box->low.x, p.x), std::min(box->low.y, p.y)};
                box->high = {std::max(box->high.x, p.x), std::max(box->high.y, p.y)};
            }
    return box;
}

/// Of a logarithmic axis over less than three powers of ten the places 1, 2 and 5: pgfplots would write
/// powers with fractions there. Nothing where pgfplots finds better ones.
inline std::string ticksOf(char axis, double low, double high) {
    const int first = static_cast<int>(std::floor(std::log10(low))),
              last = static_cast<int>(std::ceil(std::log10(high)));
    if (first < -4 || last > 6 || high > 1000 * low)
        return "";
    std::ostringstream places, labels;
    int count = 0;
    for (int power = first; power <= last; ++power)
        for (const int digit : {1, 2, 5}) {
            const double place = rounded(digit * std::pow(10.0, power), 6);
            if (place < low * 0.999 || place > high * 1.001)
                continue;
            places << (count ? "," : "") << Number(place);
            labels << (count++ ? "," : "") << '$' << Fixed{place, std::max(0, -power)} << '$';
        }
    return count < 2 ? ""
                     : std::string(1, axis) + "tick={" + places.str() + "}, " + axis + "ticklabels={" +
                           labels.str() + "}, ";
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
    const std::optional<Picture::Box> box = latex::boxOf(plot);
    if (!box) {
        out << latexText(plot.title) << ": nothing to show.";
        return;
    }
    out << "\\begin{tikzpicture}\n\\begin{axis}[width=14cm, height=" << (plot.isDrawing ? 14 : 9) << "cm, "
        << (plot.xLogarithmic ? "xmode=log, " + latex::ticksOf('x', box->low.x, box->high.x) : "")
        << (plot.yLogarithmic ? "ymode=log, " + latex::ticksOf('y', box->low.y, box->high.y) : "")
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
