#pragma once

#include "common/Result.h"
#include "common/Time.h"
#include "protocol/messages/Recordings.h"

#include <QJsonArray>
#include <QJsonObject>
#include <QString>
#include <optional>

namespace hermes {

/// Where and how a logger writes a recording.
struct RecordingPlan {
    QString folder;         ///< of the session, absolute; it exists
    QString prefix;         ///< files are named PREFIX-0001.SUFFIX and on
    double fileBytes = 1e9; ///< a new file begins where the next record would make this one longer
    double fileSeconds = 3600;
    /// The sidecar of this recording before it was interrupted, which goes on; empty: it is new.
    QJsonObject earlier = {};
    /// How many files were written before.
    int earlierFiles() const { return earlier["files"].toArray().size(); }
    Moment start = {}; ///< of the recording, also of one that was interrupted; by the clocks of now
    /// Added to monotonic times of now gives those of the recording, which are of the clock it began with.
    /// The system has been started anew since unless it is 0.
    std::int64_t toItsClock_ns = 0;
};

/// What a logger tells of the recording under way, or of the last one.
struct RecordingState {
    QString path;               ///< of the file being written
    QJsonArray files;           ///< {name, bytes, ...} of each, in order; bytes end with a whole record
    double bytes = 0;           ///< of all files
    NamedCounts counts;         ///< what was recorded, by kind
    NamedCounts losses;         ///< what was not, by reason; all zero where nothing is missing
    QJsonObject gps;            ///< what is known of position and time
    std::optional<Error> error; ///< writing has ended by it

    /// Puts before it what was recorded before an interruption, as the sidecar has it; empty: nothing was.
    void addEarlier(const QJsonObject &sidecar);
    /// The losses alone, and the interruption.
    void addEarlierLosses(const QJsonObject &sidecar);
};

/// What a logger does to have its recordings managed by Recording: writes files, and repairs those of a
/// recording that was cut off. begin(), end() and repair() may block; they are called in a thread of
/// Recording's, one at a time.
class RecordingWriter {
public:
    virtual ~RecordingWriter() = default;

    /// Whether begin() goes on with a recording that was interrupted, when it is given the same session.
    virtual bool goesOn() const { return false; }
    /// When what is to be recorded began, if that was earlier.
    virtual std::optional<Moment> beganEarlier() const { return {}; }

    virtual Result<void> begin(const RecordingPlan &plan) = 0;
    /// Everything taken so far is in the files when it returns; state() says if that failed.
    virtual void end() = 0;
    /// Any thread, and quick.
    virtual RecordingState state() const = 0;
    /// Cuts the files of a recording that was cut off back to whole records, and brings `files`, `counts`
    /// and `end` of the sidecar up to what is in them.
    virtual Result<void> repair(const RecordingPlan &plan, QJsonObject &sidecar) = 0;
};

} // namespace hermes
