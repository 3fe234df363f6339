#include "daemons/scanmatcher/OdometrySource.h"

#include "common/Log.h"
#include "common/daemon/Health.h"
#include "protocol/wire/Fields.h"

#include <cmath>

namespace hermes::scanmatcher {

using vectorlib::OdometryBuffer;
using vectorlib::OdometryTrack;

namespace {

constexpr int queue = 100;      // messages, two seconds
constexpr int mayBeWithout = 3; // scans in a row: a reset leaves out one or two

} // namespace

OdometrySource::OdometrySource() {
    QObject::connect(&client_, &Client::connected, [this] { fault_.clear(); });
    QObject::connect(&client_, &Client::subscriptionFailed, [this](int, const RpcError &error) {
        fault_ = error.message;
        logError("odometry", fault_);
    });
}

Result<void> OdometrySource::open(const QString &address, const QString &topic) {
    close();
    address_ = address;
    if (address.isEmpty())
        return {};
    const auto connecting = client_.connectTo(address);
    if (!connecting) {
        fault_ = connecting.error().message;
        return connecting;
    }
    subscription_ =
        client_.subscribe(topic, {{"queue", queue}}, [this](const TopicUpdate &update) { take(update); });
    return {};
}

void OdometrySource::close() {
    client_.close();
    client_.unsubscribe(subscription_);
    buffer_.restart();
    address_.clear();
    fault_.clear();
    withoutInARow_ = 0;
    contradiction_.clear();
    stopFault_.clear();
}

void OdometrySource::take(const TopicUpdate &update) {
    dropped_ = update.dropped;
    fault_.clear();
    const auto sample = readOdometry(update.data, update.stamp, unknown_);
    if (!sample) {
        const bool isFirst = faults_.level(double(refused_ + dropped_)) == HealthLevel::Ok; // for a minute
        ++refused_;
        if (isFirst)
            logWarning("odometry", sample.error().message);
        lastRefused_ = sample.error().message;
        return;
    }
    ++messages_;
    switch (buffer_.add(*sample)) {
    case OdometryBuffer::Outcome::Taken:
        break;
    case OdometryBuffer::Outcome::OutOfOrder:
        ++outOfOrder_;
        break;
    case OdometryBuffer::Outcome::Restarted:
        if (restarts_++ == 0)
            logInfo("odometry", "begins anew: it was reset, or there was a gap");
        break;
    }
}

std::optional<OdometryTrack> OdometrySource::over(double begin, double end) {
    if (address_.isEmpty())
        return std::nullopt;
    auto track = buffer_.over(begin, end);
    scansWithout_ += track ? 0 : 1;
    withoutInARow_ = track ? 0 : withoutInARow_ + 1;
    return track;
}

void OdometrySource::contradict(const vectorlib::OdometryCheck::Ways &ways, bool stops) {
    const auto text = [](const vectorlib::Pose2D &way) {
        const auto rounded = [](double value, double perUnit) {
            return QString::number(std::round(value * perUnit) / perUnit + 0.0); // never -0
        };
        return QString("%1 m ahead, %2 m to the left and %3 degrees")
            .arg(rounded(way.x, 100), rounded(way.y, 100), rounded(way.theta * 180 / vectorlib::pi, 1));
    };
    ++contradicted_;
    contradiction_ =
        QString("the scans contradict the odometry: it tells of %1 in %2 s, they show %3; the wheels "
                "slip or the robot is at a wall, its measures (frame.*) are wrong, the scans are another "
                "robot's, or sensor.* tells wrongly where the sensor is")
            .arg(text(ways.odometry))
            .arg(ways.seconds, 0, 'f', 1)
            .arg(text(ways.scans));
    logWarning("odometry", contradiction_);
    if (stops && client_.isConnected())
        client_.call(
            "motor.stop", QJsonObject{{"client", "scanmatcher, as the scans contradict the odometry"}},
            [this](const auto &answer) {
                stopFault_ = answer ? QString() : "; nothing was stopped: " + answer.error().message;
                if (!answer)
                    logError("odometry", "motor.stop: " + answer.error().message);
            },
            Client::defaultTimeout, Client::Repeats::AtOnce);
}

QString OdometrySource::pastText(bool isRecent) const {
    QString text;
    if (!contradiction_.isEmpty() && isRecent)
        text += "; " + contradiction_ + stopFault_;
    else if (contradicted_ > 0)
        text += QString("; the scans have contradicted the odometry %1 times").arg(contradicted_);
    if (refused_ > 0)
        text += QString("; refused %1 messages, the last: %2").arg(refused_).arg(lastRefused_);
    if (dropped_ > 0)
        text += QString("; %1 messages were dropped").arg(dropped_);
    return text;
}

void OdometrySource::report(Health &health) {
    const auto set = [&](HealthLevel level, const QString &message) {
        health.set("odometry", level, message, asJson(state()).toObject());
    };
    if (address_.isEmpty())
        health.remove("odometry");
    else if (client_.isBeginning())
        set(HealthLevel::Ok, "connecting to " + address_);
    else if (!client_.isConnected())
        set(HealthLevel::Warn, QString("no connection to %1: %2; poses are expected from the scans alone")
                                   .arg(address_, fault_.isEmpty() ? client_.problem() : fault_));
    else if (!fault_.isEmpty())
        set(HealthLevel::Warn, QString("no odometry from %1: %2; poses are expected from the scans alone")
                                   .arg(address_, fault_));
    else {
        const HealthLevel level = faults_.level(double(refused_ + dropped_ + contradicted_));
        const QString past = pastText(level != HealthLevel::Ok);
        if (withoutInARow_ >= mayBeWithout)
            set(HealthLevel::Warn, QString("the last %1 scans found no odometry of their time; their poses "
                                           "were expected from the scans alone")
                                           .arg(withoutInARow_) +
                                       past);
        else
            set(level, "connected to " + address_ + past);
    }
}

OdometryState OdometrySource::state() const {
    return {client_.isConnected(), messages_,    refused_, outOfOrder_, restarts_, dropped_, unknown_,
            scansWithout_,         contradicted_};
}

} // namespace hermes::scanmatcher
