#pragma once

#include "common/daemon/Daemon.h"
#include "daemons/web/Door.h"
#include "daemons/web/WebClient.h"

#include <set>

namespace hermes::web {

/// hermes-web: the robot in a browser. Foxglove and Lichtblick connect to it, and it has a page of its own.
/// It is a client of the robot's other daemons.
class Web : public Daemon {
public:
    Web();
    ~Web() override;

protected:
    Result<void> start() override;
    void stop() override;
    void settingsChanged(const QStringList &paths) override;

private:
    void declareSettings();
    void follow();
    void enter(QWebSocket *socket);
    void updateHealth();

    RobotView robot_;
    Hall hall_;
    std::unique_ptr<Door> door_;
    std::set<WebClient *> clients_;
    QTimer alive_;
    quint64 turnedAway_ = 0;
};

} // namespace hermes::web
