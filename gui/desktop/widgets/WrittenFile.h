#pragma once

#include "common/Result.h"

#include <QSize>
#include <functional>

class QObject;
class QPainter;
class QString;

namespace hermes::desktop {

/// Writes a file that is made already; may be called in any thread.
using Writing = std::function<Result<void>()>;

/// Draws a picture: SVG, or of pixels, as the name of the file says.
Writing picture(const QString &file, const QString &title, const QSize &size,
                const std::function<void(QPainter &)> &draw);

/// Writes beside the event loop, for a disk may take its time, and tells the receiver if it is still there.
/// The program does not end before.
void writeBeside(const Writing &writing, QObject *receiver,
                 const std::function<void(const Result<void> &)> &tell);

} // namespace hermes::desktop
