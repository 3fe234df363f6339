#pragma once

#include "vectorlib/experiments/KnownScan.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/segmentation/EarSegmenter.h"
#include "vectorlib/vectorization/AftlsVectorizer.h"

#include <random>
#include <vector>

namespace hermes::experiments {

/// How the segments of a scan come about; the ranges of all have Gaussian
/// noise.
enum class Pairing {
    Extracted,      ///< segmentation and AFTLS, as in paper 4; the edge is that of
                    ///< most of a line's points
    ExtractedTight, ///< the same, with 1.2 instead of 2 times the noise as the largest sigma of a line
    ExtractedFtls,  ///< the same with FTLS, which takes points of the next edge at
                    ///< every corner
    ExtractedClean, ///< AFTLS, each line fitted anew without its points of other
                    ///< edges
    KnownEdges,     ///< a line for each run of rays on one edge
    AcrossEdges,    ///< the same, with only the part of the noise that is across the
                    ///< edge
    FittedRanges    ///< the lines of KnownEdges, by least squares of the ranges
                    ///< instead of the distances
};

/// Makes pairs of segments from scans whose rays know their edges. Keeps its
/// buffers.
class ScanPairs {
public:
    /// `noise` is the standard deviation of the ranges in metres.
    ScanPairs(Pairing pairing, double noise)
        : pairing_(pairing)
        , noise_(noise) {}

    /// The segments of a scan with noise of its own, each with its edge as the
    /// static partner, in the frame of the true pose: a perfect registration is
    /// the identity. Lines of three points or more (extracted ones of four and 10
    /// cm, as those of EdgeExtractor), at least minLength long (metres). The
    /// weight is the length of the shorter of the two. Valid until the next call.
    const std::vector<vectorlib::SegmentPair> &operator()(const KnownScan &scan, double minLength,
                                                          std::mt19937_64 &random);

private:
    using Points = std::vector<vectorlib::Vector2D<double>>;
    /// Points that one line stands for, and what the vectorizer made of them.
    struct Found {
        Points points;
        std::vector<std::size_t> edges; ///< of each point
        vectorlib::LineSegment2D<double> segment;
        std::size_t edge = 0; ///< of most of the points
    };

    void measure(const KnownScan &scan, std::mt19937_64 &random);
    void takeRuns(const KnownScan &scan);
    void takeLines(const KnownScan &scan);
    const std::vector<vectorlib::VectorizedLine> &vectorize(const Points &cluster);
    void find(const KnownScan &scan, const int *order, const vectorlib::VectorizedLine &line);
    void joinEnds(std::size_t first);
    void add(const KnownScan &scan, std::size_t edge, const vectorlib::LineSegment2D<double> &seen);

    Pairing pairing_;
    double noise_;
    double minLength_ = 0;
    std::normal_distribution<double> normal_;
    vectorlib::EarSegmenter<double> segment_;
    vectorlib::FtlsVectorizer<double> ftls_;
    vectorlib::AftlsVectorizer<double> aftls_;
    Points points_, own_;
    std::vector<std::size_t> counts_;
    std::vector<Found> found_;
    std::vector<vectorlib::SegmentPair> pairs_;
};

} // namespace hermes::experiments
