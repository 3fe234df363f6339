#include "daemons/recorder/SessionList.h"

#include "protocol/wire/Fields.h"

#include <QHash>
#include <QJsonArray>
#include <QSet>
#include <algorithm>

namespace hermes::recorder {
namespace {

/// A number of a daemon that is to be summed up.
double believed(double number) {
    return std::clamp(number, 0.0, 1e18);
}

NamedCounts believed(const std::optional<NamedCounts> &told) {
    NamedCounts counts = told.value_or(NamedCounts());
    for (double &count : counts)
        count = believed(count);
    return counts;
}

/// How long after another a recording began: by the clock that both have, else by those of their hosts.
double secondsBetween(const RecordingEntry &earlier, const RecordingEntry &later) {
    const bool isSameClock = !earlier.boot.value_or(QString()).isEmpty() && earlier.boot == later.boot &&
                             earlier.start_mono && later.start_mono;
    return isSameClock ? *later.start_mono - *earlier.start_mono
                       : later.start.value_or(0) - earlier.start.value_or(0);
}

} // namespace

QString RecordedPart::problem() const {
    if (goesOn())
        return "being recorded";
    if (!error.isEmpty())
        return error;
    if (ended() != "stopped" && ended() != "shut down")
        return ended();
    if (!entry.complete.value_or(false))
        return "not complete";
    QStringList lost;
    const NamedCounts losses = entry.losses.value_or(NamedCounts());
    for (auto loss = losses.begin(); loss != losses.end(); ++loss)
        if (*loss != 0)
            lost.append(QString("%1 %2").arg(loss.key()).arg(*loss, 0, 'f', 0));
    return lost.isEmpty() ? QString() : "lost: " + lost.join(", ");
}

SessionPart RecordedPart::summary() const {
    return sessionPart(member.name, goesOn() ? "recording" : ended(), problem(), entry.bytes, entry.counts,
                       entry.losses);
}

SessionPart sessionPart(const QString &daemon, const QString &state, const QString &problem,
                        std::optional<double> bytes, const std::optional<NamedCounts> &counts,
                        const std::optional<NamedCounts> &losses) {
    return {daemon, state, believed(bytes.value_or(0)), believed(counts), believed(losses), problem};
}

void RecordedSession::add(RecordedPart part) {
    if (members().contains(part.member.name))
        return;
    const RecordingEntry &entry = part.entry;
    const double start_s = entry.start.value_or(0), end_s = entry.end.value_or(std::nullopt).value_or(0);
    if (!parts.empty())
        part.offset_s = parts.front().offset_s + secondsBetween(parts.front().entry, entry);
    if (parts.empty() || part.offset_s < 0) { // the first of them, as far as it is known
        start = start_s;
        for (RecordedPart &other : parts)
            other.offset_s -= part.offset_s;
        duration_s -= part.offset_s;
        part.offset_s = 0;
    }
    duration_s =
        std::max(duration_s, part.offset_s + entry.duration_s.value_or(std::max(0.0, end_s - start_s)));
    end = std::max(end, end_s);
    parts.push_back(part);
}

QString RecordedSession::folder() const {
    for (const RecordedPart &part : parts)
        if (part.member.name == "recorder")
            return part.entry.folder.value_or(QString());
    return parts.empty() ? QString() : parts.front().entry.folder.value_or(QString());
}

QStringList RecordedSession::members() const {
    QStringList names;
    for (const RecordedPart &part : parts)
        names.append(part.member.name);
    return names;
}

QStringList RecordedSession::problems() const {
    QStringList lines;
    QSet<QString> expected, present;
    for (const RecordedPart &part : parts) {
        const QString problem = part.problem();
        const QString line = part.goesOn() ? problem : part.member.name + ": " + problem;
        if (!problem.isEmpty() && !lines.contains(line)) // all are being recorded: told once
            lines.append(line);
        present.insert(part.member.name.section('@', 0, 0));
        for (const QString &logger : part.entry.loggers.value_or(QStringList()))
            expected.insert(logger);
    }
    for (const QString &logger : expected - present)
        lines.append(logger + ": it took part, but does not answer or was not asked");
    return lines;
}

bool RecordedSession::goesOn() const {
    return std::any_of(parts.begin(), parts.end(), [](const RecordedPart &part) { return part.goesOn(); });
}

SessionSummary RecordedSession::summary() const {
    SessionSummary summary{name, id, start, {}, 0, members(), problems()};
    for (const RecordedPart &part : parts)
        summary.bytes += part.summary().bytes;
    if (!goesOn()) {
        summary.end = end;
        summary.duration_s = duration_s;
    }
    return summary;
}

SessionList SessionList::of(const SessionReplies &replies) {
    SessionList list;
    QHash<QString, std::size_t> places;
    list.problems = complaints(replies);
    for (const SessionReply &reply : replies) {
        for (const QJsonValue &recording : reply.result ? reply.result->toArray() : QJsonArray()) {
            ReadReport report;
            const auto entry = readMessage<RecordingEntry>(WireValue(recording), report);
            if (!entry || entry->error) {
                list.problems.append(reply.member.name + ": " + recording["name"].toString() + ": " +
                                     (entry ? *entry->error : report.text()));
                continue;
            }
            const QString id = entry->session.value_or(QString());
            const auto place = places.insert(id + '/' + entry->name,
                                             places.value(id + '/' + entry->name, list.sessions.size()));
            if (*place == list.sessions.size())
                list.sessions.push_back({id, entry->name});
            list.sessions[*place].add({reply.member, *entry});
        }
    }
    std::stable_sort(list.sessions.begin(), list.sessions.end(),
                     [](const RecordedSession &a, const RecordedSession &b) { return a.start > b.start; });
    return list;
}

} // namespace hermes::recorder
