#pragma once

#include "common/client/Client.h"
#include "daemons/web/FrameTree.h"
#include "protocol/wire/FieldTable.h"

#include <QSet>
#include <memory>
#include <vector>

namespace hermes::web {

/// Where a message comes from.
struct Origin {
    QString daemon;
    const TopicUpdate &update;
};

/// How a channel shows one or more topics: makes the messages of the channel of theirs.
class View {
public:
    virtual ~View() = default;

    /// The message, as JSON; empty: none. report tells why what came could not be read.
    virtual QByteArray take(const Origin &origin, ReadReport &report) = 0;
    /// Asked for twice a second: what changed and is sent no more often.
    virtual QByteArray due() { return {}; }
};

/// Which topics a channel shows, and as what.
struct ViewKind {
    const char *topic;
    const char *suffix; ///< of the channel DAEMON/TOPIC; empty: it replaces the topic itself
    const char *schema; ///< name without "foxglove."
    std::unique_ptr<View> (*make)(FrameTree &frames);
};

/// The well-known ones, one row each.
const std::vector<ViewKind> &viewKinds();
/// Of the topics that feed the frames: the channel of all frames shows them together.
const QSet<QString> &frameTopics();
std::unique_ptr<View> makeFramesView(FrameTree &frames);
/// The data as they are.
std::unique_ptr<View> makePlainView();

} // namespace hermes::web
