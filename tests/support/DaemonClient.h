#pragma once

#include "common/client/DaemonAddress.h"
#include "common/daemon/Daemon.h"
#include "tests/support/PatientClient.h"

/// Starts a daemon in this process, with settings as `path=value` and more options.
inline void launch(hermes::Daemon &daemon, const QStringList &settings = {},
                   const QString &listen = "tcp://127.0.0.1:0", const QStringList &options = {}) {
    QStringList arguments = QStringList{"test", "--listen", listen} + options;
    for (const QString &setting : settings)
        arguments += {"--set", setting};
    QVERIFY(!daemon.prepare(arguments));
    const auto launched = daemon.launch();
    QVERIFY2(launched.ok(), launched.ok() ? "" : qPrintable(launched.error().message));
}

/// A client of the daemon that a test runs in its own process: base of the fixtures.
class DaemonClient {
protected:
    void connectTo(hermes::Daemon &daemon) {
        client_ = std::make_unique<ConnectedClient>(hermes::asOwner(daemon.server().addresses().value(0)));
    }
    /// The result; an error is printed, and is {failed: message}.
    QJsonValue call(const QString &method, const QJsonObject &params = {}) {
        const auto result = client_->callAndWait(method, params);
        if (!result)
            qWarning("%s: %s", qPrintable(method), qPrintable(result.error().message));
        return result ? *result : QJsonObject{{"failed", result.error().message}};
    }
    /// The error.
    hermes::Error failure(const QString &method, const QJsonObject &params = {}) {
        const auto result = client_->callAndWait(method, params);
        return result ? hermes::Error(hermes::ErrorCode::InternalError, "succeeded, though it should not")
                      : result.error();
    }
    /// {name, level, message, values, age_s}; empty when there is none of this name.
    QJsonObject healthItem(const QString &name) {
        for (const QJsonValue &item : DaemonClient::call("daemon.status")["health"].toArray())
            if (item["name"] == name)
                return item.toObject();
        return {};
    }

    std::unique_ptr<PatientClient> client_;
};
