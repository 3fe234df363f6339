#pragma once

#include "common/ports/SerialLogReader.h"
#include "common/ports/SerialRecorder.h"

namespace hermes {

inline const Moment first{1700000000000000000, 5000000000};

/// So many seconds after the first arrival; the stamp's clock may step on its own.
inline Moment after(double seconds, double step_s = 0) {
    return {first.stamp_ns + std::int64_t((seconds + step_s) * 1e9),
            first.mono_ns + std::int64_t(seconds * 1e9)};
}

inline void push(ChunkQueue &queue, const QByteArray &bytes, const Moment &arrival) {
    queue.push(bytes.constData(), std::size_t(bytes.size()), arrival);
}

inline QList<QJsonObject> eventsOf(const QString &folder) {
    QList<QJsonObject> events;
    for (const QByteArray &line : contentOf(folder + "/logger-events.jsonl").split('\n'))
        if (!line.isEmpty())
            events.append(QJsonDocument::fromJson(line).object());
    return events;
}

/// All pieces, or what was wrong.
inline Result<QList<SerialLogReader::Piece>> readAll(const QString &base) {
    SerialLogReader reader;
    if (const Result<void> opened = reader.open(base); !opened)
        return opened.error();
    QList<SerialLogReader::Piece> pieces;
    for (;;) {
        const auto piece = reader.next();
        if (!piece)
            return piece.error();
        if (piece->bytes.isEmpty())
            return pieces;
        pieces.append(*piece);
    }
}

/// A folder with the recording of a logger "logger", and its port "a".
class SerialFilesFixture {
protected:
    RecordingPlan plan() const { return {folder_->path(), "logger", 0, 0}; }
    QString base() const { return folder_->filePath("logger-a"); }
    /// A recording of that port has begun; its bytes go through a queue of that size.
    void begin(std::size_t bytes = 1 << 20) {
        recorder_.reset(); // it reads from the queue
        queue_ = std::make_unique<ChunkQueue>(bytes);
        recorder_ = std::make_unique<SerialRecorder>();
        recorder_->setPorts({{"a", "u", queue_.get()}});
        QVERIFY(recorder_->begin(plan()).ok());
    }

    std::unique_ptr<QTemporaryDir> folder_;
    std::unique_ptr<ChunkQueue> queue_;
    std::unique_ptr<SerialRecorder> recorder_;
};

} // namespace hermes
