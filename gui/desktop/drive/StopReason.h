#pragma once

#include "gui/desktop/drive/OwnName.h"

#include <QObject>
#include <QRegularExpression>

namespace hermes::desktop {

/// Why a robot is stopped, as a person says it: who it was by name and host, without the addresses of
/// sockets. isOurs: this window has stopped it.
inline QString readableStop(const QString &reason, bool isOurs) {
    static const QString by = "emergency stop by ";
    if (isOurs && reason.startsWith(by + ownName()))
        return by + QObject::tr("you (this window)");
    static const QRegularExpression here(
        R"([a-z]+://(?:@[a-z]+:)?(127\.\S+|localhost|\[::1\]):\d+( \([^)]*\))?)"),
        behindAName(R"(, [a-z]+://\S+( \([^)]*\))?)"),
        alone(R"([a-z]+://(?:@[a-z]+:)?(\S+):\d+( \([^)]*\))?)");
    QString text = reason;
    text.remove(behindAName);
    text.replace(here, QObject::tr("a program on the robot's own computer"));
    return text.replace(alone, QObject::tr("a program on \\1"));
}

} // namespace hermes::desktop
