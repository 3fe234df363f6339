#include "daemons/supervisor/DeviceSearch.h"

#include "daemons/supervisor/LidarProbe.h"
#include "daemons/supervisor/SerialProbe.h"

#include <QFileInfo>
#include <future>

namespace hermes::supervisor {

DeviceSearch::~DeviceSearch() {
    isCancelled_ = true;
    if (thread_.joinable())
        thread_.join();
}

void DeviceSearch::begin(const Options &options, const Done &done) {
    if (thread_.joinable())
        thread_.join(); // of the search before, which has ended
    thread_ = std::thread([this, options, done] { done(search(options)); });
}

Findings DeviceSearch::search(const Options &options) const {
    QStringList controllers;
    for (const QString &path : options.controllers)
        controllers.append(QFileInfo(path).canonicalFilePath());
    std::vector<std::future<FoundSerial>> probes;
    for (const SerialCandidate &candidate : serialCandidates(options.ports)) {
        const bool isController = candidate.isController || controllers.contains(candidate.device);
        const SerialProbe::Permission mayAsk{options.ask || isController, options.ask && !isController};
        probes.push_back(std::async(std::launch::async, [this, candidate, mayAsk] {
            return SerialProbe(candidate, mayAsk, isCancelled_).run();
        }));
    }
    Findings findings;
    findings.lidars =
        LidarProbe(options.lidarPort, options.positionPort, isCancelled_).run(findings.problems);
    for (auto &probe : probes)
        findings.serial.push_back(probe.get());
    return findings;
}

} // namespace hermes::supervisor
