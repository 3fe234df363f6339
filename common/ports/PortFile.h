#pragma once

#include "common/files/AppendFile.h"
#include "common/ports/ChunkQueue.h"

#include <optional>

namespace hermes {

/// The recording of one port: its bytes as they came (BASE.raw), and beside them when they came (BASE.index,
/// see SerialIndex.h).
class PortFile {
public:
    /// Both files are new, or go on. toItsClock_ns: see RecordingPlan.
    bool open(const QString &base, bool goesOn, std::int64_t toItsClock_ns);
    /// False when not all of it could be written; the files then end with the last byte that was.
    bool write(const ChunkBatch &batch);
    void close();

    quint64 bytes() const { return raw_.size(); }
    quint64 chunks() const;
    /// Of the first chunk since it was opened.
    const std::optional<Moment> &first() const { return first_; }
    const std::optional<Moment> &last() const { return last_; }
    const QString &path() const { return raw_.path(); }
    /// What failed, and the path of the file that did.
    const QString &error() const { return error_; }
    const QString &failedPath() const { return failedPath_; }

private:
    bool fail(const AppendFile &file);

    AppendFile raw_, index_;
    std::int64_t toItsClock_ns_ = 0;
    std::vector<unsigned char> records_; ///< of the batch being written
    std::optional<Moment> first_, last_;
    QString error_, failedPath_;
};

} // namespace hermes
