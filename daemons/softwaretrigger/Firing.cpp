#include "daemons/softwaretrigger/Firing.h"

#include "daemons/softwaretrigger/FiringLog.h"
#include "protocol/wire/JsonText.h"

#include <algorithm>

namespace hermes {
namespace {

constexpr int largestResult = 1000; // bytes of JSON; a larger result is not repeated

QJsonObject actionJson(const Firing::ActionResult &one) {
    QJsonObject json{{"action", one.action}, {"ok", one.result.ok()}, {"duration_s", one.duration_s}};
    if (!one.result) {
        const Error &error = one.result.error();
        json.insert("error", QJsonObject{{"code", error.code}, {"message", error.message}});
    } else if (compactJson(*one.result).size() <= largestResult) {
        json.insert("result", *one.result);
    }
    return json;
}

} // namespace

double Firing::late_s() const {
    if (occasion.dueMono)
        return mono - *occasion.dueMono;
    return occasion.dueStamp ? stamp - *occasion.dueStamp : 0;
}

bool Firing::isOver() const {
    return std::all_of(results.begin(), results.end(), [](const auto &one) { return one.ended; });
}

int Firing::failures() const {
    return int(std::count_if(results.begin(), results.end(), [](const auto &one) { return !one.result; }));
}

QJsonObject Firing::toJson() const {
    QJsonArray actions;
    for (const ActionResult &one : results)
        actions.append(actionJson(one));
    QJsonObject why = occasion.detail;
    why.insert("kind", cause);
    return {{"id", id},     {"seq", double(seq)},    {"stamp", stamp},
            {"mono", mono}, {"jitter_s", late_s()},  {"missed", double(occasion.missed)},
            {"cause", why}, {"ok", failures() == 0}, {"results", actions}};
}

QByteArray Firing::csvHeader() {
    return "stamp,mono,id,seq,cause,jitter_s,missed,action,ok,duration_s,error\n";
}

QByteArray Firing::csvRows() const {
    const QByteArray head = QByteArray::number(stamp, 'f', 6) + ',' + QByteArray::number(mono, 'f', 6) + ',' +
                            csvField(id) + ',' + QByteArray::number(seq) + ',' + csvField(cause) + ',' +
                            QByteArray::number(late_s(), 'f', 6) + ',' + QByteArray::number(occasion.missed) +
                            ',';
    if (results.empty())
        return head + ",1,0,\n";
    QByteArray rows;
    for (const ActionResult &one : results)
        rows += head + csvField(one.action) + (one.result ? ",1," : ",0,") +
                QByteArray::number(one.duration_s, 'f', 6) + ',' +
                (one.result ? QByteArray() : csvField(one.result.error().message)) + '\n';
    return rows;
}

} // namespace hermes
