#include "gui/session/SessionMarks.h"

#include <QJsonArray>
#include <algorithm>
#include <map>

namespace hermes {
namespace {

constexpr int maxMarks = 1000; // of a logger
constexpr double latest_s = 1e7;

} // namespace

void listMarks(
    const RecordedSession &session, std::chrono::milliseconds timeout, QObject *context,
    const std::function<void(const std::vector<SessionMark> &, const QStringList &problems)> &done) {
    std::vector<SessionCall> calls;
    std::map<QString, double> delays_s;
    for (const SessionPart &part : session.parts)
        if (part.member.listsMarks) {
            calls.push_back({part.member, {{"name", part.entry["name"]}}});
            delays_s[part.member.name] = part.entry["start"].toDouble() - session.start;
        }
    callAll(calls, "record.marks", timeout, context, [done, delays_s](const SessionReplies &replies) {
        std::vector<SessionMark> marks;
        for (const SessionReply &reply : replies) {
            const QJsonArray told = reply.result ? reply.result->toArray() : QJsonArray();
            for (int i = 0; i < std::min(told.size(), maxMarks); ++i) {
                const double own_s = told[i]["t_s"].toDouble(-1),
                             t_s = own_s + delays_s.at(reply.member.name);
                if (own_s >= 0 && t_s <= latest_s)
                    marks.push_back({t_s, told[i]["text"].toString()});
            }
        }
        std::stable_sort(marks.begin(), marks.end(),
                         [](const SessionMark &a, const SessionMark &b) { return a.t_s < b.t_s; });
        done(marks, complaints(replies));
    });
}

} // namespace hermes
