#pragma once

#include "common/ports/PortFile.h"
#include "common/recording/RecordingWriter.h"

#include <condition_variable>
#include <functional>
#include <memory>
#include <thread>

namespace hermes {

/// Writes what ports receive, in a thread of its own: PREFIX-PORT.raw and PREFIX-PORT.index of each port, and
/// PREFIX-events.jsonl with marks and what happened to the ports.
class SerialRecorder : public RecordingWriter {
public:
    struct Port {
        QString name;
        QString url;
        ChunkQueue *queue; ///< not owned; open while a recording is under way
        /// Gives members to be added to the port's entry in the files of the state. Called by state(), in any
        /// thread; may be empty, and must not call the recorder.
        std::function<QJsonObject()> about = {};
    };

    ~SerialRecorder() override { end(); }
    /// Before the first recording.
    void setPorts(std::vector<Port> ports);

    /// Behind what was received before.
    bool goesOn() const override { return true; }
    Result<void> begin(const RecordingPlan &plan) override;
    void end() override;
    RecordingState state() const override;
    /// Cuts each index back to whole records with bytes, the events back to whole lines, and brings files,
    /// counts, bytes and end of the sidecar up to what is there. Not a byte of a port is touched.
    Result<void> repair(const RecordingPlan &plan, QJsonObject &sidecar) override;

    /// Adds {stamp, mono, event, ...details} to the events; false when nothing is being recorded. Any thread.
    bool note(const QString &event, const QJsonObject &details, const Moment &when = Moment::now());

private:
    struct Entry {
        Port port;
        PortFile file;
        ChunkBatch batch;
        // Copies for state(), guarded by the mutex:
        quint64 bytes = 0, chunks = 0;
        std::optional<Moment> first, last;
    };

    std::optional<Error> openFiles(const RecordingPlan &plan);
    void run();
    bool writePorts();
    bool writeEvents();
    bool addEvent(const QString &event, QJsonObject line, const Moment &when, bool atEnd);
    void noteLosses(const Entry &entry, quint64 begin);
    void publish();
    bool fail(const QString &message, const QString &path);

    std::vector<std::unique_ptr<Entry>> entries_;
    AppendFile eventFile_;
    std::thread thread_;

    mutable std::mutex mutex_; // guards what follows
    std::condition_variable wake_;
    RecordingPlan plan_;
    bool recording_ = false;
    bool stopping_ = false;
    QByteArray events_; ///< lines that wait for the disk
    quint64 eventCount_ = 0, markCount_ = 0, eventsLost_ = 0, diskLost_ = 0;
    std::optional<Error> error_;
};

} // namespace hermes
