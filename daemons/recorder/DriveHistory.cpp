#include "daemons/recorder/DriveHistory.h"

#include "daemons/recorder/HaltCause.h"
#include "daemons/recorder/SessionMember.h"
#include "protocol/messages/Daemons.h"
#include "protocol/messages/Motors.h"
#include "protocol/wire/Fields.h"
#include "protocol/wire/JsonText.h"

#include <QSet>
#include <algorithm>
#include <cmath>

namespace hermes::recorder {
namespace {

constexpr int maxLines = 1000;            // of stops, of faults, of marks
constexpr std::size_t maxEvents = 100000; // of a session
constexpr std::size_t maxLevels = 10000;  // of a health item
constexpr double near_s = 10, longestStep_m = 1, standing_mps = 0.02;
constexpr int longestText = 500, maxLater = 20;

/// Nobody's text is to look like a line of a report.
QString oneLine(const QString &text) {
    QString line = text.left(longestText);
    for (QChar &c : line)
        if (!c.isPrint())
            c = ' ';
    return line.size() < text.size() ? line + "..." : line;
}

/// How long after the last of them commands were summed up, in seconds.
double lateness(const SessionMessage &message, const WireValue &data) {
    constexpr double longest_s = 60;
    const double late_s = message.stamp - data["stamp"].number();
    return late_s >= 0 && late_s <= longest_s ? late_s : 0;
}

} // namespace

bool DriveHistory::wants(const QString &topic) {
    static const QSet<QString> names{"commands", "status", "log", "marks"};
    return topic == "motorcontrol/control" || topic == "motorcontrol/odometry" ||
           names.contains(topic.section('/', 1));
}

void DriveHistory::take(const SessionMessage &message) {
    last_s_ = std::max(last_s_, message.t_s);
    if (!wants(message.topic))
        return;
    const WireValue data = message.data();
    const QString name = message.name();
    if (name == "control")
        takeControl(message.t_s, data);
    else if (name == "odometry")
        takeOdometry(data);
    else if (name == "commands")
        takeCommand(message.t_s - lateness(message, data), message.daemon(), data);
    else if (name == "status")
        takeStatus(message.t_s, message.daemon(), data);
    else if (name == "log")
        takeLog(message.t_s, message.daemon(), data);
    else if (name == "marks" && marks_.size() < maxLines) {
        marks_.push_back({message.t_s, data["text"].text()});
        add(message.t_s, "mark: " + marks_.back().text);
    }
}

void DriveHistory::add(double t_s, const QString &text) {
    if (keepsEvents_ && events_.size() < maxEvents)
        events_.push_back({t_s, oneLine(text)});
}

void DriveHistory::takeControl(double t_s, const WireValue &data) {
    ReadReport report;
    const auto hold = readMessage<MotionHold>(data, report);
    if (!hold)
        return;
    const QString holder = hold->control.holder.value_or(QString());
    const bool drives = hold->halted.isEmpty() && hold->control.held;
    const bool isNews = hold->halted != reason_ || hold->cause != cause_;
    if (!std::exchange(isControlKnown_, true) && !drives) {
        // how it was before the session
    } else if (drives && holder != driver_) {
        if (!driver_.isEmpty()) // it stood for less than a message
            halt(t_s, "take-over", holder + " drives in place of " + driver_);
        add(t_s, holder + " drives");
        drive_ = Halt();
        drive_.driver = driver_ = holder;
        drive_.driven_from_s = t_s;
    } else if (!drives && !hold->halted.isEmpty() && isNews) {
        halt(t_s, hold->cause, hold->halted);
    } else if (!drives && hold->halted.isEmpty() && !driver_.isEmpty()) {
        halt(t_s, "restart", "motor control had ended, and began anew");
    }
    reason_ = hold->halted;
    cause_ = hold->cause;
}

// One that stood gets a halt of its own where it is the first fault since somebody drove.
void DriveHistory::halt(double t_s, const QString &cause, const QString &reason) {
    add(t_s, "halt: " + reason);
    const bool explains = !halts_.empty() && haltCause(halts_.back().cause).isFault() &&
                          halts_.back().speed_mps > standing_mps && t_s < halts_.back().t_s + near_s;
    if (!driver_.isEmpty() || (haltCause(cause).kind == HaltCause::Kind::Latched && !explains)) {
        drive_.t_s = t_s;
        drive_.cause = cause;
        drive_.reason = reason;
        drive_.speed_mps = driver_.isEmpty() ? 0 : speed_mps_;
        halts_.push_back(drive_);
    } else if (!halts_.empty() && halts_.back().later.size() < maxLater) {
        halts_.back().later.append(reason);
    }
    drive_ = Halt();
    driver_.clear();
}

void DriveHistory::takeOdometry(const WireValue &data) {
    ReadReport report;
    const auto odometry = readMessage<OdometryMessage>(data, report);
    if (!odometry)
        return;
    const double step = at_ ? std::hypot(odometry->pose.x - at_->x, odometry->pose.y - at_->y) : 0;
    const double speed = std::hypot(odometry->twist.vx, odometry->twist.vy);
    const double way = step < longestStep_m ? step : 0; // else it was reset
    drive_.way_m += way;
    driven_m_ = driven_m_.value_or(0) + way;
    drive_.fastest_mps = std::max(drive_.fastest_mps, speed);
    speed_mps_ = speed + std::abs(odometry->twist.omega);
    at_ = odometry->pose;
}

void DriveHistory::takeCommand(double t_s, const QString &daemon, const WireValue &data) {
    const double calls = data["calls"].number();
    const bool isRefused = data["error"].kind() != WireView::Kind::Undefined;
    const WireView params = data["params"];
    const QString client = data["client"].text(), method = data["method"].text();
    if (!isRefused && (method == "motor.stop" || method == "motor.estop") && stops_.size() < maxLines)
        stops_.append(QString("%1 s: %2 by %3").arg(t_s, 0, 'f', 2).arg(method, client));
    add(t_s, QString("%1 (%2) to %3: %4%5%6%7")
                 .arg(client, data["role"].text(), daemon, method,
                      params.size() > 0 ? ' ' + QString::fromUtf8(compactJson(params.toJson())) : QString(),
                      std::isfinite(calls) ? QString(", the last of %1 more").arg(calls) : QString(),
                      isRefused ? ", refused: " + data["message"].text() : QString()));
}

void DriveHistory::takeStatus(double t_s, const QString &daemon, const WireValue &data) {
    ReadReport report;
    const auto status = readMessage<DaemonStatus>(data, report);
    if (!status)
        return;
    QSet<QString> there;
    for (const HealthItem &item : status->health) {
        const QString name = daemon + ' ' + item.name;
        there.insert(name);
        std::vector<Level> &levels = health_[name];
        const bool isFirst = levels.empty();
        const QString before = isFirst ? "ok" : levels.back().level, message = oneLine(item.message);
        if (!keepsEvents_)
            levels.clear();
        if (levels.size() < maxLevels &&
            (levels.empty() || before != item.level || levels.back().message != message))
            levels.push_back({t_s, item.level, message});
        if (before == item.level)
            continue;
        add(t_s, QString("health of %1: %2: %3").arg(name, item.level, item.message));
        if (item.level == "error" && faults_.size() < maxLines)
            faults_.append(QString("%1 s: %2 error: %3").arg(t_s, 0, 'f', 2).arg(name, item.message));
    }
    for (auto item = health_.begin(); item != health_.end(); ++item)
        if (item.key().startsWith(daemon + ' ') && !there.contains(item.key()) && item->back().level != "ok")
            item->push_back({t_s, "ok", QString()}); // it is no more
}

void DriveHistory::takeLog(double t_s, const QString &daemon, const WireValue &data) {
    const QString level = data["level"].text();
    if (daemon == "recorder" && data["text"].text() == QString("motorcontrol") + goneText)
        halt(t_s, "gone", "motor control has ended, or does not answer any more");
    if (level != "debug")
        add(t_s,
            QString("log of %1: %2 %3: %4").arg(daemon, level, data["source"].text(), data["text"].text()));
}

const Halt *DriveHistory::lastFault() const {
    const Halt *best = nullptr;
    int bestRank = 0;
    for (const Halt &halt : halts_) {
        const HaltCause cause = haltCause(halt.cause);
        const bool counts = halt.speed_mps > standing_mps || cause.kind == HaltCause::Kind::Latched;
        const int rank = !cause.isFault() ? 0 : counts ? 2 : halt.driver.isEmpty() ? 0 : 1;
        if (rank > 0 && rank >= bestRank) {
            best = &halt;
            bestRank = rank;
        }
    }
    return best;
}

const Halt *DriveHistory::haltNear(double t_s) const {
    const Halt *best = nullptr;
    for (const Halt &halt : halts_)
        if (std::abs(halt.t_s - t_s) <= near_s &&
            (!best || std::abs(halt.t_s - t_s) < std::abs(best->t_s - t_s)))
            best = &halt;
    return best;
}

QStringList DriveHistory::wrongAt(double t_s) const {
    QStringList lines;
    for (auto item = health_.begin(); item != health_.end(); ++item) {
        const auto after = std::upper_bound(item->begin(), item->end(), t_s,
                                            [](double t, const Level &level) { return t < level.t_s; });
        if (after == item->begin() || std::prev(after)->level == "ok")
            continue;
        lines.append(
            QString("  %1: %2: %3").arg(item.key(), std::prev(after)->level, std::prev(after)->message));
    }
    return lines;
}

} // namespace hermes::recorder
