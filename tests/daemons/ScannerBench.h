#pragma once

#include "ScannerReaders.h"
#include "daemons/simulator/ScannerEmulator.h"

using hermes::simulator::makeScanner;
using hermes::simulator::ScannerEmulator;
using hermes::simulator::ScannerOptions;

constexpr std::int64_t start_ns = 1700000000000000000, step_ns = 500000;

/// To the walls of a room that looks different in every direction; radians, counter-clockwise.
inline double roomRange(double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    const double x = c > 0 ? 3.1 / c : c < 0 ? -2.3 / c : 1e9, y = s > 0 ? 1.7 / s : s < 0 ? -4.2 / s : 1e9;
    return std::min(x, y);
}

inline QByteArray fromHex(const char *text) {
    return QByteArray::fromHex(text);
}

/// A scanner in that room, and the time.
struct Bench {
    std::unique_ptr<ScannerEmulator> scanner;
    std::int64_t now_ns = start_ns;
    ScannerEmulator::Measure measure = roomRange;
    int mostAtOnce = 0; ///< bytes

    explicit Bench(const QString &model, const ScannerOptions &options = {})
        : scanner(makeScanner(model.toStdString(), options)) {
        pass(0.01);
    }
    /// What is sent in this time.
    QByteArray pass(double seconds) {
        QByteArray bytes;
        for (const std::int64_t end_ns = now_ns + std::int64_t(seconds * 1e9); now_ns < end_ns;) {
            now_ns += step_ns;
            const std::string_view sent = scanner->take(now_ns, measure);
            bytes.append(sent.data(), int(sent.size()));
            mostAtOnce = std::max(mostAtOnce, int(sent.size()));
        }
        return bytes;
    }
    /// What it answers to this, soon.
    QByteArray ask(const QByteArray &bytes, double seconds = 0.05) {
        scanner->receive(std::string_view(bytes.data(), std::size_t(bytes.size())), now_ns);
        return pass(seconds);
    }
    /// Makes it scan; type: of an RPLIDAR's packets.
    void scan(unsigned type = 0x81) {
        const QString model = scanner->model().name;
        if (model.startsWith("rplidar")) {
            ask(fromHex("A5F0029402C1"), 0);
            if (type == 0x81)
                return void(ask(fromHex("A520"), 0));
            for (char mode = 1; mode < 3; ++mode) {
                QByteArray request = fromHex("A58205") + mode + QByteArray(4, 0);
                request.append(char(0x22 ^ mode));
                scanner->receive(request.toStdString(), now_ns);
                if (u8(pass(0.003), 6) == type)
                    return;
                ask(fromHex("A525"));
            }
        } else if (model.startsWith("ydlidar")) {
            ask(fromHex("A560"), 0);
        } else if (model.startsWith("hokuyo")) {
            ask(model.contains("urg") ? "MD0044072501000\n" : "ME0000108001000\n", 0);
        } else if (model.startsWith("sick")) {
            ask("\x02sEN LMDscandata 1\x03", 0);
        }
    }
    Reading read(const QByteArray &bytes, unsigned type = 0x81) const {
        const QString model = scanner->model().name;
        if (model.startsWith("rplidar"))
            return type == 0x81 ? readRplidar81(bytes) : readRplidar(type, bytes);
        if (model.startsWith("ydlidar"))
            return readYdlidar(bytes, model.contains("tmini"), model.contains("tg30"),
                               model.contains("x2") || model.contains("x4"));
        if (model.startsWith("hokuyo"))
            return model.contains("urg") ? readScip(bytes, 44, 384, 1024, false)
                                         : readScip(bytes, 0, 540, 1440, true);
        return model.startsWith("sick") ? readCola(bytes) : readLd(bytes);
    }
};
