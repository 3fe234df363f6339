// Does one thing so many times, for counting instructions in an emulator: see instructions.sh.
#include "tests/bench/Room.h"

#include <vectorlib/segmentation/EarSegmenter.h>
#include <vectorlib/vectorization/FtlsVectorizer.h>

#include <cstdio>
#include <cstdlib>
#include <string>

using namespace vectorlib;

namespace {

/// A scan of the room: its points, and what a lidar gives.
struct Scan {
    std::vector<Vector2D<float>> points;
    std::vector<float> ranges;

    explicit Scan(int rays)
        : points(roomScan(rays)) {
        for (const auto &p : points)
            ranges.push_back(std::hypot(p.x, p.y));
    }
    PolarScan<float> polar() const {
        return {ranges.data(), ranges.size(), -pi, 2 * pi / double(ranges.size())};
    }
};

template <typename Work>
int repeat(int times, Work work) {
    std::size_t size = 0;
    for (int i = 0; i < times; ++i)
        size += work();
    std::printf("%zu\n", size);
    return 0;
}

} // namespace

int main(int argc, char **argv) {
    if (argc != 5)
        return 2;
    const std::string what = argv[1];
    const Scan scan(std::atoi(argv[2]));
    const simd::Level level = std::string(argv[3]) == "plain" ? simd::Level::Scalar : simd::bestLevel();
    const int times = std::atoi(argv[4]);
    BlockSums sums;
    FtlsVectorizer<float> ftls;
    EarSegmenter<float> segment;
    sums.level = ftls.level = segment.level = level;
    segment.settings = EarSettings::forScanner(2 * pi, scan.points.size());
    if (what == "sums")
        return repeat(times, [&] {
            sums.assign(scan.points);
            return sums.size();
        });
    if (what == "ftls")
        return repeat(times, [&] { return ftls(scan.points).size(); });
    if (what == "cartesian")
        return repeat(times, [&] { return segment(PointSpan<float>(scan.points)).size(); });
    if (what == "polar")
        return repeat(times, [&] { return segment(scan.polar()).size(); });
    return 2;
}
