#pragma once

#include "gui/desktop/model/Fleet.h"

#include <QSet>
#include <QTimer>

namespace hermes::desktop {

/// Hears of every stop of some robots, chosen or not, whoever pressed it: asks their motor controls again and
/// again what holds them.
class LatchWatch : public QObject {
    Q_OBJECT
public:
    static constexpr std::chrono::milliseconds period{200}, timeout{2000};

    explicit LatchWatch(Fleet &fleet, QObject *parent = nullptr);

    /// The robots of these addresses, from now on. What holds them at the first look is no stop.
    void begin(const QSet<QString> &robots);
    void end();
    /// Asks now, and calls done() when all have answered and none was stopped.
    void look(const std::function<void()> &done);

Q_SIGNALS:
    /// Or nobody knows whether it is; why: in words.
    void stopped(const QString &why);

private:
    /// False: it was stopped.
    bool take(const DaemonLink &motors, const Result<QJsonValue> &state);
    std::vector<DaemonLink *> motors() const;
    QString stopOf(const DaemonLink &motors) const;

    Fleet &fleet_;
    QSet<QString> robots_;
    QHash<QString, QSet<QString>> causes_; ///< that hold a robot, by the address of its motor control
    bool hasBegun_ = false, isLooking_ = false;
    int turn_ = 0; ///< what answers to an earlier one is no answer
    QTimer timer_;
};

} // namespace hermes::desktop
