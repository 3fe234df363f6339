#include "vectorlib/io/LatexPlot.h"

#include <algorithm>
#include <array>

namespace vectorlib {

VECTORLIB_BODY void latex::writeCoordinates(std::ostream &out, const Plot &plot,
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

VECTORLIB_BODY std::vector<std::pair<double, double>>
latex::thinned(const std::vector<std::pair<double, double>> &points) {
    constexpr std::size_t most = 1200, parts = 400;
    if (points.size() <= most)
        return points;
    std::vector<std::pair<double, double>> kept;
    for (std::size_t part = 0; part < parts; ++part) {
        const std::size_t begin = part * points.size() / parts, end = (part + 1) * points.size() / parts;
        std::size_t low = end, high = end, gap = end;
        for (std::size_t i = begin; i < end; ++i) {
            if (!std::isfinite(points[i].first + points[i].second)) {
                gap = i;
                continue;
            }
            low = low == end || points[i].second < points[low].second ? i : low;
            high = high == end || points[i].second > points[high].second ? i : high;
        }
        std::array<std::size_t, 3> of{low, high, gap};
        std::sort(of.begin(), of.end());
        for (std::size_t i = 0; i < of.size(); ++i)
            if (of[i] != end && (i == 0 || of[i] != of[i - 1]))
                kept.push_back(points[of[i]]);
    }
    return kept;
}

VECTORLIB_BODY std::optional<Picture::Box> latex::boxOf(const Plot &plot) {
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

VECTORLIB_BODY std::string latex::ticksOf(char axis, double low, double high) {
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

VECTORLIB_BODY void latex::writeCurve(std::ostream &out, const Plot &plot, const Curve &curve) {
    for (const auto &outline : outlinesOf(curve, plot)) {
        out << "\\addplot[draw=none, fill=" << colour(curve.colour) << ", fill opacity=0.25, forget plot]";
        writeCoordinates(out, plot, outline);
        out << "--cycle;\n";
    }
    out << "\\addplot[color=" << colour(curve.colour)
        << (plot.isDrawing ? ", line width=0.6pt" : ", mark=*, mark size=1pt, thick")
        << (curve.label.empty() ? ", forget plot]" : "]");
    writeCoordinates(out, plot, plot.isDrawing ? curve.points : thinned(curve.points));
    out << ";\n";
    if (!curve.label.empty())
        out << "\\addlegendentry{" << latexText(curve.label) << "}\n";
}

VECTORLIB_BODY void writeLatex(std::ostream &out, const Plot &plot) {
    const std::optional<Picture::Box> box = latex::boxOf(plot);
    if (!box) {
        out << latexText(plot.title) << ": nothing to show.";
        return;
    }
    latex::openAxis(
        out, plot,
        std::string(plot.isDrawing ? "width=14cm, height=14cm, axis equal image, "
                                   : "width=14cm, height=9cm, ") +
            (plot.xLogarithmic ? "xmode=log, " + latex::ticksOf('x', box->low.x, box->high.x) : "") +
            (plot.yLogarithmic ? "ymode=log, " + latex::ticksOf('y', box->low.y, box->high.y) : ""));
    for (const Curve &curve : plot.curves)
        latex::writeCurve(out, plot, curve);
    out << "\\end{axis}\n\\end{tikzpicture}";
}

VECTORLIB_BODY void writeLatex(std::ostream &out, const Surface &s) {
    if (s.x.size() < 2 || s.y.size() < 2 || s.z.size() != s.x.size() * s.y.size()) {
        out << latexText(s.title) << ": nothing to show.";
        return;
    }
    latex::openAxis(out, s, "width=13cm, height=10cm, view={-30}{40}, zlabel={" + latexText(s.zAxis) + "}, ");
    out << "\\addplot3[surf, mesh/cols=" << s.x.size() << "] coordinates {";
    const auto write = [&out](double value) {
        if (std::abs(value) < 1e300)
            out << Number(value);
        else
            out << "nan";
    };
    for (std::size_t i = 0; i < s.z.size(); ++i) {
        out << (i % s.x.size() ? ' ' : '\n') << '(';
        write(s.x[i % s.x.size()]);
        out << ',';
        write(s.y[i / s.x.size()]);
        out << ',';
        write(s.z[i]);
        out << ')';
    }
    out << "};\n\\end{axis}\n\\end{tikzpicture}";
}

VECTORLIB_BODY void writeLatex(std::ostream &out, const SpacePlot &plot) {
    const auto isPlace = [](const std::array<double, 3> &p) {
        return std::abs(p[0]) < 1e300 && std::abs(p[1]) < 1e300 && std::abs(p[2]) < 1e300;
    };
    const bool any = std::any_of(plot.curves.begin(), plot.curves.end(), [&](const SpaceCurve &c) {
        return std::any_of(c.points.begin(), c.points.end(), isPlace);
    });
    if (!any) {
        out << latexText(plot.title) << ": nothing to show.";
        return;
    }
    latex::openAxis(out, plot,
                    "width=14cm, height=11cm, view={35}{28}, zlabel={" + latexText(plot.zAxis) + "}, ");
    for (const SpaceCurve &curve : plot.curves) {
        out << "\\addplot3[color=" << latex::colour(curve.colour) << ", thick, no marks"
            << (curve.label.empty() ? ", forget plot]" : "]") << " coordinates {";
        for (std::size_t i = 0; i < curve.points.size(); ++i) {
            const auto &p = curve.points[i];
            if (isPlace(p))
                out << (i % 8 ? ' ' : '\n') << '(' << Number(p[0]) << ',' << Number(p[1]) << ','
                    << Number(p[2]) << ')';
            else
                out << "\n(nan,nan,nan)";
        }
        out << "};\n";
        if (!curve.label.empty())
            out << "\\addlegendentry{" << latexText(curve.label) << "}\n";
    }
    out << "\\end{axis}\n\\end{tikzpicture}";
}

} // namespace vectorlib
