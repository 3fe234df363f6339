#include "gui/hermesctl/Sessions.h"

#include <QJsonArray>
#include <QSet>
#include <algorithm>

namespace hermes {

double SessionPart::lost() const {
    double sum = 0;
    const QJsonObject losses = entry[QStringLiteral("losses")].toObject();
    for (const QJsonValue &count : losses)
        sum += count.toDouble();
    return sum;
}

QString SessionPart::fault() const {
    const QJsonValue ended = entry[QStringLiteral("ended")];
    if (!ended.isString())
        return QStringLiteral("being recorded");
    if (ended.toString() != QStringLiteral("stopped"))
        return ended.toString();
    if (!entry[QStringLiteral("complete")].toBool())
        return QStringLiteral("not complete");
    return lost() > 0 ? QStringLiteral("lost: ") + countsText(entry[QStringLiteral("losses")].toObject())
                      : QString();
}

std::vector<Session> findSessions(const Loggers &loggers, QStringList &problems) {
    std::vector<Session> sessions;
    const Loggers::Replies lists = loggers.call(QStringLiteral("record.list"));
    for (std::size_t number = 0; number < lists.size(); ++number) {
        if (!lists[number]) {
            problems.append(loggers.name(number) + QStringLiteral(": ") + lists[number].error().message);
            continue;
        }
        for (const QJsonValue &value : lists[number]->toArray()) {
            const QJsonObject entry = value.toObject();
            const QString name = entry[QStringLiteral("name")].toString();
            const QString id = entry[QStringLiteral("session")].toString();
            if (entry.contains(QStringLiteral("error"))) {
                problems.append(loggers.name(number) + QStringLiteral(": ") + name + QStringLiteral(": ") +
                                entry[QStringLiteral("error")].toString());
                continue;
            }
            const double start = entry[QStringLiteral("start")].toDouble();
            const double end = entry[QStringLiteral("end")].toDouble();
            const auto same = [&](const Session &session) { return session.id == id; };
            auto found = std::find_if(sessions.begin(), sessions.end(), same);
            if (found == sessions.end())
                found = sessions.insert(found, {id, name, start, end, {}});
            found->start = std::min(found->start, start);
            found->end = std::max(found->end, end);
            found->parts.push_back({number, entry});
        }
    }
    std::stable_sort(sessions.begin(), sessions.end(),
                     [](const Session &a, const Session &b) { return a.start > b.start; });
    return sessions;
}

QStringList absentLoggers(const Loggers &loggers, const Session &session) {
    QSet<QString> expected, present;
    for (const SessionPart &part : session.parts) {
        present.insert(loggers.name(part.logger).section(QLatin1Char('@'), 0, 0));
        for (const QJsonValue &logger : part.entry[QStringLiteral("loggers")].toArray())
            expected.insert(logger.toString());
    }
    QStringList lines;
    for (const QString &logger : expected - present)
        lines.append(QStringLiteral("%1: it took part, but does not answer").arg(logger));
    return lines;
}

QString countsText(const QJsonObject &counts) {
    QStringList list;
    for (auto count = counts.begin(); count != counts.end(); ++count) {
        if (count.value().toDouble() != 0)
            list.append(QStringLiteral("%1 %2").arg(count.key()).arg(count.value().toDouble(), 0, 'f', 0));
    }
    return list.isEmpty() ? QStringLiteral("nothing") : list.join(QStringLiteral(", "));
}

} // namespace hermes
