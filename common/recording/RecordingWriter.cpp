#include "common/recording/RecordingWriter.h"

namespace hermes {

void RecordingState::addEarlier(const QJsonObject &sidecar) {
    if (sidecar.isEmpty())
        return;
    QJsonArray all = sidecar["files"].toArray();
    for (const QJsonValue &file : qAsConst(files))
        all.append(file);
    files = all;
    bytes += sidecar["bytes"].toDouble();
    for (const auto &[now, before] :
         {std::pair(&counts, sidecar["counts"].toObject()), std::pair(&losses, sidecar["losses"].toObject())})
        for (auto count = before.begin(); count != before.end(); ++count)
            (*now)[count.key()] += count->toDouble();
    ++losses["interruptions"];
}

} // namespace hermes
