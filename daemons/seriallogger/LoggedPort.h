#pragma once

#include "common/daemon/Health.h"
#include "daemons/seriallogger/FixTracker.h"
#include "daemons/seriallogger/LineSplitter.h"
#include "daemons/seriallogger/PortThread.h"

#include <QJsonObject>

namespace hermes {

/// One port of the logger: its thread, the queues behind it, and what is made of its bytes. Of the main
/// thread.
class LoggedPort {
public:
    struct Sinks {
        std::function<void(const LineSplitter::Line &)> line;
        std::function<void(const Fix &)> fix;
    };

    /// queueBytes: how much may wait for the disk. viewFilled and note come from the port's thread.
    LoggedPort(const PortSettings &settings, std::size_t queueBytes, std::function<void()> viewFilled,
               PortThread::Note note);

    void start();
    /// Splits and decodes what came in since.
    void processView(const Sinks &sinks);
    /// Once a second: for the rates.
    void tick(double elapsed_s);

    const PortSettings &settings() const { return settings_; }
    ChunkQueue &recordingQueue() { return recording_; }
    PortThread &thread() { return thread_; }
    const std::optional<Fix> &lastFix() const { return lastFix_; }
    /// Everything that is known of it, as ports.list shows it.
    QJsonObject toJson() const;
    /// Level and message of its health item.
    std::pair<HealthLevel, QString> health() const;

private:
    QJsonObject nmeaJson() const;

    const PortSettings settings_;
    ChunkQueue recording_, view_;
    PortThread thread_;
    LineSplitter lines_;
    FixTracker fixes_;
    ChunkBatch batch_;
    std::optional<Fix> lastFix_;
    quint64 bytesAtTick_ = 0;
    double rate_ = 0; ///< bytes a second
    double startedMono_ = 0;
};

} // namespace hermes
