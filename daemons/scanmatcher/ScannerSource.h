#pragma once

#include "common/Time.h"
#include "common/client/Client.h"
#include "common/daemon/Health.h"
#include "common/daemon/PastFaults.h"
#include "daemons/scanmatcher/MatcherMessages.h"

#include <functional>

namespace hermes::scanmatcher {

/// The topic of another daemon that has the scans of a scanner: receives, checks and counts them.
class ScannerSource {
public:
    struct Finding {
        HealthLevel level;
        QString text;
    };

    /// `take` gets each scan of a whole turn. The log calls the source by the name.
    ScannerSource(QString name, std::function<void(Scan)> take);

    /// An empty address: there is none. A bad one is logged and found.
    void open(const QString &address, const QString &topic, qint64 queue);
    void close();
    /// Whether scans come; a silence that is longer is a warning.
    Finding find(double longestSilence_s);
    SourceState state() const;
    double silent_s() const { return monotonicNow() - last_; }
    /// For its signals.
    const Client &client() const { return client_; }

private:
    void take(const TopicUpdate &update);

    const QString name_;
    const std::function<void(Scan)> take_;
    Client client_;
    int subscription_ = 0;
    QString address_, fault_; // why there will be no scan
    double last_ = 0;         // scan, monotonic; or when it began to wait for one
    quint64 scans_ = 0, refused_ = 0, dropped_ = 0, unknown_ = 0;
    QString lastRefused_;
    PastFaults pastRefused_, pastUnreadable_;
};

} // namespace hermes::scanmatcher
