#pragma once

#include "common/client/Client.h"
#include "tests/support/Patience.h"

/// A client whose waits are as long as this build, emulator or machine needs.
class PatientClient : public hermes::Client {
public:
    hermes::Result<QJsonValue> callAndWait(const QString &method, const QJsonValue &params = QJsonObject(),
                                           std::chrono::milliseconds timeout = defaultTimeout) {
        return Client::callAndWait(method, params, patience * timeout);
    }
    hermes::Result<void> waitConnected() { return Client::waitConnected(patience * defaultTimeout); }
};

/// One that is connected to that address.
class ConnectedClient : public PatientClient {
public:
    explicit ConnectedClient(const QString &address, const char *file = __builtin_FILE(),
                             int line = __builtin_LINE()) {
        const bool isConnected = connectTo(address).ok() && waitConnected().ok();
        QTest::qVerify(isConnected, "isConnected", qPrintable(address + ": " + problem()), file, line);
    }
};
