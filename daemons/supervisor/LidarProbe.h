#pragma once

#include "protocol/messages/Setup.h"

#include <atomic>

namespace hermes::supervisor {

/// Listens who sends packets of a lidar, in a thread that may wait. Where another program receives at the
/// port its packets are left to it.
class LidarProbe {
public:
    LidarProbe(quint16 dataPort, quint16 positionPort, const std::atomic<bool> &isCancelled)
        : dataPort_(dataPort)
        , positionPort_(positionPort)
        , isCancelled_(isCancelled) {}

    /// For one and a half seconds. problems: which port could not be listened at, and why.
    std::vector<FoundLidar> run(QStringList &problems);

private:
    const quint16 dataPort_, positionPort_;
    const std::atomic<bool> &isCancelled_;
};

} // namespace hermes::supervisor
