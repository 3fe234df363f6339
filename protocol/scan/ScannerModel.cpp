#include "protocol/scan/ScannerModel.h"

#include "protocol/scan/Hokuyo.h"
#include "protocol/scan/Ldrobot.h"
#include "protocol/scan/Rplidar.h"
#include "protocol/scan/SickCola.h"
#include "protocol/scan/Ydlidar.h"

#include <algorithm>
#include <cctype>

namespace hermes::scan {
namespace {

using Made = std::unique_ptr<ScannerProtocol>;

Made makeRplidar(const ScannerModel &model, RevolutionAssembler &revolutions) {
    return std::make_unique<Rplidar>(model.baud, model.motor == Motor::DtrLow, revolutions);
}

Made makeLdrobot(const ScannerModel &model, RevolutionAssembler &revolutions) {
    return std::make_unique<Ldrobot>(model.samples_hz, model.baud, revolutions);
}

template <Ydlidar::Kind kind>
Made makeYdlidar(const ScannerModel &model, RevolutionAssembler &revolutions) {
    return std::make_unique<Ydlidar>(kind, model, revolutions);
}

Made makeHokuyo(const ScannerModel &, RevolutionAssembler &revolutions) {
    return std::make_unique<Hokuyo>(revolutions);
}

Made makeSick(const ScannerModel &, RevolutionAssembler &revolutions) {
    return std::make_unique<SickCola>(revolutions);
}

constexpr auto makeYdlidarX = makeYdlidar<Ydlidar::Kind::Triangulation>;
constexpr auto makeYdlidarTmini = makeYdlidar<Ydlidar::Kind::Tmini>;
constexpr auto makeYdlidarTg = makeYdlidar<Ydlidar::Kind::TimeOfFlight>;

} // namespace

const std::vector<ScannerModel> &scannerModels() {
    static const std::vector<ScannerModel> models{
        {"hokuyo-urg04lx", "Hokuyo URG-04LX", 115200, false, false, 0, Motor::Itself, makeHokuyo},
        {"hokuyo-utm30lx", "Hokuyo UTM-30LX", 115200, false, false, 0, Motor::Itself, makeHokuyo},
        {"hokuyo-ust10lx", "Hokuyo UST-10LX, UST-20LX", 115200, true, false, 0, Motor::Itself, makeHokuyo},
        {"ld06", "LDROBOT LD06", 230400, false, true, 4500, Motor::Itself, makeLdrobot},
        {"ld19", "LDROBOT LD19", 230400, false, true, 4500, Motor::Itself, makeLdrobot},
        {"stl27l", "LDROBOT STL-27L", 921600, false, true, 21600, Motor::Itself, makeLdrobot},
        {"rplidar-a1", "Slamtec RPLIDAR A1", 115200, false, false, 0, Motor::DtrLow, makeRplidar},
        {"rplidar-a2m8", "Slamtec RPLIDAR A2M8", 115200, false, false, 0, Motor::DtrLow, makeRplidar},
        {"rplidar-a2m12", "Slamtec RPLIDAR A2M7, A2M12", 256000, false, false, 0, Motor::DtrLow, makeRplidar},
        {"rplidar-a3", "Slamtec RPLIDAR A3", 256000, false, false, 0, Motor::DtrLow, makeRplidar},
        {"rplidar-c1", "Slamtec RPLIDAR C1", 460800, false, false, 0, Motor::Itself, makeRplidar},
        {"rplidar-s1", "Slamtec RPLIDAR S1", 256000, false, false, 0, Motor::Itself, makeRplidar},
        {"rplidar-s2", "Slamtec RPLIDAR S2", 1000000, false, false, 0, Motor::Itself, makeRplidar},
        {"rplidar-s3", "Slamtec RPLIDAR S3", 1000000, false, false, 0, Motor::Itself, makeRplidar},
        {"sick-lms1xx", "SICK LMS1xx", 0, true, false, 0, Motor::Itself, makeSick},
        {"sick-tim5xx", "SICK TiM5xx", 0, true, false, 0, Motor::Itself, makeSick},
        {"ydlidar-x2", "YDLIDAR X2, X3", 115200, false, true, 3000, Motor::DtrHigh, makeYdlidarX},
        {"ydlidar-x4", "YDLIDAR X4", 128000, false, false, 5000, Motor::DtrHigh, makeYdlidarX},
        {"ydlidar-g4", "YDLIDAR G4, G5", 230400, false, false, 9000, Motor::Itself, makeYdlidarX},
        {"ydlidar-tmini", "YDLIDAR Tmini Pro, Plus", 230400, false, false, 4000, Motor::Itself,
         makeYdlidarTmini},
        {"ydlidar-tg30", "YDLIDAR TG15 to TG50", 512000, false, false, 20000, Motor::Itself, makeYdlidarTg},
    };
    return models;
}

std::vector<const ScannerModel *> scannerSearch(bool isSerial) {
    std::vector<const ScannerModel *> all;
    for (const bool isOneWay : {true, false})
        for (const ScannerModel &model : scannerModels()) {
            const auto isSame = [&](const ScannerModel *other) {
                return other->make == model.make && other->baud == model.baud;
            };
            if (model.isOneWay == isOneWay && (isSerial ? model.baud > 0 : model.isOverTcp) &&
                std::none_of(all.begin(), all.end(), isSame))
                all.push_back(&model);
        }
    return all;
}

Search verdictOf(const ScannerModel &model, const ScannerProtocol &scanner, double open_s) {
    constexpr std::uint64_t enoughPackets = 10;
    constexpr double listening_s = 0.3, turning_s = 1; // where its motor must start
    const ScannerProtocol::Counts &counts = scanner.counts();
    const bool isNamed = !scanner.identity().serial.empty(), failed = !scanner.problem().empty();
    const bool isMisread = counts.damaged >= enoughPackets && counts.damaged > counts.packets;
    const bool isOver = model.isOneWay && open_s > (model.motor == Motor::Itself ? listening_s : turning_s);
    if (isMisread || (!isNamed && (failed || isOver)))
        return Search::Other;
    // It measures, or tells who it is and that it cannot.
    return counts.packets >= (isNamed ? 1 : enoughPackets) || failed ? Search::Found : Search::GoesOn;
}

const ScannerModel *findScannerModel(std::string_view name) {
    for (const ScannerModel &model : scannerModels())
        if (name == model.name)
            return &model;
    return nullptr;
}

const ScannerModel *namedModel(const ScannerModel &alike, std::string_view device) {
    std::string name; // as in the table
    for (const char character : device)
        if (std::isalnum(std::uint8_t(character)))
            name += char(std::tolower(std::uint8_t(character)));
    const ScannerModel *only = nullptr;
    int count = 0;
    for (const ScannerModel &model : scannerModels()) {
        if (model.make != alike.make || model.baud != alike.baud)
            continue;
        const std::string_view all = model.name;
        if (name.find(all.substr(all.find('-') + 1)) != std::string::npos)
            return &model;
        only = ++count == 1 ? &model : nullptr;
    }
    return only;
}

} // namespace hermes::scan
