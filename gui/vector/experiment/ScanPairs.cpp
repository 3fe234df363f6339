#include "gui/vector/experiment/ScanPairs.h"

#include "gui/vector/experiment/RangeFit.h"

#include <algorithm>
#include <cmath>

namespace hermes::vector {

using Point = vectorlib::Vector2D<double>;
using Segment = vectorlib::LineSegment2D<double>;

namespace {

constexpr std::size_t fewest = 3; // two points fit any line

Segment lineThrough(const std::vector<Point> &points) {
    const vectorlib::TlsSums sums = vectorlib::TlsSums::of(points.begin(), points.end());
    return vectorlib::makeLine(vectorlib::PointSpan<double>(points), 0, points.size() - 1, sums).segment;
}

} // namespace

const std::vector<vectorlib::SegmentPair> &ScanPairs::operator()(const KnownScan &scan, double minLength,
                                                                 std::mt19937_64 &random) {
    pairs_.clear();
    minLength_ = minLength;
    measure(scan, random);
    if (pairing_ == Pairing::Extracted || pairing_ == Pairing::ExtractedClean)
        takeLines(scan);
    else
        takeRuns(scan);
    return pairs_;
}

void ScanPairs::measure(const KnownScan &scan, std::mt19937_64 &random) {
    points_.clear();
    for (const KnownScan::Ray &ray : scan.rays()) {
        const double error = noise_ * normal_(random);
        if (pairing_ == Pairing::AcrossEdges) {
            const Point normal = scan.edges()[ray.edge].normal();
            points_.push_back(ray.direction * ray.range + normal * (error * ray.direction.dot(normal)));
        } else {
            points_.push_back(ray.direction * (ray.range + error));
        }
    }
}

void ScanPairs::takeRuns(const KnownScan &scan) {
    const std::vector<KnownScan::Ray> &rays = scan.rays();
    for (std::size_t begin = 0, end = 0; begin < rays.size(); begin = end) {
        while (end < rays.size() && rays[end].edge == rays[begin].edge)
            ++end;
        if (end - begin < fewest)
            continue;
        own_.assign(points_.begin() + std::ptrdiff_t(begin), points_.begin() + std::ptrdiff_t(end));
        const Segment line = lineThrough(own_);
        add(scan, rays[begin].edge, pairing_ == Pairing::FittedRanges ? fitRanges(own_, line) : line);
    }
}

void ScanPairs::takeLines(const KnownScan &scan) {
    // The lower bound is the sensor's accuracy (thesis 5.2); sigma as twice the noise of thesis 6.5.
    segment_.settings = vectorlib::EarSettings::forScanner(2 * vectorlib::pi, scan.rays().size());
    segment_.settings.minThreshold = std::max(segment_.settings.minThreshold, 3 * noise_);
    segment_.settings.maxThreshold = std::max(segment_.settings.maxThreshold, 3 * noise_);
    vectorize_.settings.sigma = 2 * noise_;
    vectorize_.settings.delta = 5 * vectorize_.settings.sigma;
    const vectorlib::Segmentation &clusters = segment_(points_);
    for (std::size_t c = 0; c < clusters.size(); ++c) {
        cluster_.clear();
        edgesOfCluster_.clear();
        for (std::size_t i = clusters.starts[c]; i < clusters.starts[c + 1]; ++i) {
            const auto point = std::size_t(clusters.order[i]);
            cluster_.push_back(points_[point]);
            edgesOfCluster_.push_back(scan.rays()[point].edge);
        }
        for (const vectorlib::VectorizedLine &line : vectorize_(cluster_))
            takeLine(scan, line);
    }
}

void ScanPairs::takeLine(const KnownScan &scan, const vectorlib::VectorizedLine &line) {
    if (!line.line.isValid() || line.last - line.first + 1 < fewest)
        return;
    counts_.assign(scan.edges().size(), 0);
    for (std::size_t i = line.first; i <= line.last; ++i)
        ++counts_[edgesOfCluster_[i]];
    const auto most = std::max_element(counts_.begin(), counts_.end());
    const auto edge = std::size_t(most - counts_.begin());
    if (pairing_ == Pairing::Extracted) {
        add(scan, edge, line.segment);
        return;
    }
    own_.clear();
    for (std::size_t i = line.first; i <= line.last; ++i)
        if (edgesOfCluster_[i] == edge)
            own_.push_back(cluster_[i]);
    if (own_.size() >= fewest)
        add(scan, edge, lineThrough(own_));
}

void ScanPairs::add(const KnownScan &scan, std::size_t edge, const Segment &seen) {
    const Segment &fixed = scan.edges()[edge];
    const bool isFacing =
        seen.direction().dot(fixed.direction()) > 0; // few noisy points may turn a line about
    if (isFacing && seen.length() >= minLength_)
        pairs_.push_back({fixed, seen, std::min(fixed.length(), seen.length())});
}

} // namespace hermes::vector
