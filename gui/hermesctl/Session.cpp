// hermesctl session: the recorder of the robot records, replays and tells of sessions.
#include "common/progress/Progress.h"
#include "gui/hermesctl/Commands.h"

#include <QDateTime>
#include <QJsonArray>
#include <QLocale>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace hermes::ctl {
namespace {

QJsonObject paramsOf(const Arguments &arguments) {
    const auto list = [](const QStringList &words) { return QJsonArray::fromStringList(words); };
    const std::map<QString, std::pair<const char *, QJsonValue>> options{
        {"--daemons", {"what", list(arguments.daemons)}},
        {"--count", {"max", arguments.count}},
        {"--speed", {"speed", arguments.speed}},
        {"--from", {"from_s", arguments.from_s}},
        {"--loop", {"loop", true}},
        {"--without", {"without", list(arguments.without)}},
        {"--at", {"at_s", arguments.at_s}},
        {"--format", {"format", arguments.format}},
        {"--profile", {"profile", arguments.profile}},
        {"--topics", {"topics", list(arguments.topics)}},
        {"--yes", {"confirm", true}}};
    QJsonObject params;
    for (const QString &name : arguments.given)
        if (const auto option = options.find(name); option != options.end())
            params.insert(option->second.first, option->second.second);
    const bool isMark = arguments.command == "session mark";
    for (int i = 1; i < arguments.words.size(); ++i) // after the recorder
        params.insert(i > 1 ? "to" : isMark ? "text" : "name", arguments.words[i]);
    return params;
}

/// What a table tells of sessions and their parts, in this order: the member, and its heading where it has
/// another name.
const char *const columns =
    "daemon,topic,t_s|at [s],text|mark,name|session,state,position_s|at [s],start,end,duration_s|duration "
    "[s],driven_m|driven [m],speed,paused,loop,bytes|size,free_bytes|free,left_s|full in "
    "[h],counts|recorded,losses|lost,messages,lost,rate_hz|rate [Hz],longest_gap_s|gap [s],daemons,problems";

qint64 whole(double value) {
    constexpr double most = 1e15;
    return qint64(std::clamp(value, -most, most));
}

QString numberText(double value) {
    return QString::number(value, 'f', value == std::floor(value) ? 0 : 2);
}

QStringList textsOf(const QJsonValue &list) {
    return list.toVariant().toStringList();
}

QString cellText(const QString &member, const QJsonValue &value) {
    if (value.isObject()) {
        QStringList counts;
        const QJsonObject all = value.toObject();
        for (auto count = all.begin(); count != all.end(); ++count)
            if (count->toDouble() != 0)
                counts.append(count.key() + ' ' + numberText(count->toDouble()));
        return counts.isEmpty() ? "nothing" : counts.join(", ");
    }
    if (value.isArray())
        return textsOf(value).join(", ");
    if (!value.isDouble())
        return value.toVariant().toString();
    if (member == "left_s")
        return QString::number(value.toDouble() / 3600, 'f', 1);
    if (member == "start" || member == "end") // 0: nothing has begun
        return value.toDouble() > 0
                   ? QDateTime::fromMSecsSinceEpoch(whole(value.toDouble() * 1e3)).toString(Qt::ISODate)
                   : QString();
    if (member.endsWith("bytes"))
        return QLocale::c().formattedDataSize(whole(value.toDouble()), 1, QLocale::DataSizeSIFormat);
    return numberText(value.toDouble());
}

/// Of objects, the columns that are not empty in all of them.
void printObjects(const QJsonArray &objects) {
    std::vector<QStringList> rows(std::size_t(objects.size()) + 1);
    for (const QString &column : QString(columns).split(',')) {
        const QString member = column.section('|', 0, 0);
        QStringList cells;
        for (const QJsonValue &object : objects)
            cells.append(cellText(member, object[member]));
        if (cells.join(QString()).isEmpty())
            continue;
        rows[0].append(column.section('|', -1));
        for (int i = 0; i < cells.size(); ++i)
            rows[std::size_t(i) + 1].append(printable(cells[i].isEmpty() ? "-" : cells[i]));
    }
    if (!rows[0].isEmpty())
        printTable(rows);
}

/// What the recorder has answered, for people.
void show(const QJsonValue &reply) {
    if (reply.isArray())
        return printObjects(reply.toArray());
    QJsonObject head = reply["summary"].isObject() ? reply["summary"].toObject() : reply.toObject();
    for (const char *member : {"duration_s", "driven_m"})
        if (const QJsonValue value = reply[QLatin1String(member)]; value.isDouble())
            head.insert(member, value);
    if (head.contains("state"))
        head.remove("problems"); // are told beside the table
    printObjects({head});
    if (reply["replay"].isObject())
        printObjects({reply["replay"]});
    for (const char *member : {"parts", "topics", "marks"})
        printObjects(reply[QLatin1String(member)].toArray());
    for (const auto &[member, title] :
         {std::pair("stops", "stop"), {"faults", "fault"}, {"silent", "silent"}})
        for (const QString &line : textsOf(reply[QLatin1String(member)]))
            printLine(QString("%1: %2").arg(title, line));
}

/// Why a session is not as it should be; no lines: it is.
Result<void> sessionResult(const QStringList &lines, const QString &what = {}) {
    return lines.isEmpty() ? Result<void>() : Error(ErrorCode::NotReady, what + lines.join("; "));
}

void noteAll(const QStringList &lines) {
    for (const QString &line : lines)
        note(line);
}

/// Shows a replay until its end, a signal, or until nobody reads any more; then all is live.
Result<void> showReplay(Client &recorder, const Arguments &arguments, const QString &name) {
    QEventLoop loop;
    std::optional<Result<void>> end;
    const auto finish = [&](const Result<void> &result) {
        end = result;
        loop.quit();
    };
    QObject::connect(&recorder, &Client::disconnected, &loop,
                     [&](const QString &why) { finish(Error(ErrorCode::Disconnected, why)); });
    std::optional<Progress> progress;
    double last_s = 0;
    QStringList told; // what does not end it
    const int handle = recorder.subscribe("session", {}, [&](const TopicUpdate &update) {
        const QJsonValue state = update.json(), replay = state["replay"];
        QStringList news = textsOf(state["problems"]);
        for (const QString &line : qAsConst(told))
            news.removeAll(line);
        if (!replay.isObject() || state["name"].toString() != name)
            return finish(sessionResult(news));
        noteAll(news);
        told += news;
        if (arguments.json)
            printJson(state);
        const double now_s = replay["position_s"].toDouble();
        if (!progress || now_s < std::exchange(last_s, now_s)) // it began anew
            progress.emplace("replaying, second");
        progress->update(now_s, replay["duration_s"].toDouble());
    });
    runStream(loop);
    recorder.unsubscribe(handle);
    if (end)
        return *end;
    const auto live = askAgain(recorder, arguments, "session.live", {});
    return live ? Result<void>() : live.error();
}

} // namespace

Result<void> session(Client &recorder, const Arguments &arguments) {
    const QString word = arguments.command.section(' ', 1);
    const auto reply =
        askAgain(recorder, arguments, "session." + (word == "status" ? "state" : word), paramsOf(arguments));
    if (!reply)
        return reply.error();
    if (word == "replay" && !arguments.detach)
        return showReplay(recorder, arguments, (*reply)["name"].toString());
    if (arguments.json)
        printJson(*reply);
    else if (word == "explain")
        printLine((*reply)["text"].toString().trimmed());
    else if (word == "export")
        printLine(textsOf((*reply)["paths"]).join('\n'));
    else
        show(*reply);
    if (word == "start")
        noteAll(textsOf((*reply)["notes"]));
    const QStringList problems = textsOf((*reply)["problems"]);
    if (word == "stop" || word == "status")
        return sessionResult(problems, word == "stop" ? "not all was recorded; " : "");
    if (word != "rename")
        noteAll(problems);
    return {};
}

} // namespace hermes::ctl
