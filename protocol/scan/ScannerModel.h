#pragma once

#include "protocol/scan/ScannerProtocol.h"

#include <memory>
#include <vector>

namespace hermes::scan {

/// What makes the head turn.
enum class Motor {
    Itself,
    DtrLow, ///< it turns while DTR is low
    DtrHigh,
};

/// A scanner that can be bought, as far as models of one family differ. Sources: the makers' manuals and
/// drivers.
struct ScannerModel {
    const char *name;  ///< for settings: "rplidar-a1"
    const char *title; ///< for people
    int baud;          ///< 0: it has no serial line
    bool isOverTcp;    ///< it can be on a network
    /// It sends by itself and must not be asked anything.
    bool isOneWay;
    int samples_hz; ///< that it measures in a second; 0: it tells
    Motor motor;
    std::unique_ptr<ScannerProtocol> (*make)(const ScannerModel &model, RevolutionAssembler &revolutions);
};

const std::vector<ScannerModel> &scannerModels();
/// One of each that differ in what is said on a serial line, or over TCP, in the order in which they are to
/// be looked for: those that send by themselves are heard before anything is sent.
std::vector<const ScannerModel *> scannerSearch(bool isSerial);
/// Whether a line leads to the scanner that is looked for.
enum class Search { GoesOn, Found, Other };
/// open_s: since the line was opened for it.
Search verdictOf(const ScannerModel &model, const ScannerProtocol &scanner, double open_s);
/// Null: there is none of that name.
const ScannerModel *findScannerModel(std::string_view name);
/// Of those that speak as this one on a line of the same speed: the one that the device names itself after,
/// or the only one; else null.
const ScannerModel *namedModel(const ScannerModel &alike, std::string_view device);

} // namespace hermes::scan
