#include "vectorlib/experiments/RealScan.h"

#include "vectorlib/vectorization/FtlsVectorizer.h"

#include <algorithm>
#include <cmath>

namespace hermes::experiments {

namespace {

constexpr std::size_t fewestPoints = 10;

// How much a scan is what is looked for. The mean of the directions' doubled angles, by length, is near 1
// when all lines are parallel.
double score(const RealScan &scan, RealScanKind kind) {
    double length = 0, x = 0, y = 0;
    for (const auto &s : scan.segments) {
        const vectorlib::Vector2D<double> d = s.direction();
        length += s.length();
        x += s.length() * (d.x * d.x - d.y * d.y);
        y += s.length() * 2 * d.x * d.y;
    }
    const double lines = static_cast<double>(scan.segments.size());
    if (kind == RealScanKind::Laboratory)
        return lines;
    const double parallel = length > 0 ? std::hypot(x, y) / length : 0;
    return length / std::max(lines, 1.0) * (kind == RealScanKind::Corridor ? parallel : 1 - parallel);
}

} // namespace

std::size_t RealScan::points() const {
    std::size_t count = 0;
    for (const auto &cluster : clusters)
        count += cluster.size();
    return count;
}

RealScanChoice::RealScanChoice(const std::vector<RealScanKind> &kinds) {
    for (const RealScanKind kind : kinds)
        best_.push_back({kind});
}

void RealScanChoice::take(std::size_t number, const vectorlib::TimedScan &scan) {
    segment_.settings = vectorlib::EarSettings::forScanner(scan.fieldOfView, scan.rays);
    const vectorlib::Segmentation &found = segment_(scan.points);
    RealScan taken;
    taken.number = number;
    taken.clusters.resize(found.size());
    for (std::size_t c = 0; c < found.size(); ++c)
        for (std::size_t p = found.starts[c]; p < found.starts[c + 1]; ++p)
            taken.clusters[c].push_back(scan.points[static_cast<std::size_t>(found.order[p])]);
    if (taken.points() < fewestPoints)
        return;
    for (std::size_t i = 0; i < scan.points.size(); ++i)
        if (found.labels[i] < 0)
            taken.outliers.push_back(scan.points[i]);
    vectorlib::FtlsVectorizer<float> vectorize;
    vectorize.settings = {realScanSigma, 5 * realScanSigma, true};
    for (const auto &cluster : taken.clusters)
        for (const vectorlib::VectorizedLine &line : vectorize(cluster))
            if (line.segment.isFinite())
                taken.segments.push_back(line.segment);
    const bool isFull = taken.points() >= scan.rays / 2; // not too little of a room
    for (Best &best : best_)
        if (const double s = score(taken, best.kind); isFull != best.isFull ? isFull : s > best.score) {
            best = {best.kind, isFull, s, taken};
        }
}

vectorlib::SvgPicture pictureOfClusters(const std::string &title, const RealScan &scan) {
    vectorlib::SvgPicture picture(title + ": scan " + std::to_string(scan.number) + ", " +
                                  std::to_string(scan.points()) + " points in " +
                                  std::to_string(scan.clusters.size()) + " clusters");
    for (std::size_t c = 0; c < scan.clusters.size(); ++c)
        picture.points({vectorlib::colour::distinct(c), 4, c == 0 ? "clusters" : ""}, scan.clusters[c]);
    picture.points({"#000000", 3, std::to_string(scan.outliers.size()) + " outliers"}, scan.outliers);
    picture.pose({vectorlib::colour::map, 2, "sensor"}, {}, 0);
    return picture;
}

} // namespace hermes::experiments
