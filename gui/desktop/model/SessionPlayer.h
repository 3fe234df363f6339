#pragma once

#include "gui/desktop/model/Fleet.h"

#include <QTimer>

namespace hermes {

/// Replays a recorded session through the same topics: each daemon with the command source.open plays its
/// part from where it began in the session, and is live again at the end.
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
        double delay_s = 0; ///< after the beginning of the session
        bool isOpening = false;
    };

    void open(Track &track, const QString &recording, double speed);
    void poll();
    void onStatus(DaemonLink *daemon, const QJsonObject &status);
    void finish(DaemonLink *daemon);
    Track *trackOf(DaemonLink *daemon);

    Fleet &fleet_;
    QTimer timer_;
    std::vector<Track> tracks_;
};

} // namespace hermes
