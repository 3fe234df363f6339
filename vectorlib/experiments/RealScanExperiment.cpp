#include "vectorlib/experiments/RealScanExperiment.h"

#include "vectorlib/experiments/Algorithms.h"
#include "vectorlib/experiments/FewestLines.h"
#include "vectorlib/experiments/Timing.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace hermes::experiments {

namespace {

using vectorlib::Fixed;
using vectorlib::Number;

std::size_t countLines(const Algorithm &algorithm, const RealScan &scan) {
    std::size_t lines = 0;
    for (const auto &cluster : scan.clusters)
        for (const vectorlib::VectorizedLine &line : algorithm.run(cluster))
            lines += line.segment.isFinite();
    return lines;
}

std::string withPercent(const std::string &value, double percent) {
    std::ostringstream text;
    text << value << (percent < 0 ? " ($-$" : " (+") << Fixed{std::abs(percent), 0} << " \\%)";
    return text.str();
}

} // namespace

RealScanResult realScanExperiment(const RealScan &scan) {
    RealScanResult result;
    result.scan = scan;
    for (const auto &cluster : scan.clusters)
        result.linesReference += fewestLines(vectorlib::PointSpan<float>(cluster), realScanSigma);
    std::vector<Algorithm> algorithms = comparedAlgorithms(realScanSigma, true);
    std::stable_partition(algorithms.begin(), algorithms.end(),
                          [](const Algorithm &a) { return a.name == "ftls"; });
    for (const Algorithm &algorithm : algorithms) {
        const double us = timeOf([&] {
            for (const auto &cluster : scan.clusters)
                algorithm.run(cluster);
        });
        result.rows.push_back({algorithm.label, countLines(algorithm, scan), us});
    }
    return result;
}

void writeCsv(std::ostream &out, const RealScanResult &result) {
    out << "scan,points,clusters,lines_reference,algorithm,lines,lines_percent,time_us,time_percent\n";
    for (const RealScanResult::Row &row : result.rows)
        out << result.scan.number << ',' << result.scan.points() << ',' << result.scan.clusters.size() << ','
            << result.linesReference << ',' << row.algorithm << ',' << row.lines << ','
            << Number(result.linesPercent(row)) << ',' << Number(row.microseconds) << ','
            << Number(result.timePercent(row)) << '\n';
}

vectorlib::SvgPicture pictureOf(const std::string &title, const RealScanResult &result) {
    const RealScan &scan = result.scan;
    vectorlib::SvgPicture picture(title + ": scan " + std::to_string(scan.number) + ", " +
                                  std::to_string(scan.points()) + " points, " +
                                  std::to_string(scan.segments.size()) + " lines of FTLS");
    for (std::size_t c = 0; c < scan.clusters.size(); ++c)
        picture.points({vectorlib::colour::points, 3, c == 0 ? "points" : ""}, scan.clusters[c]);
    picture.segments({vectorlib::colour::distinct(0), 2, "FTLS"}, scan.segments);
    return picture;
}

Table tableOf(const std::string &title, const RealScanResult &result) {
    Table table{title, {"Point cloud statistics", ""}, {}};
    table.rows = {{"Points", std::to_string(result.scan.points())},
                  {"Lines (fewest within sigma)", std::to_string(result.linesReference)},
                  {"\\hline Extracted lines", ""}};
    for (const RealScanResult::Row &row : result.rows)
        table.rows.push_back(
            {row.algorithm, withPercent(std::to_string(row.lines), result.linesPercent(row))});
    table.rows.push_back({"\\hline Processing time [$\\mu$s]", ""});
    for (const RealScanResult::Row &row : result.rows) {
        std::ostringstream time;
        time << vectorlib::Fixed{row.microseconds, 1};
        table.rows.push_back({row.algorithm, withPercent(time.str(), result.timePercent(row))});
    }
    return table;
}

} // namespace hermes::experiments
