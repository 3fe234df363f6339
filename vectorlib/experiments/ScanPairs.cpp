#include "vectorlib/experiments/ScanPairs.h"

#include "vectorlib/experiments/RangeFit.h"

#include <algorithm>

namespace hermes::experiments {

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
    const bool isKnown = pairing_ == Pairing::KnownEdges || pairing_ == Pairing::AcrossEdges ||
                         pairing_ == Pairing::FittedRanges;
    isKnown ? takeRuns(scan) : takeLines(scan);
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
    constexpr std::size_t minPoints = 4;
    constexpr double minLength = 0.10; // metres
    // The lower bound is the sensor's accuracy (thesis 5.2).
    segment_.settings = vectorlib::EarSettings::forScanner(2 * vectorlib::pi, scan.nominalRays());
    segment_.settings.neighbours = vectorlib::EarSettings().neighbours;
    segment_.settings.minThreshold = std::max(segment_.settings.minThreshold, 5 * noise_);
    segment_.settings.maxThreshold = std::max(segment_.settings.maxThreshold, 5 * noise_);
    found_.clear();
    const vectorlib::Segmentation &clusters = segment_(points_);
    for (std::size_t c = 0; c < clusters.size(); ++c) {
        const int *order = clusters.order.data() + clusters.starts[c];
        const std::size_t count = clusters.size(c), first = found_.size();
        own_.clear();
        for (std::size_t i = 0; i < count; ++i)
            own_.push_back(points_[std::size_t(order[i])]);
        for (const vectorlib::VectorizedLine &line : vectorize(own_))
            if (line.line.isValid())
                find(scan, order, line);
        if ((std::size_t(order[count - 1]) + 1) % points_.size() == std::size_t(order[0]))
            joinEnds(first);
    }
    for (Found &found : found_) {
        if (found.points.size() < minPoints || found.segment.length() < minLength)
            continue;
        if (pairing_ == Pairing::ExtractedClean) {
            own_.clear();
            for (std::size_t i = 0; i < found.points.size(); ++i)
                if (found.edges[i] == found.edge)
                    own_.push_back(found.points[i]);
            if (own_.size() < minPoints)
                continue;
            found.segment = lineThrough(own_);
        }
        add(scan, found.edge, found.segment);
    }
}

const std::vector<vectorlib::VectorizedLine> &ScanPairs::vectorize(const Points &cluster) {
    vectorlib::VectorizerSettings settings;
    // Thesis 6.5: 2 cm at a noise of 1 cm.
    settings.sigma = (pairing_ == Pairing::ExtractedTight ? 1.2 : 2) * noise_;
    settings.delta = 5 * settings.sigma;
    ftls_.settings = aftls_.settings = settings;
    return pairing_ == Pairing::ExtractedFtls ? ftls_(cluster) : aftls_(cluster);
}

void ScanPairs::find(const KnownScan &scan, const int *order, const vectorlib::VectorizedLine &line) {
    Found found;
    counts_.assign(scan.edges().size(), 0);
    for (std::size_t i = line.first; i <= line.last; ++i) {
        const auto point = std::size_t(order[i]);
        found.points.push_back(points_[point]);
        found.edges.push_back(scan.rays()[point].edge);
        ++counts_[found.edges.back()];
    }
    found.edge = std::size_t(std::max_element(counts_.begin(), counts_.end()) - counts_.begin());
    found.segment = line.segment;
    found_.push_back(std::move(found));
}

// A cluster all around begins somewhere on an edge: its last line goes on in its first one.
void ScanPairs::joinEnds(std::size_t first) {
    if (found_.size() < first + 2 || found_[first].edge != found_.back().edge)
        return;
    Found &begin = found_[first], &end = found_.back();
    end.points.insert(end.points.end(), begin.points.begin(), begin.points.end());
    end.edges.insert(end.edges.end(), begin.edges.begin(), begin.edges.end());
    end.segment = lineThrough(end.points);
    found_.erase(found_.begin() + std::ptrdiff_t(first));
}

void ScanPairs::add(const KnownScan &scan, std::size_t edge, const Segment &seen) {
    const Segment &fixed = scan.edges()[edge];
    const bool isFacing =
        seen.direction().dot(fixed.direction()) > 0; // few noisy points may turn a line about
    if (isFacing && seen.length() >= minLength_)
        pairs_.push_back({fixed, seen, std::min(fixed.length(), seen.length())});
}

} // namespace hermes::experiments
