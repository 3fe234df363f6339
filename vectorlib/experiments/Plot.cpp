#include "vectorlib/experiments/Plot.h"

#include "vectorlib/io/Number.h"

namespace hermes::experiments {

using vectorlib::Number;
using Place = vectorlib::PlotPlace;

namespace {

void writePoint(std::ostream &out, const std::array<double, 3> &p) {
    out << Number(p[0]) << ' ' << Number(p[1]) << ' ' << Number(p[2]);
}

// A string of gnuplot: nothing in it ends it, or is a command.
std::string quoted(const std::string &text) {
    std::string out = "'";
    for (const char c : text) {
        out += c == '\n' || c == '\r' ? ' ' : c;
        if (c == '\'')
            out += c;
    }
    return out + "'";
}

bool isBreak(const std::array<double, 3> &p) {
    return !std::isfinite(p[0] + p[1] + p[2]);
}

} // namespace

void writeGnuplot(std::ostream &out, const Plot &plot) {
    out << "set terminal svg size "
        << "" << (plot.isDrawing ? "900,720" : "720,460") << " font 'sans-serif,13' background '#ffffff'\n"
        << "set title " << quoted(plot.title) << "\nset xlabel " << quoted(plot.xAxis) << "\nset ylabel "
        << quoted(plot.yAxis) << "\nset grid lc rgb '#dddddd'\nset key outside right top\n"
        << (plot.xLogarithmic ? "set logscale x\n" : "") << (plot.yLogarithmic ? "set logscale y\n" : "")
        << (plot.isDrawing ? "set size ratio -1\n" : "") << "plot";
    for (const Curve &curve : plot.curves)
        for (std::size_t i = 0; i < outlinesOf(curve, plot).size(); ++i)
            out << " '-' using 1:2 with filledcurves closed fs transparent solid 0.25 noborder lc rgb '"
                << curve.colour << "' notitle,";
    for (std::size_t i = 0; i < plot.curves.size(); ++i)
        out << (i ? "," : "") << " '-' using 1:2 with "
            << (plot.isDrawing ? "lines lw 1.5" : "linespoints pt 7 ps 0.5 lw 2") << " lc rgb '"
            << plot.curves[i].colour << "' title " << quoted(plot.curves[i].label);
    out << '\n';
    for (const Curve &curve : plot.curves)
        for (const auto &outline : outlinesOf(curve, plot)) {
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
        << "set title " << quoted(s.title) << "\nset xlabel " << quoted(s.xAxis) << "\nset ylabel "
        << quoted(s.yAxis) << "\nset zlabel " << quoted(s.zAxis) << " norotate offset 6,7\n"
        << "set view 55,330\nset hidden3d\nset ticslevel 0\nunset key\n"
        << "splot '-' using 1:2:3 with lines lc rgb '#0072b2'\n";
    for (std::size_t i = 0; i < s.z.size(); ++i)
        out << (i && i % s.x.size() == 0 ? "\n" : "") << Number(s.x[i % s.x.size()]) << ' '
            << Number(s.y[i / s.x.size()]) << ' ' << Number(s.z[i]) << '\n';
    out << "e\n";
}

void writeGnuplot(std::ostream &out, const SpacePlot &plot) {
    out << "set terminal svg size 900,640 font 'sans-serif,13' background '#ffffff'\n"
        << "set title " << quoted(plot.title) << "\nset xlabel " << quoted(plot.xAxis)
        << " offset 0,-1\nset ylabel " << quoted(plot.yAxis) << " offset 0,-1\nset zlabel "
        << quoted(plot.zAxis) << " rotate parallel\n"
        << "set view 62,35\nset ticslevel 0\nset grid x y z lc rgb '#dddddd'\nset key outside right "
           "top\nsplot";
    for (std::size_t i = 0; i < plot.curves.size(); ++i)
        out << (i ? "," : "") << " '-' using 1:2:3 with lines lw 2 lc rgb '" << plot.curves[i].colour
            << "' title " << quoted(plot.curves[i].label);
    out << '\n';
    for (const SpaceCurve &curve : plot.curves) {
        for (const auto &point : curve.points) {
            if (isBreak(point)) {
                out << "\n\n"; // one empty line alone would make a net of the lines
                continue;
            }
            writePoint(out, point);
            out << '\n';
        }
        out << "e\n";
    }
}

} // namespace hermes::experiments
