#pragma once

#include <QObject>
#include <QSocketNotifier>
#include <QTimer>

namespace hermes {

/// The orderly end of a connection: says that nothing more will come, and takes what the peer still sends
/// for a second at most. A socket that is closed with bytes unread resets the connection instead, and the
/// peer loses what it was told last.
class Farewell : public QObject {
    Q_OBJECT
public:
    /// descriptor stays the caller's. Does nothing when too many connections are ending.
    static void say(int descriptor, QObject *parent);

private:
    Farewell(int ownDescriptor, QObject *parent);
    ~Farewell() override;

    void drain();

    const int descriptor_;
    QSocketNotifier notifier_;
    QTimer limit_;
};

} // namespace hermes
