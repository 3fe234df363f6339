// hermesctl record: all loggers of a robot record as one session.
#include "common/Time.h"
#include "common/recording/RecordingName.h"
#include "gui/hermesctl/Commands.h"
#include "gui/hermesctl/Loggers.h"
#include "gui/hermesctl/Table.h"
#include "gui/hermesctl/Waiting.h"
#include "gui/hermesctl/WrongItems.h"
#include "gui/session/SessionRecorder.h"

#include <QDateTime>
#include <QJsonArray>

namespace hermes::ctl {
namespace {

QString seconds(double from, double to) {
    return QString::number(std::max(0.0, to - from), 'f', 1);
}

QString bytesText(double bytes) {
    return QString::number(bytes, 'f', 0);
}

QString stampText(double stamp, Qt::DateFormat format) {
    return QDateTime::fromMSecsSinceEpoch(qint64(stamp * 1e3)).toString(format);
}

Result<void> problemOf(const QStringList &lines) {
    return lines.isEmpty() ? Result<void>() : Error(ErrorCode::NotReady, lines.join("; "));
}

QString stateOf(const QJsonValue &status) {
    if (status["recording"].toBool())
        return "recording";
    return status["error"].isObject() ? "failed" : "idle";
}

QStringList statusRow(const QString &logger, const QJsonValue &status) {
    QStringList row{logger, stateOf(status)};
    if (!status["name"].isString())
        return row;
    const bool active = status["recording"].toBool();
    return row << status["name"].toString()
               << (active ? seconds(status["start"].toDouble(), stampNow()) : QString("-"))
               << bytesText(status["bytes"].toDouble()) << countsText(status["counts"])
               << countsText(status["losses"]);
}

/// What a daemon gave, and its name.
QJsonObject named(const QString &daemon, const QJsonObject &value) {
    QJsonObject result = value;
    result.insert("daemon", daemon);
    return result;
}

/// What a recorder with all loggers gives, a Result.
template <typename T, typename Begin>
T ask(const Loggers &loggers, const Begin &begin) {
    const Waiting waiting(SessionRecorder::stopLimit); // the longest wait of all
    SessionRecorder recorder(loggers.members);
    return await<T>([&](auto done) { begin(recorder, done); });
}

/// The same; or why they are not found.
template <typename T, typename Begin>
T ask(const Arguments &arguments, const Begin &begin) {
    const Result<Loggers> loggers = Loggers::find(arguments);
    return loggers ? ask<T>(*loggers, begin) : T(loggers.error());
}

/// A note for whatever is not well with loggers that record: they may record nothing.
void noteWhatIsWrong(const SessionMembers &members) {
    for (const SessionReply &status :
         callAllAndWait(callsOf(members.all), "daemon.status", members.timeout)) {
        if (!status.result)
            note(status.complaint());
        for (const QJsonValue &item : wrongItems(status))
            note(printable(status.member.name + ": " + wrongText(item)));
    }
}

/// A table of a member of each reply.
Result<void> printReplies(const Arguments &arguments, const Result<SessionReplies> &replies,
                          const QString &title, const std::function<QString(const QJsonValue &)> &text) {
    if (!replies)
        return replies.error();
    std::vector<QStringList> rows{{"daemon", title}};
    QJsonArray values;
    for (const SessionReply &reply : *replies) {
        rows.push_back({reply.member.name, text(*reply.result)});
        values.append(named(reply.member.name, reply.result->toObject()));
    }
    arguments.json ? printJson(values) : printTable(rows);
    return {};
}

QJsonObject asJson(const RecordedSession &session) {
    return {{"id", session.id},
            {"name", session.name},
            {"start", session.start},
            {"end", session.end > 0 ? QJsonValue(session.end) : QJsonValue()},
            {"bytes", session.bytes()},
            {"loggers", QJsonArray::fromStringList(session.members())},
            {"faults", QJsonArray::fromStringList(session.faults())}};
}

} // namespace

Result<void> recordStart(const Arguments &arguments) {
    const QString name = arguments.words.first();
    if (const Result<void> fine = checkName("NAME", name); !fine)
        return fine;
    const Result<Loggers> loggers = Loggers::find(arguments);
    if (!loggers)
        return loggers.error();
    const auto replies = ask<Result<SessionReplies>>(
        *loggers, [&](SessionRecorder &recorder, auto done) { recorder.start(name, done); });
    const auto printed = printReplies(arguments, replies, "records to",
                                      [](const QJsonValue &begun) { return begun["folder"].toString(); });
    if (replies)
        noteWhatIsWrong(loggers->members);
    return printed;
}

Result<void> recordMark(const Arguments &arguments) {
    const auto replies = ask<Result<SessionReplies>>(arguments, [&](SessionRecorder &recorder, auto done) {
        recorder.mark(arguments.words.first(), done);
    });
    return printReplies(arguments, replies, "marked at", [](const QJsonValue &mark) {
        return stampText(mark["stamp"].toDouble(), Qt::ISODateWithMs);
    });
}

Result<void> recordStop(const Arguments &arguments) {
    const auto stopped = ask<Result<SessionRecorder::Stopped>>(
        arguments, [](SessionRecorder &recorder, auto done) { recorder.stop(done); });
    if (!stopped)
        return stopped.error();
    std::vector<QStringList> rows{{"daemon", "name", "seconds", "files", "bytes", "recorded", "lost"}};
    QJsonArray values;
    for (const RecordedSession &session : stopped->sessions)
        for (const SessionPart &part : session.parts) {
            values.append(named(part.member.name, part.entry));
            rows.push_back({part.member.name, session.name,
                            seconds(part.entry["start"].toDouble(), part.entry["end"].toDouble()),
                            QString::number(part.entry["files"].toInt()),
                            bytesText(part.entry["bytes"].toDouble()), countsText(part.entry["counts"]),
                            countsText(part.entry["losses"])});
        }
    arguments.json ? printJson(values) : printTable(rows);
    return stopped->problems.isEmpty() ? Result<void>()
                                       : sessionError("not all was recorded", stopped->problems);
}

Result<void> recordStatus(const Arguments &arguments) {
    const auto status = ask<Result<SessionRecorder::States>>(
        arguments, [](SessionRecorder &recorder, auto done) { recorder.status(done); });
    if (!status)
        return status.error();
    std::vector<QStringList> rows{{"daemon", "state", "name", "seconds", "bytes", "recorded", "lost"}};
    QJsonArray values;
    QStringList problems = status->problems;
    for (const SessionReply &reply : status->replies) {
        if (!reply.result)
            continue;
        rows.push_back(statusRow(reply.member.name, *reply.result));
        values.append(named(reply.member.name, reply.result->toObject()));
        if (const QJsonValue error = (*reply.result)["error"]; error.isObject())
            problems.append(reply.member.name + ": " + error["message"].toString());
    }
    arguments.json ? printJson(values) : printTable(rows);
    return problemOf(problems);
}

Result<void> recordList(const Arguments &arguments) {
    const auto list = ask<Result<SessionList>>(
        arguments, [](SessionRecorder &recorder, auto done) { recorder.list(0, done); });
    if (!list)
        return list.error();
    std::vector<QStringList> rows{{"name", "start", "seconds", "bytes", "loggers", "state"}};
    QJsonArray values;
    for (const RecordedSession &session : list->sessions) {
        const QStringList faults = session.faults();
        rows.push_back({session.name, stampText(session.start, Qt::ISODate),
                        session.end > 0 ? seconds(session.start, session.end) : QString("-"),
                        bytesText(session.bytes()), session.members().join(','),
                        faults.isEmpty() ? "complete" : faults.join("; ")});
        values.append(asJson(session));
    }
    arguments.json ? printJson(values) : printTable(rows);
    return problemOf(list->problems);
}

} // namespace hermes::ctl
