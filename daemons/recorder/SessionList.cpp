#include "daemons/recorder/SessionList.h"

#include <QHash>
#include <QJsonArray>
#include <QSet>
#include <algorithm>

namespace hermes::recorder {
namespace {

void add(RecordedSession &session, const SessionMember &member, const QJsonObject &entry) {
    if (session.members().contains(member.name)) // no logger has a recording twice
        return;
    session.start = session.parts.empty() ? entry["start"].toDouble()
                                          : std::min(session.start, entry["start"].toDouble());
    session.end = std::max(session.end, entry["end"].toDouble());
    session.parts.push_back({member, entry});
}

} // namespace

QString RecordedPart::fault() const {
    if (goesOn())
        return "being recorded";
    const QString ended = entry["ended"].toString();
    if (ended != "stopped")
        return ended;
    if (!entry["complete"].toBool())
        return "not complete";
    return sumOf(entry["losses"]) > 0 ? "lost: " + countsText(entry["losses"]) : QString();
}

QString RecordedSession::folder() const {
    for (const RecordedPart &part : parts)
        if (part.member.name == "recorder")
            return part.entry["folder"].toString();
    return parts.empty() ? QString() : parts.front().entry["folder"].toString();
}

double RecordedSession::bytes() const {
    double sum = 0;
    for (const RecordedPart &part : parts)
        sum += part.entry["bytes"].toDouble();
    return sum;
}

QStringList RecordedSession::members() const {
    QStringList names;
    for (const RecordedPart &part : parts)
        names.append(part.member.name);
    return names;
}

QStringList RecordedSession::faults() const {
    QStringList lines;
    for (const RecordedPart &part : parts)
        if (const QString fault = part.fault(); !fault.isEmpty())
            lines.append(part.member.name + ' ' + fault);
    return lines;
}

bool RecordedSession::goesOn() const {
    return std::any_of(parts.begin(), parts.end(), [](const RecordedPart &part) { return part.goesOn(); });
}

QStringList RecordedSession::absent() const {
    QSet<QString> expected, present;
    for (const RecordedPart &part : parts) {
        present.insert(part.member.name.section('@', 0, 0));
        for (const QJsonValue &logger : part.entry["loggers"].toArray())
            expected.insert(logger.toString());
    }
    QStringList lines;
    for (const QString &logger : expected - present)
        lines.append(logger + ": it took part, but does not answer or was not asked");
    return lines;
}

SessionList SessionList::of(const SessionReplies &replies) {
    SessionList list;
    QHash<QString, std::size_t> places;
    list.problems = complaints(replies);
    for (const SessionReply &reply : replies) {
        for (const QJsonValue &recording : reply.result ? reply.result->toArray() : QJsonArray()) {
            const QJsonObject entry = recording.toObject();
            const QString name = entry["name"].toString(), id = entry["session"].toString();
            if (entry.contains("error")) {
                list.problems.append(reply.member.name + ": " + name + ": " + entry["error"].toString());
                continue;
            }
            const auto place =
                places.insert(id + '/' + name, places.value(id + '/' + name, list.sessions.size()));
            if (*place == list.sessions.size())
                list.sessions.push_back({id, name, 0, 0, {}});
            add(list.sessions[*place], reply.member, entry);
        }
    }
    std::stable_sort(list.sessions.begin(), list.sessions.end(),
                     [](const RecordedSession &a, const RecordedSession &b) { return a.start > b.start; });
    return list;
}

QString countsText(const QJsonValue &counts) {
    const QJsonObject object = counts.toObject();
    QStringList list;
    for (auto count = object.begin(); count != object.end(); ++count)
        if (count.value().toDouble() != 0)
            list.append(QString("%1 %2").arg(count.key()).arg(count.value().toDouble(), 0, 'f', 0));
    return list.isEmpty() ? "nothing" : list.join(", ");
}

double sumOf(const QJsonValue &counts) {
    double sum = 0;
    for (const QJsonValue &count : counts.toObject())
        sum += count.toDouble();
    return sum;
}

} // namespace hermes::recorder
