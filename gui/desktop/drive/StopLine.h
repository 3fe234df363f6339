#pragma once

#include "gui/desktop/model/DaemonLink.h"

#include <QElapsedTimer>
#include <QPointer>

namespace hermes::desktop {

/// How far a STOP has come. Only the last is an end.
enum class StopPhase {
    None,     ///< nobody pressed it
    Pressed,  ///< there is no connection that it could go over
    Sent,     ///< on its way, not answered
    Taken,    ///< answered: the robot brakes
    Confirmed ///< the robot has measured that it stands
};

/// The emergency stop of one daemon. Two connections lead there, for what is lost on one does not hold up the
/// other; while nobody answers the second is made anew now and then, for as long as it takes.
class StopLine : public QObject {
    Q_OBJECT
public:
    static constexpr std::chrono::milliseconds period{50};

    /// name: of the daemon, for people.
    StopLine(DaemonLink *daemon, const QString &name, QObject *parent = nullptr);

    const QString &address() const { return address_; }
    const QString &name() const { return name_; }
    void setName(const QString &name) { name_ = name; }
    StopPhase phase() const { return phase_; }
    /// Since it was pressed, or since the robot was known to stand last; seconds.
    double unconfirmed_s() const {
        return phase_ == StopPhase::None || !unconfirmed_.isValid() ? 0
                                                                    : 1e-3 * double(unconfirmed_.elapsed());
    }
    /// From the press to the confirmation; seconds.
    double took_s() const { return took_s_; }
    /// Why it is not confirmed, as far as that is known.
    QString reason() const;
    /// What stops the robot without this program, in words.
    QString watchdogs() const;

    void press();
    /// Asks for the release; until the robot has given it nothing changes but that the stop is not sent any
    /// more. A robot without a connection gets no stop.
    void release();
    /// What the release is called with: the name of this window, and that a person confirms it.
    static QJsonObject releaseParams(const DaemonLink *daemon);
    /// It is stopped by somebody else, and watched until it is not any more.
    bool isWatched() const { return isWatched_; }
    /// The daemon behind it was found again.
    void follow(DaemonLink *daemon);

Q_SIGNALS:
    void changed();

private:
    void tick();
    void send(Client &client);
    void onAnswer(const Result<QJsonValue> &answer);
    void look();
    void onState(const Result<QJsonValue> &state);
    void enter(StopPhase phase);
    void forget();
    void watch();
    void notReleased(const QString &why);
    std::vector<Client *> openClients();
    void readWatchdogs();

    QPointer<DaemonLink> daemon_;
    const QString address_;
    QString name_;
    Client second_;
    QTimer timer_;
    StopPhase phase_ = StopPhase::None;
    QElapsedTimer pressed_, lastPress_, heard_, unconfirmed_, renewed_, looked_;
    int tries_ = 0;
    qint64 renewAfter_ms_ = 0;
    bool isWatched_ = false, isReleasing_ = false;
    quint64 press_ = 0; ///< counts them: what answers to an earlier one is no answer
    double took_s_ = 0, commandTimeout_s_ = 0, controllerTimeout_s_ = 0; ///< 0: not known
    QString reason_;
};

} // namespace hermes::desktop
