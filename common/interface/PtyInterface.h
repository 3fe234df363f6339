#pragma once

#include "common/interface/Interface.h"
#include "common/interface/InterfaceUrl.h"

#include <QSocketNotifier>
#include <memory>

namespace hermes {

/// The far end of a serial line, for simulated devices: a pseudo-terminal whose near end programs open like a
/// serial port. The URL names the link that points to it: `pty:///run/user/1000/hermes/roboclaw`; its folder
/// is made where it is missing. Without a path there is no link and device() tells the name. Opening again
/// makes a new pseudo-terminal under the same link, as when a device is plugged in again. It stays open
/// whether or not a program has opened the near end.
class PtyInterface : public Interface {
    Q_OBJECT
public:
    PtyInterface(const InterfaceUrl &address, QObject *parent);
    ~PtyInterface() override;

    QString name() const override { return url_.toString(); }
    /// The near end, e.g. "/dev/pts/3", while open.
    QString device() const { return nearEnd_; }
    qint64 bytesToWrite() const override { return 0; }
    qint64 bytesInSystem() const override { return unread(); }
    /// Bytes that were written and that no program has read yet; 0 while closed.
    qint64 unread() const;
    /// Of the near end, as a program or setBaud() has set it last; bits a second. 115200 at first.
    int baud() const;
    void setBaud(int baud);
    /// Loses them; gives their number.
    qint64 discardUnread();

protected:
    void doOpen() override;
    void doClose() override;
    bool doWrite(const QByteArray &bytes) override;

private:
    QString makePair();
    QString makeLink();
    void readSome();
    void dropClaim();

    InterfaceUrl url_;
    QString nearEnd_;
    int farFd_ = -1;
    int nearFd_ = -1; // held open: without any opener the far end could not be read
    std::unique_ptr<QSocketNotifier> readable_;
};

} // namespace hermes
