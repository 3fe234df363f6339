// Decoding: a packet of an HDL-32E, every laser of which sees something, becomes points of turns.
#include "protocol/velodyne/Hdl32e.h"
#include "protocol/velodyne/TurnAssembler.h"

#include <benchmark/benchmark.h>

namespace {

using namespace hermes::velodyne;

/// Ten turns a second for a tenth of a second, again and again; the stamps go on.
void decode(benchmark::State &state, int laser, std::uint32_t firingStep) {
    constexpr int count = 181;
    std::vector<DataPacketWriter> packets(count);
    for (int i = 0; i < count; ++i)
        for (int block = 0; block < blocksPerPacket; ++block) {
            packets[i].setAzimuth(block, std::uint16_t((i * blocksPerPacket + block) * azimuthSteps /
                                                       (count * blocksPerPacket)));
            for (int slot = 0; slot < slotsPerBlock; ++slot)
                packets[i].setReturn(block, slot, std::uint16_t(1000 + 7 * slot + block), 100);
        }
    TurnAssembler::Options options;
    options.laser = laser;
    options.firingStep = firingStep;
    std::size_t points = 0;
    TurnAssembler assembler(options, [&points](const Turn &turn) { points += turn.points.size(); });
    std::int64_t now_ns = 0;
    int next = 0;
    for (auto _ : state) {
        packets[next].setTail(std::uint32_t(now_ns / 1000 % stampPeriod_us));
        assembler.feed(packets[next].bytes().data(), packetSize, now_ns);
        now_ns += hdl32e.packetPeriod_ns();
        next = (next + 1) % count;
    }
    benchmark::DoNotOptimize(points);
    if (assembler.counts().lost + assembler.counts().outOfOrder > 0)
        state.SkipWithError("packets were not taken");
}

} // namespace

int main(int argc, char **argv) {
    const auto add = [](const char *name, int laser, std::uint32_t firingStep) {
        benchmark::RegisterBenchmark(name,
                                     [=](benchmark::State &state) { decode(state, laser, firingStep); });
    };
    add("one laser, as for scan2d", PacketDecoder::levelLaser, 1);
    add("all lasers, 8000 points a turn, as for cloud", PacketDecoder::allLasers, 9);
    add("all lasers, every point, as for capture.turn", PacketDecoder::allLasers, 1);
    benchmark::AddCustomContext("compiler", BENCH_COMPILER);
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
}
