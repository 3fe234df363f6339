#pragma once

#include "common/daemon/PastFaults.h"
#include "common/ports/PortThread.h"
#include "daemons/seriallogger/PortView.h"
#include "daemons/seriallogger/SerialMessages.h"

namespace hermes::seriallogger {

/// One port of the logger: its thread, the queues behind it, and what is made of its bytes. Of the main
/// thread.
class LoggedPort {
public:
    /// queueBytes: how much may wait for the disk. viewFilled and note come from the port's thread.
    LoggedPort(const PortSettings &settings, std::size_t queueBytes, std::function<void()> viewFilled,
               PortThread::Note note);

    void start();
    /// Once a second: for the rates.
    void tick(double elapsed_s);

    const PortSettings &settings() const { return settings_; }
    ChunkQueue &recordingQueue() { return recording_; }
    PortView &view() { return view_; }
    PortThread &thread() { return thread_; }
    PortStatus status() const;
    /// Level and message of its health item.
    std::pair<HealthLevel, QString> health();

private:
    NmeaCounts nmeaCounts() const;
    /// What comes is something else than NMEA sentences.
    bool isForeign() const;

    const PortSettings settings_;
    ChunkQueue recording_;
    PortView view_;
    PortThread thread_;
    quint64 bytesAtTick_ = 0;
    double rate_ = 0; ///< bytes a second
    double startedMono_ = 0;
    quint64 sentences_ = 0, bytesAtSentence_ = 0; ///< NMEA sentences, and the bytes up to the last one
    double sentenceMono_ = 0;                     ///< when that came
    PastFaults faults_;
};

} // namespace hermes::seriallogger
