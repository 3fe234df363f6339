#include "gui/hermesctl/StopCheck.h"

namespace hermes {

/// Those that record; and where none does, the sessions that were ended by an error are found.
Loggers::Numbers StopCheck::active() {
    Loggers::Numbers numbers;
    QSet<QString> failed;
    const Loggers::Replies states = loggers_.call(QStringLiteral("record.status"));
    for (std::size_t i = 0; i < states.size(); ++i) {
        if (!states[i]) {
            problems_.append(loggers_.name(i) + QStringLiteral(": ") + states[i].error().message);
            continue;
        }
        const QString session = (*states[i])[QStringLiteral("session")].toString();
        if ((*states[i])[QStringLiteral("recording")].toBool()) {
            numbers.push_back(i);
            sessions_.insert(session);
        } else if ((*states[i])[QStringLiteral("error")].isObject()) {
            failed.insert(session);
        }
    }
    if (sessions_.isEmpty())
        sessions_ = failed;
    return numbers;
}

Result<void> StopCheck::stop() {
    problems_ = loggers_.silent();
    const Loggers::Numbers numbers = active();
    if (sessions_.isEmpty() && problems_.isEmpty())
        return Error(ErrorCode::NotReady, QStringLiteral("nothing is being recorded"));
    const Loggers::Replies ends = loggers_.call(numbers, QStringLiteral("record.stop"), {}, stopLimit);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        ends_.insert({numbers[i], ends[i]});
        if (!ends[i])
            problems_.append(loggers_.name(numbers[i]) + QStringLiteral(": ") + ends[i].error().message);
    }
    rows_ = {{QStringLiteral("daemon"), QStringLiteral("name"), QStringLiteral("seconds"),
              QStringLiteral("files"), QStringLiteral("bytes"), QStringLiteral("recorded"),
              QStringLiteral("lost")}};
    QStringList unread; // of other sessions, which are not the matter here
    for (const Session &session : findSessions(loggers_, unread)) {
        if (sessions_.contains(session.id))
            verify(session);
    }
    for (const auto &[number, end] : ends_) {
        if (end)
            problems_.append(loggers_.name(number) + QStringLiteral(": its sidecar cannot be read; ") +
                             unread.join(QStringLiteral("; ")));
    }
    return {};
}

void StopCheck::verify(const Session &session) {
    for (const SessionPart &part : session.parts)
        verify(session, part);
    problems_ += absentLoggers(loggers_, session);
}

void StopCheck::verify(const Session &session, const SessionPart &part) {
    const QJsonObject &entry = part.entry;
    rows_.push_back(
        {loggers_.name(part.logger), session.name,
         QString::number(entry[QStringLiteral("end")].toDouble() - entry[QStringLiteral("start")].toDouble(),
                         'f', 1),
         QString::number(entry[QStringLiteral("files")].toInt()),
         QString::number(entry[QStringLiteral("bytes")].toDouble(), 'f', 0),
         countsText(entry[QStringLiteral("counts")].toObject()),
         countsText(entry[QStringLiteral("losses")].toObject())});
    if (const QString fault = part.fault(); !fault.isEmpty())
        problems_.append(loggers_.name(part.logger) + QStringLiteral(": ") + fault);
    const auto end = ends_.find(part.logger);
    if (end == ends_.end() || !end->second)
        return;
    for (const char *member : {"files", "bytes", "counts", "losses"}) {
        const QJsonValue told = (*end->second)[QLatin1String(member)];
        if (told != entry[QLatin1String(member)])
            problems_.append(QStringLiteral("%1: its %2 at the end and in its sidecar are not the same")
                                 .arg(loggers_.name(part.logger), QLatin1String(member)));
    }
    ends_.erase(end);
}

} // namespace hermes
