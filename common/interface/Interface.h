#pragma once

#include "common/interface/Peer.h"

#include <QByteArray>
#include <QMap>
#include <QObject>
#include <QString>
#include <QTimer>
#include <chrono>

namespace hermes {

/// What has passed through an interface since it was made.
struct InterfaceCounters {
    quint64 bytesIn = 0;
    quint64 bytesOut = 0;
    quint64 opened = 0;       ///< times it became open
    quint64 errors = 0;       ///< failures of the carrier
    quint64 refusedBytes = 0; ///< given to write() but not taken: closed, or over the write limit
};

/// The lower layer of a channel: the life cycle of a carrier of bytes or datagrams. It does not know what the
/// bytes mean. With reconnecting on, a carrier that closes is opened again after 0.1 s, doubled each time up
/// to 5 s or setLongestRetry(). Everything is asynchronous; use from one thread.
class Interface : public QObject {
    Q_OBJECT
public:
    enum class State { Closed, Opening, Open };
    static constexpr qint64 defaultWriteLimit = 16 << 20;

    void open();
    /// Ends it, without reconnecting; emits closed() if it was open or opening.
    void close(const QString &reason = QStringLiteral("closed here"));
    /// Takes all of bytes, or none of them (false): when not open, or when more than the write limit would
    /// wait.
    bool write(const QByteArray &bytes);

    State state() const { return current_; }
    bool isOpen() const { return current_ == State::Open; }
    /// Who it speaks to, for messages: "tcp://127.0.0.1:7410".
    virtual QString name() const = 0;
    /// Whether each received() is one whole datagram.
    virtual bool isDatagram() const { return false; }
    /// Whether it is the end of a connection of its own: somebody else's comes as another interface.
    virtual bool isConnection() const { return false; }
    /// Who is at the other end, while open.
    virtual Peer peer() const { return {}; }
    /// Gives what waits to the system now, as far as it takes it.
    virtual void flush() {}
    /// Bytes taken by write() and not yet given to the system.
    virtual qint64 bytesToWrite() const = 0;
    /// Bytes given to the system and not yet gone out, where that can be known.
    virtual qint64 bytesInSystem() const { return 0; }
    /// How fast bytes go out; 0: not known.
    virtual double bytesPerSecond() const { return 0; }
    const InterfaceCounters &counters() const { return counts_; }
    /// Stops receiving, and goes on: meanwhile the sender waits. False: this carrier cannot.
    virtual bool setReceiving(bool on) {
        Q_UNUSED(on)
        return false;
    }
    /// Whether bytes have arrived that received() has not told, where the carrier can know.
    virtual bool hasUnread() const { return false; }
    /// Since when something has always been unread (bootNow()): what received() tells may have come so early.
    /// Now, where the carrier cannot know.
    virtual double unreadSince() const;
    /// What the system says it lost or found damaged since the opening, by kind; empty where it does not
    /// tell.
    virtual QMap<QString, quint64> systemErrors() const { return {}; }

    /// Datagrams of senders that are not read, and who they are: a device is read from one.
    struct Strangers {
        quint64 datagrams = 0;
        QStringList names;
    };
    virtual Strangers strangers() const { return {}; }

    void setReconnecting(bool on) { reconnecting_ = on; }
    /// The pause between attempts grows up to this.
    void setLongestRetry(std::chrono::milliseconds pause);
    void setWriteLimit(qint64 bytes) { writeLimit_ = bytes; }

Q_SIGNALS:
    void opened();
    /// The carrier ended or could not be opened; reason is a sentence for people.
    void closed(const QString &reason);
    void received(const QByteArray &bytes);
    /// Some waiting bytes went out.
    void drained();

protected:
    explicit Interface(QObject *parent);

    // What a carrier implements. doOpen ends in nowOpen() or nowClosed(), at once or later.
    virtual void doOpen() = 0;
    virtual void doClose() = 0;
    virtual bool doWrite(const QByteArray &bytes) = 0;

    // What a carrier reports.
    void nowOpen();
    void nowClosed(const QString &reason, bool isError);
    void nowReceived(const QByteArray &bytes);

private:
    State current_ = State::Closed;
    bool reconnecting_ = false;
    qint64 writeLimit_ = defaultWriteLimit;
    InterfaceCounters counts_;
    QTimer retry_;
    std::chrono::milliseconds nextRetry_, longestRetry_;
};

} // namespace hermes
