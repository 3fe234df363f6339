#pragma once

#include <QObject>

namespace hermes::desktop {

/// Says in the event loop that the program is to end (SIGTERM, SIGINT, SIGHUP): in order, as when its window
/// is closed. One at a time. Windows has no such signals: it closes the windows of a session that ends.
class EndSignals : public QObject {
    Q_OBJECT
public:
    EndSignals();
    ~EndSignals() override;

Q_SIGNALS:
    void endWanted();
};

} // namespace hermes::desktop
