// The controller bus: how long a cycle takes on the wire, and how evenly cycles follow each other.
#include "SerialWire.h"
#include "daemons/motorcontrol/MotorControl.h"

#include <QCoreApplication>
#include <QEventLoop>
#include <QTemporaryDir>
#include <QTimer>

#include <algorithm>
#include <benchmark/benchmark.h>
#include <memory>

namespace {

constexpr double period_s = 0.02;
constexpr int settling = 50; // cycles: the controllers are set up, and each slow reading comes by

double percentile(std::vector<double> values, double share) {
    const auto at = values.begin() + std::ptrdiff_t(share * double(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

std::unique_ptr<hermes::motorcontrol::MotorControl> start(const SerialWire &first, const SerialWire &second,
                                                          int baud) {
    auto daemon = std::make_unique<hermes::motorcontrol::MotorControl>();
    const auto url = [baud](int number, const SerialWire &wire) {
        return QString("controllers.%1.url=serial://%2?baud=%3")
            .arg(number)
            .arg(QString::fromStdString(wire.device()))
            .arg(baud);
    };
    const QStringList arguments{"motorcontrol", "--listen", "tcp://127.0.0.1:0", "--set",
                                url(1, first),  "--set",    url(2, second)};
    if (daemon->prepare(arguments) || !daemon->launch().ok())
        throw std::runtime_error("the motor control does not start");
    return daemon;
}

/// An iteration is a cycle. lines: 1 for both controllers on one, 2 for a line each; the first one is
/// measured.
void cycles(benchmark::State &state, int baud, int lines) {
    using Addresses = std::vector<std::uint8_t>;
    SerialWire wire(baud, lines == 1 ? Addresses{0x80, 0x81} : Addresses{0x80});
    std::unique_ptr<SerialWire> second;
    if (lines == 2)
        second = std::make_unique<SerialWire>(baud, Addresses{0x81});
    const auto daemon = start(wire, second ? *second : wire, baud);
    std::vector<double> busy, bound, off;
    SerialWire::Cycle before{};
    for (int i = 0; i < settling; ++i)
        before = wire.next();
    for (auto _ : state) {
        const SerialWire::Cycle cycle = wire.next();
        busy.push_back(cycle.busy_s);
        bound.push_back(cycle.wire_bytes * 10 / baud);
        off.push_back(std::abs(cycle.begin_s - before.begin_s - period_s));
        before = cycle;
    }
    daemon->shutDown();
    state.counters["cycles"] = double(busy.size());
    state.counters["bound_ms"] = percentile(bound, 0.5) * 1e3;
    state.counters["median_ms"] = percentile(busy, 0.5) * 1e3;
    state.counters["p99_ms"] = percentile(busy, 0.99) * 1e3;
    state.counters["jitter_median_us"] = percentile(off, 0.5) * 1e6;
    state.counters["jitter_p99_us"] = percentile(off, 0.99) * 1e6;
}

} // namespace

int main(int argc, char **argv) {
    QCoreApplication application(argc, argv);
    for (const int baud : {115200, 460800}) {
        for (const int lines : {2, 1}) {
            const std::string name = lines == 1 ? "two controllers on a line" : "one controller on a line";
            benchmark::RegisterBenchmark((name + "/" + std::to_string(baud)).c_str(),
                                         [=](benchmark::State &state) { cycles(state, baud, lines); })
                ->UseRealTime();
        }
    }
    benchmark::AddCustomContext("compiler", BENCH_COMPILER);
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
