#pragma once

#include "common/client/Client.h"
#include "protocol/messages/Daemons.h"

#include <QJsonArray>
#include <QJsonObject>
#include <QSet>
#include <QTimer>
#include <map>
#include <memory>
#include <vector>

namespace hermes {

/// The daemons of a robot, and the connections to them. They are those at given addresses and those that its
/// supervisor names; one that says that it belongs to another robot is left alone.
class RobotDaemons : public QObject {
    Q_OBJECT
public:
    struct Daemon {
        QString address;
        std::unique_ptr<Client> client;
        bool isNamed = false;   ///< by a supervisor
        double connected = 0;   ///< since then; of monotonicNow()
        bool isKnown = false;   ///< it is connected, of this robot, and has told what follows
        QString name;           ///< with "@HOST:PORT" where several have it
        QJsonObject info;       ///< what daemon.info gives
        QSet<QString> commands; ///< "record.stop", and "record.stop session" for each parameter
        QJsonArray methods;     ///< of its description
        std::vector<TopicDescription> topics;
        quint64 unreadable = 0; ///< messages that came and could not be read
    };

    /// robot: the id of this robot; empty: none, and daemons of every robot belong to it.
    /// ownName: another daemon of this name, that of this program, gets its address beside it.
    explicit RobotDaemons(const QString &robot, const QString &ownName = {})
        : robot_(robot)
        , ownName_(ownName) {
        connect(&again_, &QTimer::timeout, this, &RobotDaemons::askAgain);
        again_.start(std::chrono::seconds(2));
    }

    /// Connects to these, and to what a supervisor among them names; no more to others that were given
    /// before.
    void follow(const QStringList &addresses);

    /// By address, also those that are not known.
    const std::map<QString, std::unique_ptr<Daemon>> &all() const { return daemons_; }
    /// Who has been connected for a while and does not say what it is.
    std::vector<const Daemon *> undescribed() const;
    /// Null: none that is known has this name.
    Daemon *find(const QString &name) const;
    /// Who was known and does not answer.
    QStringList silent() const;
    /// They are not expected any more.
    void forgetSilent();

Q_SIGNALS:
    /// It is known now; also when it was known before and its connection is a new one.
    void came(hermes::RobotDaemons::Daemon *daemon);
    void went(hermes::RobotDaemons::Daemon *daemon);
    /// What a daemon tells does not arrive; why, for people.
    void missed(const QString &line);

private:
    void add(const QString &address, bool isNamed = false);
    void ask(Daemon &daemon);
    void take(Daemon &daemon, const QJsonObject &info, const QJsonValue &description);
    bool isOurs(const QJsonObject &info) const;
    void followSupervisor(Daemon &supervisor);
    void askAgain();
    void lose(Daemon &daemon);

    const QString robot_, ownName_;
    QTimer again_;
    std::map<QString, std::unique_ptr<Daemon>> daemons_;
    QSet<QString> others_; ///< addresses of who is connected, and no daemon of this robot
};

} // namespace hermes
