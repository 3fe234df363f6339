#pragma once

#include "protocol/messages/Setup.h"

#include <atomic>
#include <functional>
#include <thread>

namespace hermes::supervisor {

/// Looks for what is plugged in, all lines at the same time, in threads of its own.
class DeviceSearch {
public:
    struct Options {
        QStringList ports;       ///< serial lines beside those that the system lists
        QStringList controllers; ///< devices that settings name as those of motor controllers
        bool ask = false; ///< silent lines are asked for a RoboClaw, an Arduino or a scanner, also those of
                          ///< unknown devices
        quint16 lidarPort = 0, positionPort = 0;
    };
    /// In a thread of the search.
    using Done = std::function<void(const Findings &)>;

    DeviceSearch() = default;
    ~DeviceSearch();
    DeviceSearch(const DeviceSearch &) = delete;
    DeviceSearch &operator=(const DeviceSearch &) = delete;

    /// Fifteen seconds at most. Only when none is running.
    void begin(const Options &options, const Done &done);

private:
    Findings search(const Options &options) const;

    std::thread thread_;
    std::atomic<bool> isCancelled_{false};
};

} // namespace hermes::supervisor
