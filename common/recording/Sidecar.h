#pragma once

#include "common/Result.h"
#include "protocol/messages/Recordings.h"

#include <QJsonObject>
#include <QString>

namespace hermes {

/// The JSON file beside the files of a recording that says what they are. It is always whole: a new version
/// takes the place of the old one at once.
class Sidecar {
public:
    /// What distinguishes it from any other JSON file: its member "format".
    static constexpr const char *format = "hermes recording 1";

    static QString path(const QString &folder, const QString &logger) {
        return folder + '/' + logger + ".json";
    }
    /// Refuses what is no sidecar; the message names the file and what is wrong.
    static Result<QJsonObject> read(const QString &path);
    /// How long what was recorded took, in seconds: by its stamps of a clock that never jumps, or by those of
    /// the wall clock where it has no others. From 0 to four months, whatever stands there.
    static double duration(const QJsonObject &content);
    /// What read() gave of a path, as record.list tells it.
    static RecordingEntry entry(const QString &path, const Result<QJsonObject> &sidecar);
    /// durable: on the disk when it returns. room: a file that becomes the sidecar; what it takes of the disk
    /// is there however full that is.
    static Result<void> write(const QString &path, const QJsonObject &content, bool durable,
                              const QString &room = QString());
};

} // namespace hermes
