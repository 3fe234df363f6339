#include "gui/desktop/model/SessionRecorder.h"

#include "common/Time.h"

#include <QUuid>
#include <memory>

namespace hermes {
namespace {

constexpr double rateOver_s = 10;

/// The entry of a session in the list, made when it is not there.
QJsonObject merged(QJsonObject session, const QJsonObject &recording, const QString &logger) {
    const bool isFirst = session.isEmpty();
    const double start = recording["start"].toDouble();
    QJsonArray parts = session["parts"].toArray();
    parts.append(QJsonObject{{"logger", logger}, {"start", recording["start"]}});
    return {{"name", recording["name"]},
            {"start", isFirst ? start : std::min(start, session["start"].toDouble())},
            {"end", std::max(recording["end"].toDouble(), session["end"].toDouble())},
            {"bytes", session["bytes"].toDouble() + recording["bytes"].toDouble()},
            {"complete", recording["complete"].toBool() && (isFirst || session["complete"].toBool())},
            {"parts", parts}};
}

/// Those that began last, at most so many.
std::vector<QJsonValue> newest(const QJsonArray &recordings, int most) {
    std::vector<std::pair<double, int>> starts;
    for (int i = 0; i < recordings.size(); ++i)
        starts.emplace_back(-recordings[i]["start"].toDouble(), i);
    const auto end = starts.begin() + std::min(int(starts.size()), most);
    std::partial_sort(starts.begin(), end, starts.end());
    std::vector<QJsonValue> result;
    for (auto one = starts.begin(); one != end; ++one)
        result.push_back(recordings[one->second]);
    return result;
}

} // namespace

double SessionRecorder::Logger::losses() const {
    double sum = 0;
    for (const QJsonValue &loss : status["losses"].toObject())
        sum += loss.toDouble();
    return sum;
}

SessionRecorder::SessionRecorder(Fleet &fleet, QObject *parent)
    : QObject(parent)
    , fleet_(fleet) {
    connect(&fleet, &Fleet::changed, this, &SessionRecorder::follow);
    connect(&fleet, &Fleet::robotChosen, this, &SessionRecorder::follow);
    connect(&timer_, &QTimer::timeout, this, &SessionRecorder::poll);
    timer_.start(std::chrono::seconds(1));
    follow();
}

void SessionRecorder::follow() {
    std::vector<Logger> found;
    if (const Robot *const robot = fleet_.robot())
        for (DaemonLink *daemon : robot->daemons())
            if (daemon->isConnected() && daemon->hasMethod("record.start"))
                found.push_back({daemon, {}});
    const bool isSame = std::equal(found.begin(), found.end(), loggers_.begin(), loggers_.end(),
                                   [](const Logger &a, const Logger &b) { return a.daemon == b.daemon; });
    if (isSame)
        return;
    loggers_ = std::move(found);
    progress_.clear();
    poll();
    list();
    Q_EMIT changed();
}

void SessionRecorder::poll() {
    for (const Logger &logger : loggers_) {
        if (!logger.daemon)
            continue;
        DaemonLink *const daemon = logger.daemon;
        daemon->call("record.status", {}, this, [this, daemon](const Result<QJsonValue> &status) {
            for (Logger &known : loggers_)
                if (known.daemon == daemon && status)
                    known.status = status->toObject();
            Q_EMIT changed();
        });
    }
    const double now = monotonicNow();
    if (!isRecording())
        return progress_.clear();
    progress_.emplace_back(now, bytes());
    while (progress_.front().first < now - rateOver_s)
        progress_.pop_front();
}

bool SessionRecorder::isRecording() const {
    return std::any_of(loggers_.begin(), loggers_.end(),
                       [](const Logger &logger) { return logger.isRecording(); });
}

QString SessionRecorder::name() const {
    for (const Logger &logger : loggers_)
        if (logger.isRecording())
            return logger.status["name"].toString();
    return {};
}

double SessionRecorder::bytes() const {
    double sum = 0;
    for (const Logger &logger : loggers_)
        if (logger.isRecording())
            sum += logger.status["bytes"].toDouble();
    return sum;
}

double SessionRecorder::seconds() const {
    double longest = 0;
    for (const Logger &logger : loggers_)
        if (logger.isRecording())
            longest = std::max(longest, stampNow() - logger.status["start"].toDouble());
    return longest;
}

double SessionRecorder::rate() const {
    if (progress_.size() < 2)
        return 0;
    const auto &[t0, bytes0] = progress_.front();
    const auto &[t1, bytes1] = progress_.back();
    return t1 > t0 ? std::max(0.0, bytes1 - bytes0) / (t1 - t0) : 0;
}

double SessionRecorder::secondsLeft() const {
    double least = -1;
    for (const Logger &logger : loggers_)
        if (const QJsonValue free = logger.status["free_bytes"]; free.isDouble())
            least = least < 0 ? free.toDouble() : std::min(least, free.toDouble());
    return least < 0 || rate() <= 0 ? -1 : least / rate();
}

void SessionRecorder::start(const QString &name) {
    if (loggers_.empty())
        return Q_EMIT told(tr("No logger is connected."), true);
    struct Round {
        std::size_t waiting;
        std::vector<QPointer<DaemonLink>> started;
        QStringList refusals;
    };
    const auto round = std::make_shared<Round>();
    round->waiting = loggers_.size();
    const QJsonObject params{{"name", name}, {"session", QUuid::createUuid().toString(QUuid::WithoutBraces)}};
    for (const Logger &logger : loggers_) {
        DaemonLink *const daemon = logger.daemon;
        daemon->call("record.start", params, this, [=](const Result<QJsonValue> &result) {
            if (result)
                round->started.push_back(daemon);
            else
                round->refusals.append(daemon->name() + ": " + result.error().message);
            if (--round->waiting > 0)
                return;
            if (round->refusals.isEmpty())
                Q_EMIT told(tr("Recording %1.").arg(name), false);
            else
                undo(round->started);
            if (!round->refusals.isEmpty())
                Q_EMIT told(tr("Nothing is recorded. %1").arg(round->refusals.join("; ")), true);
            poll();
        });
    }
}

void SessionRecorder::undo(const std::vector<QPointer<DaemonLink>> &started) {
    for (const QPointer<DaemonLink> &daemon : started)
        if (daemon)
            daemon->call("record.stop", {}, this, [this](const Result<QJsonValue> &) { list(); });
}

void SessionRecorder::stop() {
    for (const Logger &logger : loggers_) {
        if (!logger.daemon || !logger.isRecording())
            continue;
        DaemonLink *const daemon = logger.daemon;
        daemon->call("record.stop", {}, this, [this, daemon](const Result<QJsonValue> &result) {
            const double lost = result ? Logger{daemon, result->toObject()}.losses() : 0;
            if (!result)
                Q_EMIT told(daemon->name() + ": " + result.error().message, true);
            else
                Q_EMIT told(lost > 0 ? tr("%1: stopped, %2 missing").arg(daemon->name()).arg(lost)
                                     : tr("%1: stopped, nothing missing").arg(daemon->name()),
                            lost > 0);
            poll();
            list();
        });
    }
}

void SessionRecorder::list() {
    const auto found = std::make_shared<QMap<QString, QJsonObject>>();
    unlisted_ = 0;
    for (const Logger &logger : loggers_) {
        if (!logger.daemon)
            continue;
        const QString loggerName = logger.daemon->name();
        logger.daemon->callForMuch("record.list", {}, this, [=](const Result<QJsonValue> &result) {
            if (!result)
                return;
            const std::vector<QJsonValue> recordings = newest(result->toArray(), mostRecordings);
            unlisted_ += result->toArray().size() - int(recordings.size());
            for (const QJsonValue &recording : recordings) {
                const QString key = recording["session"].toString() + recording["name"].toString();
                (*found)[key] = merged(found->value(key), recording.toObject(), loggerName);
            }
            QList<QJsonObject> sorted = found->values();
            std::sort(sorted.begin(), sorted.end(), [](const QJsonObject &a, const QJsonObject &b) {
                return a["start"].toDouble() > b["start"].toDouble();
            });
            sessions_ = {};
            for (const QJsonObject &session : qAsConst(sorted))
                sessions_.append(session);
            Q_EMIT changed();
        });
    }
}

} // namespace hermes
