#include "daemons/scanmatcher/ScannerSource.h"

#include "common/Log.h"

#include <utility>

namespace hermes::scanmatcher {

ScannerSource::ScannerSource(QString name, std::function<void(Scan)> take)
    : name_(std::move(name))
    , take_(std::move(take)) {
    client_.prefer("cbor");
    QObject::connect(&client_, &Client::connected, [this] {
        last_ = monotonicNow();
        fault_.clear();
    });
    QObject::connect(&client_, &Client::subscriptionFailed, [this](int, const RpcError &error) {
        fault_ = error.message;
        logError(name_, fault_);
    });
}

void ScannerSource::open(const QString &address, const QString &topic, qint64 queue) {
    close();
    address_ = address;
    if (address.isEmpty())
        return;
    if (const auto connecting = client_.connectTo(address); !connecting) {
        fault_ = connecting.error().message;
        logError(name_, fault_);
        return;
    }
    subscription_ =
        client_.subscribe(topic, {{"queue", queue}}, [this](const TopicUpdate &update) { take(update); });
}

void ScannerSource::close() {
    client_.close();
    client_.unsubscribe(subscription_);
    fault_.clear();
}

void ScannerSource::take(const TopicUpdate &update) {
    last_ = monotonicNow();
    fault_.clear();
    dropped_ = update.dropped;
    auto parsed = readScan(update.data, unknown_);
    if (!parsed) {
        const bool isFirst = pastRefused_.level(double(refused_)) == HealthLevel::Ok; // for a minute
        ++refused_;
        if (isFirst)
            logWarning(name_, parsed.error().message);
        lastRefused_ = parsed.error().message;
        return;
    }
    Scan scan = parsed.take();
    scan.replayed |= update.replayed;
    ++scans_;
    if (!scan.partial)
        take_(std::move(scan));
}

ScannerSource::Finding ScannerSource::find(double longestSilence_s) {
    // What is no message at all, as one with a number that is not finite.
    const Client::Rejected &rejected = client_.rejected();
    const QString unreadable = rejected.unreadable == 0
                                   ? QString()
                                   : QString("; %1 messages could not be read, the last: %2")
                                         .arg(rejected.unreadable)
                                         .arg(rejected.last);
    if (client_.isBeginning())
        return {HealthLevel::Ok, "connecting to " + address_};
    if (!client_.isConnected())
        return {
            HealthLevel::Failed,
            QString("no connection to %1: %2").arg(address_, fault_.isEmpty() ? client_.problem() : fault_)};
    if (!fault_.isEmpty())
        return {HealthLevel::Failed, QString("no scans from %1: %2").arg(address_, fault_)};
    if (silent_s() > longestSilence_s)
        return {HealthLevel::Warn,
                QString("no scan from %1 for %2 s").arg(address_).arg(silent_s(), 0, 'f', 0) + unreadable};
    if (refused_ > 0)
        return {pastRefused_.level(double(refused_)),
                QString("refused %1 scans, the last: %2").arg(refused_).arg(lastRefused_)};
    return {pastUnreadable_.level(double(rejected.unreadable)), "connected to " + address_ + unreadable};
}

SourceState ScannerSource::state() const {
    SourceState state;
    state.address = address_;
    state.connected = client_.isConnected();
    state.scans = scans_;
    state.refused = refused_;
    state.dropped = dropped_;
    state.unknownFields = unknown_;
    if (state.connected)
        state.age = silent_s();
    return state;
}

} // namespace hermes::scanmatcher
