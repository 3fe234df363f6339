#pragma once

#include "common/client/Client.h"

#include <QJsonObject>
#include <QObject>
#include <QTimer>

namespace hermes {

/// How a daemon is, at one glance. Each has one colour, one icon and one word (Theme.h).
enum class Condition { Ready, Busy, Warning, Fault, Unreachable };

/// One daemon as the operator's program knows it: the connection, and what the daemon says of itself. It
/// keeps connecting, reads the description again when its hash changes, and asks for the status each second,
/// which also measures the link. Nothing here blocks, and nothing is known beforehand of any daemon.
class DaemonLink : public QObject {
    Q_OBJECT
public:
    static constexpr std::chrono::milliseconds pollPeriod{1000};

    /// address: "HOST:PORT".
    explicit DaemonLink(const QString &address, QObject *parent = nullptr);

    const QString &address() const { return address_; }
    QString host() const { return address_.section(':', 0, -2); }
    /// Its own name ("motorcontrol"); before it has answered, the usual one of its port, or the address.
    QString name() const;
    QString title() const;
    bool isConnected() const { return client_.isConnected(); }
    /// It has answered once; what it said then is still here when the connection is gone.
    bool isKnown() const { return !info_.isEmpty(); }

    Condition condition() const;
    /// What stands behind the condition in one word: the daemon's own state, "warning" or "unreachable".
    QString conditionWord() const;
    /// The worst health item as a sentence, or why there is no connection; empty when all is well.
    QString reason() const;
    /// The time of a request and its reply in milliseconds; negative: not measured.
    double latency_ms() const { return isConnected() ? latency_ms_ : -1; }

    const QJsonObject &info() const { return info_; }
    const QJsonObject &status() const { return status_; }
    /// OpenRPC, with "x-topics".
    const QJsonObject &description() const { return description_; }
    /// The description of a method; empty when the daemon does not have it.
    QJsonObject method(const QString &name) const;
    bool hasMethod(const QString &name) const { return !method(name).isEmpty(); }
    bool hasTopic(const QString &name) const;
    /// The names of the topics.
    QStringList topics() const;

    Client &client() { return client_; }
    /// Calls a method; the callback is dropped with the context.
    void call(const QString &method, const QJsonObject &params, QObject *context,
              const Client::Callback &done);

Q_SIGNALS:
    /// Connection, state, health or latency.
    void changed();
    /// A description that was not known before: methods and topics can be looked up.
    void described();
    /// Connected, described, and its description may have been the same as before.
    void ready();

private:
    void onConnected();
    void onStatus(const QJsonObject &status);
    void poll();

    const QString address_;
    Client client_;
    QTimer timer_;
    QJsonObject info_, status_, description_;
    double latency_ms_ = -1;
    bool isPolling_ = false;
};

} // namespace hermes
