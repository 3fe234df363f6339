#include "daemons/softwaretrigger/Firing.h"

#include "daemons/softwaretrigger/FiringLog.h"
#include "protocol/wire/JsonText.h"

#include <algorithm>

namespace hermes::softwaretrigger {
namespace {

constexpr int largestResult = 1000; // bytes of JSON; a larger result is not repeated

ActionOutcome outcomeOf(const Firing::ActionResult &one) {
    ActionOutcome outcome{one.action, one.result.ok(), one.duration_s, {}, {}};
    if (!one.result)
        outcome.error = {one.result.error().code, one.result.error().message};
    else if (compactJson(*one.result).size() <= largestResult)
        outcome.result = *one.result;
    return outcome;
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

FiringMessage Firing::message() const {
    FiringMessage told{id, seq, stamp, mono, late_s(), occasion.missed, occasion.cause, failures() == 0, {}};
    for (const ActionResult &one : results)
        told.results.push_back(outcomeOf(one));
    return told;
}

QByteArray Firing::csvHeader() {
    return "stamp,mono,id,seq,cause,jitter_s,missed,action,ok,duration_s,error\n";
}

QByteArray Firing::csvRows() const {
    const QByteArray head = QByteArray::number(stamp, 'f', 6) + ',' + QByteArray::number(mono, 'f', 6) + ',' +
                            csvField(id) + ',' + QByteArray::number(seq) + ',' +
                            csvField(occasion.cause.kind) + ',' + QByteArray::number(late_s(), 'f', 6) + ',' +
                            QByteArray::number(occasion.missed) + ',';
    if (results.empty())
        return head + ",1,0,\n";
    QByteArray rows;
    for (const ActionResult &one : results)
        rows += head + csvField(one.action) + (one.result ? ",1," : ",0,") +
                QByteArray::number(one.duration_s, 'f', 6) + ',' +
                (one.result ? QByteArray() : csvField(one.result.error().message)) + '\n';
    return rows;
}

} // namespace hermes::softwaretrigger
