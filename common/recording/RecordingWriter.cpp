#include "common/recording/RecordingWriter.h"

namespace hermes {

namespace {

void add(NamedCounts &counts, const QJsonObject &earlier) {
    for (auto count = earlier.begin(); count != earlier.end(); ++count)
        counts[count.key()] += count->toDouble();
}

} // namespace

void RecordingState::addEarlier(const QJsonObject &sidecar) {
    if (sidecar.isEmpty())
        return;
    QJsonArray all = sidecar["files"].toArray();
    for (const QJsonValue &file : qAsConst(files))
        all.append(file);
    files = all;
    bytes += sidecar["bytes"].toDouble();
    add(counts, sidecar["counts"].toObject());
    addEarlierLosses(sidecar);
}

void RecordingState::addEarlierLosses(const QJsonObject &sidecar) {
    if (sidecar.isEmpty())
        return;
    add(losses, sidecar["losses"].toObject());
    ++losses["interruptions"];
}

} // namespace hermes
