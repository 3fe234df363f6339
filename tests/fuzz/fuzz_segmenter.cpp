#include "tests/fuzz/FuzzPoints.h"

#include <vectorlib/segmentation/EarSegmenter.h>

using namespace vectorlib;

namespace {

EarSettings takeSettings(FuzzInput &in) {
    EarSettings s;
    s.neighbours = in.take<std::int8_t>() % 20;
    if (in.take<std::uint8_t>() == 0)
        s.neighbours = in.take<std::int32_t>();
    s.minThreshold = in.setting(s.minThreshold);
    s.maxThreshold = in.setting(s.maxThreshold);
    s.minPoints = in.take<std::uint8_t>() == 0 ? in.take<std::int32_t>() : in.take<std::int8_t>() % 16;
    s.closed = in.flag();
    s.fieldOfView = in.setting(s.fieldOfView);
    s.nominalPoints = in.flag() ? in.take<std::uint16_t>() : 0;
    return s;
}

/// Labels, order and starts say the same; what takes no part is in no cluster.
template <typename TakesPart>
void requireSound(const Segmentation &s, std::size_t count, const EarSettings &settings,
                  TakesPart takesPart) {
    FUZZ_REQUIRE(s.labels.size() == count && !s.starts.empty() && s.starts.front() == 0);
    FUZZ_REQUIRE(s.starts.back() == s.order.size() && s.order.size() <= count);
    std::vector<int> labels(count, -1);
    for (std::size_t c = 0; c < s.size(); ++c) {
        FUZZ_REQUIRE(s.starts[c + 1] > s.starts[c]);
        FUZZ_REQUIRE(settings.minPoints <= 0 || s.size(c) >= std::size_t(settings.minPoints));
        int turns = 0; // in scanning order, begun anywhere
        for (std::size_t k = s.starts[c]; k < s.starts[c + 1]; ++k) {
            const int i = s.order[k];
            FUZZ_REQUIRE(i >= 0 && std::size_t(i) < count && labels[std::size_t(i)] == -1);
            FUZZ_REQUIRE(takesPart(std::size_t(i)));
            labels[std::size_t(i)] = int(c);
            turns += k > s.starts[c] && i < s.order[k - 1];
        }
        FUZZ_REQUIRE(turns <= (settings.closed ? 1 : 0));
    }
    FUZZ_REQUIRE(labels == s.labels);
}

bool isSame(const Segmentation &a, const Segmentation &b) {
    return a.labels == b.labels && a.order == b.order && a.starts == b.starts;
}

template <typename Scalar>
void segmentPoints(const EarSettings &settings, FuzzInput &in) {
    const auto points = takePoints<Scalar>(in, 600);
    EarSegmenter<Scalar> segment, plain;
    segment.settings = plain.settings = settings;
    plain.level = simd::Level::Scalar;
    requireSound(segment(points), points.size(), settings,
                 [&](std::size_t i) { return points[i].isFinite(); });
    FUZZ_REQUIRE(isSame(segment(points), plain(points)));
}

template <typename Range>
void segmentRanges(const EarSettings &settings, FuzzInput &in) {
    PolarScan<Range> scan;
    scan.step = in.setting(0.01);
    scan.scale = in.setting(0.002);
    scan.minRange = in.setting(0.5);
    scan.maxRange = in.setting(50);
    std::vector<Range> ranges;
    while (in.left() > 0 && ranges.size() < 600)
        ranges.push_back(in.take<Range>());
    scan.ranges = ranges.data();
    scan.count = ranges.size();
    EarSegmenter<float> segment, plain;
    segment.settings = plain.settings = settings;
    plain.level = simd::Level::Scalar;
    requireSound(segment(scan), scan.count, settings,
                 [&](std::size_t i) { return scan.isReturn(scan.range(i)); });
    FUZZ_REQUIRE(isSame(segment(scan), plain(scan)));
}

} // namespace

/// Clusters are disjoint, in scanning order and of the least size, on every instruction set, whatever points
/// or ranges and settings.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    FuzzInput in(data, size);
    const int kind = in.take<std::uint8_t>() % 4;
    const EarSettings settings = takeSettings(in);
    if (kind == 0)
        segmentPoints<float>(settings, in);
    else if (kind == 1)
        segmentPoints<double>(settings, in);
    else if (kind == 2)
        segmentRanges<std::uint16_t>(settings, in);
    else
        segmentRanges<float>(settings, in);
    return 0;
}
