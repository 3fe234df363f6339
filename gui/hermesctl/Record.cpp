// hermesctl record: all loggers of a robot record as one session.
#include "common/Time.h"
#include "common/recording/SessionFolder.h"
#include "gui/hermesctl/Commands.h"
#include "gui/hermesctl/Sessions.h"
#include "gui/hermesctl/StopCheck.h"
#include "gui/hermesctl/Table.h"

#include <QDateTime>
#include <QJsonArray>
#include <QUuid>

namespace hermes {
namespace {

QString told(const Loggers &loggers, std::size_t number, const Error &error) {
    return loggers.name(number) + QStringLiteral(": ") + error.message;
}

Error problem(const QStringList &lines) {
    return Error(ErrorCode::NotReady, lines.join(QStringLiteral("; ")));
}

/// What is in the way of a new recording of this name.
QStringList obstacles(const Loggers &loggers, const QString &name) {
    QStringList lines;
    for (const QString &one : loggers.silent())
        lines.append(one + QStringLiteral(" (it may be a logger; --daemons names those to start)"));
    const Loggers::Replies states = loggers.call(QStringLiteral("record.status"));
    const Loggers::Replies lists = loggers.call(QStringLiteral("record.list"));
    for (std::size_t i = 0; i < loggers.size(); ++i) {
        if (!states[i] || !lists[i]) {
            lines.append(told(loggers, i, (states[i] ? lists[i] : states[i]).error()));
            continue;
        }
        if ((*states[i])[QStringLiteral("recording")].toBool())
            lines.append(QStringLiteral("%1 records \"%2\" already; hermesctl record stop ends it")
                             .arg(loggers.name(i), (*states[i])[QStringLiteral("name")].toString()));
        for (const QJsonValue &entry : lists[i]->toArray()) {
            if (entry[QStringLiteral("name")].toString() == name)
                lines.append(QStringLiteral("%1 has a recording \"%2\" already (%3)")
                                 .arg(loggers.name(i), name, entry[QStringLiteral("folder")].toString()));
        }
    }
    return lines;
}

/// Ends what was begun, or may have been, when one has refused.
Error takeBack(const Loggers &loggers, const QString &name, const Loggers::Replies &replies) {
    QStringList refusals, begun;
    Loggers::Numbers toStop;
    for (std::size_t i = 0; i < loggers.size(); ++i) {
        if (!replies[i])
            refusals.append(told(loggers, i, replies[i].error()));
        if (replies[i] || replies[i].error().is(ErrorCode::TimedOut))
            toStop.push_back(i);
    }
    const Loggers::Replies ends = loggers.call(toStop, QStringLiteral("record.stop"), {}, stopLimit);
    for (std::size_t i = 0; i < toStop.size(); ++i) {
        const Result<QJsonValue> &reply = replies[toStop[i]];
        if (ends[i])
            begun.append(QStringLiteral("%1 had begun and was stopped, see %2")
                             .arg(loggers.name(toStop[i]), (*ends[i])[QStringLiteral("folder")].toString()));
        else if (reply)
            begun.append(QStringLiteral("%1 had begun and could not be stopped: %2")
                             .arg(loggers.name(toStop[i]), ends[i].error().message));
    }
    return problem(QStringList(QStringLiteral("\"%1\" is not recorded").arg(name)) + refusals + begun);
}

QString seconds(double from, double to) {
    return QString::number(std::max(0.0, to - from), 'f', 1);
}

QString stateOf(const QJsonValue &status) {
    if (status[QStringLiteral("recording")].toBool())
        return QStringLiteral("recording");
    return status[QStringLiteral("error")].isObject() ? QStringLiteral("failed") : QStringLiteral("idle");
}

} // namespace

Result<void> recordStart(const Arguments &arguments) {
    const QString name = arguments.words.first();
    if (const Result<void> fine = checkName(QStringLiteral("NAME"), name); !fine)
        return fine;
    const Result<Loggers> loggers = Loggers::find(arguments);
    if (!loggers)
        return loggers.error();
    if (const QStringList lines = obstacles(*loggers, name); !lines.isEmpty())
        return problem(QStringList(QStringLiteral("nothing was begun")) + lines);
    const QJsonObject params{{QStringLiteral("name"), name},
                             {QStringLiteral("session"), QUuid::createUuid().toString(QUuid::WithoutBraces)}};
    const Loggers::Replies replies = loggers->call(QStringLiteral("record.start"), params);
    if (!std::all_of(replies.begin(), replies.end(), [](const auto &reply) { return reply.ok(); }))
        return takeBack(*loggers, name, replies);
    std::vector<QStringList> rows{{QStringLiteral("daemon"), QStringLiteral("records to")}};
    for (std::size_t i = 0; i < loggers->size(); ++i)
        rows.push_back({loggers->name(i), (*replies[i])[QStringLiteral("folder")].toString()});
    printTable(rows);
    return {};
}

Result<void> recordStop(const Arguments &arguments) {
    const Result<Loggers> loggers = Loggers::find(arguments);
    if (!loggers)
        return loggers.error();
    StopCheck check(*loggers);
    if (const Result<void> stopped = check.stop(); !stopped)
        return stopped;
    printTable(check.rows());
    return check.problems().isEmpty()
               ? Result<void>()
               : problem(QStringList(QStringLiteral("not all was recorded")) + check.problems());
}

Result<void> recordStatus(const Arguments &arguments) {
    const Result<Loggers> loggers = Loggers::find(arguments);
    if (!loggers)
        return loggers.error();
    std::vector<QStringList> rows{{QStringLiteral("daemon"), QStringLiteral("state"), QStringLiteral("name"),
                                   QStringLiteral("seconds"), QStringLiteral("bytes"),
                                   QStringLiteral("recorded"), QStringLiteral("lost")}};
    QStringList problems = loggers->silent();
    const Loggers::Replies replies = loggers->call(QStringLiteral("record.status"));
    for (std::size_t i = 0; i < replies.size(); ++i) {
        if (!replies[i]) {
            problems.append(told(*loggers, i, replies[i].error()));
            continue;
        }
        const QJsonObject status = replies[i]->toObject();
        QStringList row{loggers->name(i), stateOf(status)};
        if (status.contains(QStringLiteral("name"))) {
            const bool active = status[QStringLiteral("recording")].toBool();
            const double start = status[QStringLiteral("start")].toDouble();
            row << status[QStringLiteral("name")].toString()
                << (active ? seconds(start, stampNow()) : QStringLiteral("-"))
                << QString::number(status[QStringLiteral("bytes")].toDouble(), 'f', 0)
                << countsText(status[QStringLiteral("counts")].toObject())
                << countsText(status[QStringLiteral("losses")].toObject());
        }
        rows.push_back(row);
        if (status[QStringLiteral("error")].isObject())
            problems.append(loggers->name(i) + QStringLiteral(": ") +
                            status[QStringLiteral("error")][QStringLiteral("message")].toString());
    }
    printTable(rows);
    return problems.isEmpty() ? Result<void>() : problem(problems);
}

Result<void> recordList(const Arguments &arguments) {
    const Result<Loggers> loggers = Loggers::find(arguments);
    if (!loggers)
        return loggers.error();
    QStringList problems = loggers->silent();
    std::vector<QStringList> rows{{QStringLiteral("name"), QStringLiteral("start"), QStringLiteral("seconds"),
                                   QStringLiteral("bytes"), QStringLiteral("loggers"),
                                   QStringLiteral("state")}};
    for (const Session &session : findSessions(*loggers, problems)) {
        double bytes = 0;
        QStringList names, faults;
        for (const SessionPart &part : session.parts) {
            bytes += part.entry[QStringLiteral("bytes")].toDouble();
            names.append(loggers->name(part.logger));
            if (!part.fault().isEmpty())
                faults.append(names.last() + QLatin1Char(' ') + part.fault());
        }
        const QString start =
            QDateTime::fromMSecsSinceEpoch(qint64(session.start * 1e3)).toString(Qt::ISODate);
        rows.push_back({session.name, start,
                        session.end > 0 ? seconds(session.start, session.end) : QStringLiteral("-"),
                        QString::number(bytes, 'f', 0), names.join(QLatin1Char(',')),
                        faults.isEmpty() ? QStringLiteral("complete") : faults.join(QStringLiteral("; "))});
    }
    printTable(rows);
    return problems.isEmpty() ? Result<void>() : problem(problems);
}

} // namespace hermes
