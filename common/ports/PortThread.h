#pragma once

#include "common/interface/Interface.h"
#include "common/ports/ChunkQueue.h"

#include <QJsonObject>
#include <QThread>
#include <functional>
#include <optional>

namespace hermes {

/// Receives from one port in a thread of its own, so that nothing else holds it up: stamps what comes in and
/// puts it into the queues of the recording and of the view. Opens the port again when it closes.
class PortThread : public QThread {
public:
    struct State {
        Interface::State carrier = Interface::State::Closed;
        QString reason; ///< why it is closed
        QString device; ///< that a link led to as it was opened
        InterfaceCounters counters;
        QMap<QString, quint64> systemErrors; ///< since the start, over all openings
        Interface::Strangers strangers;
        std::optional<Moment> last; ///< bytes
    };
    /// What happened to the port, in its thread: "opened", "closed" {reason}, "errors" {kind: count}.
    using Note = std::function<void(const QString &event, const QJsonObject &details)>;

    /// viewFilled: called in the thread when something waits for the view again.
    PortThread(const QString &name, const QString &url, ChunkQueue &recording, ChunkQueue &view,
               std::function<void()> viewFilled, Note note);
    ~PortThread() override { end(); }

    /// Ends the thread and waits for it.
    void end();
    State state() const;
    /// Runs the job with the carrier, in the thread: later, or never if that ends before. Any thread.
    void with(std::function<void(Interface &)> job);

protected:
    void run() override;

private:
    void received(const QByteArray &bytes);
    void changed(const QString &reason);
    void checkErrors();

    const QString url_;
    ChunkQueue &recording_, &view_;
    const std::function<void()> viewFilled_;
    const Note note_;

    Interface *carrier_ = nullptr;        ///< of the thread
    QMap<QString, quint64> errorsBefore_; ///< of earlier openings; of the thread
    QMap<QString, quint64> errorsNow_;    ///< of this opening; of the thread
    QObject context_;                     ///< lives in the thread

    mutable std::mutex mutex_; // guards what follows
    State state_;
};

} // namespace hermes
