#pragma once

#include <QByteArray>
#include <QList>
#include <QString>
#include <QThread>
#include <optional>
#include <vector>

namespace hermes {

/// A port that others on the network can reach, as DNS-SD tells of it.
struct AnnouncedPort {
    quint16 port = 0;
    QList<QByteArray> texts; ///< KEY=VALUE: name, protocol, framing, tls, robot, robot_id

    /// Of a daemon that listens there: as the settings say, and as it is. Nothing for what only this computer
    /// reaches and what is no TCP.
    static std::optional<AnnouncedPort> of(const QString &daemon, const QString &setting,
                                           const QString &address);
};

/// Announces ports as _hermes._tcp through Avahi as long as it lives, anew whenever Avahi starts. Nobody
/// waits for it, it has a thread of its own; without Avahi or D-Bus it tells so in the log once and goes on
/// trying.
class Announcement {
public:
    Announcement(const QString &daemon, const std::vector<AnnouncedPort> &ports);
    ~Announcement();
    Announcement(const Announcement &) = delete;
    Announcement &operator=(const Announcement &) = delete;

    /// Ends the program at once, where a bus that does not answer would hold it: Qt waits for its threads at
    /// the end, that of D-Bus waits for the bus. Call it last.
    static void endProgramIfHeld(int status);

private:
    QThread *thread_;
};

} // namespace hermes
