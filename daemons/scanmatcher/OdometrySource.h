#pragma once

#include "common/client/Client.h"
#include "common/daemon/PastFaults.h"
#include "daemons/scanmatcher/MatcherMessages.h"
#include "vectorlib/motion/Odometry.h"

namespace hermes::scanmatcher {

/// The topic of another daemon that tells where the robot is by its wheels: receives, checks, counts, and
/// hands each scan the odometry of its time.
class OdometrySource {
public:
    OdometrySource();

    /// An empty address: there is no odometry. Error: a bad address only.
    Result<void> open(const QString &address, const QString &topic);
    void close();

    /// What is known from begin to end, seconds since the Unix epoch.
    std::optional<vectorlib::OdometryTrack> over(double begin, double end);
    /// The scans show another way of the robot: tells it, and stops whoever drives.
    void contradict(const vectorlib::OdometryCheck::Ways &ways, bool stops);
    /// Sets the health item `odometry`, or removes it when there is no source.
    void report(Health &health);
    /// Counts: {connected, messages, refused, out_of_order, restarts, dropped, scans_without,
    /// contradicted}.
    OdometryState state() const;
    /// For its signals.
    const Client &client() const { return client_; }

private:
    void take(const TopicUpdate &update);

    QString pastText(bool isRecent) const;

    Client client_;
    QString address_;
    QString fault_; // why there will be none
    int subscription_ = 0;
    vectorlib::OdometryBuffer buffer_;
    QString lastRefused_;
    PastFaults faults_;
    QString contradiction_, stopFault_; // the last
    quint64 messages_ = 0, refused_ = 0, outOfOrder_ = 0, restarts_ = 0, dropped_ = 0, scansWithout_ = 0,
            contradicted_ = 0, unknown_ = 0;
    int withoutInARow_ = 0;
};

} // namespace hermes::scanmatcher
