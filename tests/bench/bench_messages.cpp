// A turn of 1,800 points as a message: from points to bytes and from bytes to points, in both framings,
// beside QJsonDocument.
#include "common/daemon/TopicHub.h"
#include "protocol/jsonrpc/CborCodec.h"
#include "protocol/jsonrpc/JsonCodec.h"
#include "protocol/messages/Turns.h"
#include "protocol/wire/Fields.h"

#include <QJsonDocument>
#include <benchmark/benchmark.h>
#include <cmath>

namespace {

using namespace hermes;

constexpr int points = 1800;

const ScanMessage &scan() {
    static const ScanMessage made = [] {
        ScanMessage message;
        message.header.stamp = 1.7e9;
        message.header.rays = points;
        message.t.emplace();
        for (int i = 0; i < points; ++i) {
            const double angle = 2 * M_PI * i / points, range = 8 + std::sin(9 * angle);
            message.x.push_back(float(range * std::cos(angle)));
            message.y.push_back(float(range * std::sin(angle)));
            message.t->push_back(float(0.1 * i / points));
            message.intensity.push_back(quint8(i));
        }
        return message;
    }();
    return made;
}

QByteArray framed(Codec &codec) {
    return codec.forSubscription(codec.encodeTopic("scan2d", 1, 1.7e9, scan()).bytes, 1, 0);
}

template <typename T>
QJsonArray arrayOf(const std::vector<T> &values) {
    QJsonArray array;
    for (const T &value : values)
        array.append(double(value));
    return array;
}

template <typename T>
std::vector<T> vectorOf(const QJsonValue &value) {
    std::vector<T> values;
    const QJsonArray array = value.toArray();
    values.reserve(std::size_t(array.size()));
    for (const QJsonValue &element : array)
        values.push_back(T(element.toDouble()));
    return values;
}

template <typename Framing>
void pointsToBytes(benchmark::State &state) {
    Framing codec;
    for (auto _ : state)
        benchmark::DoNotOptimize(framed(codec).size());
    state.counters["bytes"] = framed(codec).size();
}

void pointsToBytesByQt(benchmark::State &state) {
    for (auto _ : state) {
        const QJsonObject data{{"stamp", scan().header.stamp}, {"rays", points},
                               {"x", arrayOf(scan().x)},       {"y", arrayOf(scan().y)},
                               {"t", arrayOf(*scan().t)},      {"intensity", arrayOf(scan().intensity)}};
        const QJsonObject message{
            {"jsonrpc", "2.0"}, {"method", "topic"}, {"params", QJsonObject{{"data", data}}}};
        benchmark::DoNotOptimize(QJsonDocument(message).toJson(QJsonDocument::Compact).size());
    }
}

template <typename Framing>
void bytesToPoints(benchmark::State &state) {
    Framing codec;
    const QByteArray bytes = framed(codec);
    for (auto _ : state) {
        const std::vector<CodecItem> items = codec.feed(bytes);
        ReadReport report;
        const auto read = readMessage<ScanMessage>(items.front().data, report);
        if (!read || read->x != scan().x || read->intensity.back() != scan().intensity.back())
            state.SkipWithError("it is not what was written");
    }
}

void bytesToPointsByQt(benchmark::State &state) {
    JsonCodec codec;
    const QByteArray bytes = framed(codec);
    for (auto _ : state) {
        const QJsonValue data = QJsonDocument::fromJson(bytes).object().value("params")["data"];
        const auto x = vectorOf<float>(data["x"]), y = vectorOf<float>(data["y"]),
                   t = vectorOf<float>(data["t"]);
        const auto intensity = vectorOf<quint8>(data["intensity"]);
        if (x != scan().x || y.size() != t.size() || intensity.empty())
            state.SkipWithError("it is not what was written");
    }
}

/// What one more subscriber of the same framing costs.
void secondSubscriber(benchmark::State &state) {
    JsonCodec codec;
    const QByteArray frame = codec.encodeTopic("scan2d", 1, 1.7e9, scan()).bytes;
    for (auto _ : state)
        benchmark::DoNotOptimize(codec.forSubscription(frame, 2, 0).size());
}

void nobodySubscribes(benchmark::State &state) {
    TopicHub hub(nullptr);
    hub.declare(Topic("scan2d", "").carries<ScanMessage>());
    int made = 0;
    for (auto _ : state)
        hub.publish(
            "scan2d",
            [&made] {
                ++made;
                return scan();
            },
            1.7e9);
    state.counters["made"] = made;
}

} // namespace

BENCHMARK(pointsToBytes<JsonCodec>)->Name("points to bytes");
BENCHMARK(pointsToBytes<CborCodec>)->Name("points to bytes, cbor");
BENCHMARK(pointsToBytesByQt)->Name("points to bytes, QJsonDocument");
BENCHMARK(bytesToPoints<JsonCodec>)->Name("bytes to points");
BENCHMARK(bytesToPoints<CborCodec>)->Name("bytes to points, cbor");
BENCHMARK(bytesToPointsByQt)->Name("bytes to points, QJsonDocument");
BENCHMARK(secondSubscriber)->Name("a second subscriber");
BENCHMARK(nobodySubscribes)->Name("no subscriber");

int main(int argc, char **argv) {
    benchmark::AddCustomContext("compiler", BENCH_COMPILER);
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
