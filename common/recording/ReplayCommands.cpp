#include "common/recording/ReplayCommands.h"

#include "protocol/messages/Recordings.h"
#include "protocol/wire/Fields.h"

namespace hermes {

Field pausedParam() {
    return Field::boolean("paused", "The replay waits for source.pause").byDefault(false);
}

Field delayParam() {
    return Field::number("delay_s", "Time of the replay at which the recording begins")
        .unit("s")
        .range(0, 1e7)
        .byDefault(0);
}

Command pauseCommand(const std::function<Result<QJsonValue>(bool)> &pause) {
    return Command("source.pause", "The replay waits, or goes on")
        .param(Field::boolean("paused", "Whether it waits").byDefault(true))
        .gives<SourceStatus>()
        .example({{"paused", true}}, QJsonObject{{"state", "replay"}, {"paused", true}})
        .handler([pause](const Call &call) { return pause(call.flag("paused")); });
}

} // namespace hermes
