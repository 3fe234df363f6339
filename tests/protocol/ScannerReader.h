#pragma once

#include "protocol/scan/ScannerModel.h"

#include <QByteArray>

#include <random>

namespace hermes::scan {

inline std::string bytesOf(const QByteArray &hex) {
    return QByteArray::fromHex(hex).toStdString();
}

/// A scanner, what came out of it, and a clock.
struct ScannerReader {
    explicit ScannerReader(const char *model)
        : scanner(findScannerModel(model)->make(*findScannerModel(model), assembler)) {}

    static std::int64_t ns(double t_s) { return std::int64_t(t_s * 1e9); }

    void feed(const std::string &bytes, double t_s) { scanner->feed(bytes, {epoch_ns + ns(t_s), ns(t_s)}); }
    /// Cut anywhere, as a line delivers them that carries so many bytes a second.
    void feedInPieces(const std::string &bytes, double bytesPerSecond, std::mt19937 &random) {
        for (std::size_t at = 0; at < bytes.size();) {
            const std::size_t size = std::min<std::size_t>(1 + random() % 300, bytes.size() - at);
            at += size;
            feed(bytes.substr(at - size, size), double(at) / bytesPerSecond);
        }
    }
    std::vector<Beam> beams() {
        assembler.jump();
        std::vector<Beam> all;
        for (const Revolution &revolution : revolutions)
            all.insert(all.end(), revolution.beams.begin(), revolution.beams.end());
        return all;
    }
    /// What the host sends from now on until the time, asked each 20 ms. It stops where it sends.
    HostAction nextAction(double &t_s, double until_s) {
        for (; t_s < until_s; t_s += 0.02) {
            HostAction action = scanner->next(ns(t_s));
            if (!action.send.empty() || action.dtr || action.reopen)
                return action;
        }
        return {};
    }

    static constexpr std::int64_t epoch_ns = 1700000000000000000;

    std::vector<Revolution> revolutions;
    RevolutionAssembler assembler{
        [this](const Revolution &revolution) { revolutions.push_back(revolution); }};
    std::unique_ptr<ScannerProtocol> scanner;
};

} // namespace hermes::scan
