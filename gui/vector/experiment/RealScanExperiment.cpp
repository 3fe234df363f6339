#include "gui/vector/experiment/RealScanExperiment.h"

#include "gui/vector/experiment/Algorithms.h"
#include "gui/vector/experiment/QualityScan.h"
#include "gui/vector/experiment/Timing.h"
#include "gui/vector/report/Drawing.h"
#include "vectorlib/io/Svg.h"

#include <algorithm>
#include <cmath>

namespace hermes::vector {

namespace {

using vectorlib::Number;
using Segments = std::vector<vectorlib::LineSegment2D<double>>;

constexpr double scanSigma = 0.02; // metres, as in thesis 6.5.2
constexpr std::size_t fewestPoints = 10;

Segments vectorize(const Algorithm &algorithm, const QualityScan &scan) {
    Segments segments;
    for (const QualityCluster &cluster : scan)
        for (const vectorlib::VectorizedLine &line : algorithm.run(cluster.points))
            if (line.segment.isFinite())
                segments.push_back(line.segment);
    return segments;
}

// How much a scan is what is looked for. The mean of the directions' doubled angles, by length, is near 1
// when all lines are parallel.
double score(const Segments &segments, RealScanKind kind) {
    double length = 0, x = 0, y = 0;
    for (const auto &s : segments) {
        const vectorlib::Vector2D<double> d = s.direction();
        length += s.length();
        x += s.length() * (d.x * d.x - d.y * d.y);
        y += s.length() * 2 * d.x * d.y;
    }
    const double lines = static_cast<double>(segments.size());
    if (kind == RealScanKind::Laboratory)
        return lines;
    const double parallel = length > 0 ? std::hypot(x, y) / length : 0;
    return length / std::max(lines, 1.0) * (kind == RealScanKind::Corridor ? parallel : 1 - parallel);
}

} // namespace

RealScanResult realScanExperiment(const std::vector<vectorlib::CarmenScan> &scans, RealScanKind kind) {
    const std::vector<Algorithm> algorithms = comparedAlgorithms(scanSigma, true);
    const auto ftls = std::find_if(algorithms.begin(), algorithms.end(),
                                   [](const Algorithm &a) { return a.name == "ftls"; });
    RealScanResult result;
    QualityScan chosen;
    double best = -1;
    for (std::size_t i = 0; i < scans.size(); ++i) {
        QualityScan scan = logScan(scans[i]);
        std::size_t points = 0;
        for (const QualityCluster &cluster : scan)
            points += cluster.points.size();
        if (points < std::max(fewestPoints, scans[i].ranges.size() / 2)) // too little of a room
            continue;
        Segments segments = vectorize(*ftls, scan);
        if (const double s = score(segments, kind); s > best) {
            best = s;
            result.scan = i;
            result.points = points;
            result.segments = std::move(segments);
            chosen = std::move(scan);
        }
    }
    result.clusters = chosen.size();
    for (const QualityCluster &cluster : chosen)
        result.clouds.push_back(cluster.points);
    for (const Algorithm &algorithm : algorithms) {
        const double us = timeOf([&] {
            for (const QualityCluster &cluster : chosen)
                algorithm.run(cluster.points);
        });
        result.rows.push_back({algorithm.label, vectorize(algorithm, chosen).size(), us});
    }
    return result;
}

void writeCsv(std::ostream &out, const RealScanResult &result) {
    out << "scan,points,clusters,algorithm,lines,time_us\n";
    for (const RealScanResult::Row &row : result.rows)
        out << result.scan << ',' << result.points << ',' << result.clusters << ',' << row.algorithm << ','
            << row.lines << ',' << Number(row.microseconds) << '\n';
}

void draw(std::ostream &svg, const std::string &title, const RealScanResult &result) {
    vectorlib::SvgPicture picture(title + ": scan " + std::to_string(result.scan) + ", " +
                                  std::to_string(result.points) + " points, " +
                                  std::to_string(result.segments.size()) + " lines of FTLS");
    for (std::size_t c = 0; c < result.clouds.size(); ++c)
        picture.points({vectorlib::colour::points, 3, c == 0 ? "points" : ""}, result.clouds[c]);
    std::vector<vectorlib::LineSegment2D<float>> segments(result.segments.begin(), result.segments.end());
    picture.segments({vectorlib::colour::distinct(0), 2, "FTLS"}, segments);
    picture.write(svg);
}

void writeLatex(std::ostream &out, const std::string &title, const RealScanResult &result) {
    double reach = 1;
    for (const auto &cloud : result.clouds)
        for (const auto &p : cloud)
            reach = std::max({reach, std::abs(double(p.x)), std::abs(double(p.y))});
    out << "\\documentclass{article}\n\\usepackage{tikz}\n\\begin{document}\n\\section*{" << latexText(title)
        << "}\nScan " << result.scan << ": " << result.points << " points in " << result.clusters
        << " clusters.\n\n\\begin{tikzpicture}[scale=" << Number(6 / reach) << "]\n";
    for (const auto &cloud : result.clouds)
        for (const auto &p : cloud)
            out << "\\fill[gray] (" << Number(p.x) << ',' << Number(p.y) << ") circle[radius=0.6pt];\n";
    for (const auto &s : result.segments)
        out << "\\draw[thick] (" << Number(s.begin().x) << ',' << Number(s.begin().y) << ") -- ("
            << Number(s.end().x) << ',' << Number(s.end().y) << ");\n";
    out << "\\end{tikzpicture}\n\n\\begin{tabular}{lrr}\nalgorithm & lines & time [us] \\\\ \\hline\n";
    for (const RealScanResult::Row &row : result.rows)
        out << latexText(row.algorithm) << " & " << row.lines << " & " << Number(row.microseconds)
            << " \\\\\n";
    out << "\\end{tabular}\n\\end{document}\n";
}

} // namespace hermes::vector
