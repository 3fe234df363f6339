#pragma once

#include <QSocketNotifier>

namespace hermes::desktop {

/// Says in the event loop that the program is to end (SIGTERM, SIGINT, SIGHUP): in order, as when its window
/// is closed. One at a time.
class EndSignals : public QObject {
    Q_OBJECT
public:
    EndSignals();
    ~EndSignals() override;

Q_SIGNALS:
    void endWanted();

private:
    int ends_[2] = {-1, -1}; ///< of a pipe
    QSocketNotifier *notifier_ = nullptr;
};

} // namespace hermes::desktop
