#pragma once

#include "gui/desktop/model/Fleet.h"

#include <QTimer>

namespace hermes {

/// Replays a recorded session through the same topics: each daemon with the command source.open plays the
/// captures of its part, one file after the other, and is live again at the end.
class SessionPlayer : public QObject {
    Q_OBJECT
public:
    explicit SessionPlayer(Fleet &fleet, QObject *parent = nullptr);

    /// A session as SessionRecorder::sessions() has it; speed 1 is real time.
    void play(const QJsonObject &session, double speed);
    /// Ends the replay; all are live again.
    void live();
    bool isPlaying() const { return !tracks_.empty(); }

Q_SIGNALS:
    void changed();
    void told(const QString &text, bool isError);

private:
    struct Track {
        QPointer<DaemonLink> daemon;
        QString folder, logger;
        int files = 1, next = 1;
        bool isOpening = false;
    };

    void openNext(Track &track);
    void poll();
    void onStatus(DaemonLink *daemon, const QJsonObject &status);
    void finish(DaemonLink *daemon);
    Track *trackOf(DaemonLink *daemon);

    Fleet &fleet_;
    QTimer timer_;
    double speed_ = 1;
    std::vector<Track> tracks_;
};

} // namespace hermes
