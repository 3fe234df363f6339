#pragma once

#include "common/interface/InterfaceRegistry.h"
#include "common/interface/PtyInterface.h"
#include "daemons/seriallogger/SerialLogger.h"
#include "tests/support/DaemonClient.h"

namespace hermes {

using namespace seriallogger;

inline const QByteArray rmc("$GPRMC,123519,A,4807.038,N,01131.000,E,022.4,084.4,230394,003.1,W*6A\r\n");
inline const QByteArray gga("$GPGGA,123519,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,*47\r\n");

/// The daemon in the process of the test, and a device on a pseudo-terminal.
class SerialLoggerFixture : protected DaemonClient {
protected:
    void setUp();
    void tearDown();
    void launch(const QJsonArray &ports);
    QJsonObject port(const QString &name);
    bool isOpen(const QString &name) { return port(name).value("state") == "open"; }
    QString deviceUrl() const { return "serial://" + folder_->filePath("device"); }
    void plug();

    std::unique_ptr<QTemporaryDir> folder_;
    std::unique_ptr<PtyInterface> device_;
    std::unique_ptr<SerialLogger> daemon_;
};

inline void SerialLoggerFixture::setUp() {
    folder_ = std::make_unique<QTemporaryDir>();
    plug();
}

inline void SerialLoggerFixture::plug() {
    device_ =
        std::make_unique<PtyInterface>(*InterfaceUrl::parse("pty://" + folder_->filePath("device")), nullptr);
    device_->open();
    QVERIFY(device_->isOpen());
}

inline void SerialLoggerFixture::tearDown() {
    client_.reset();
    if (daemon_)
        daemon_->shutDown();
    daemon_.reset();
    device_.reset();
}

inline void SerialLoggerFixture::launch(const QJsonArray &ports) {
    daemon_ = std::make_unique<SerialLogger>();
    const QString text = QString::fromUtf8(QJsonDocument(ports).toJson(QJsonDocument::Compact));
    ::launch(*daemon_, {"ports=" + text, "record.folder=" + folder_->filePath("recordings"),
                        "record.free_floor_bytes=0", "record.free_warn_bytes=0"});
    connectTo(*daemon_);
}

inline QJsonObject SerialLoggerFixture::port(const QString &name) {
    for (const QJsonValue &port : call("ports.list").toArray())
        if (port.toObject().value("name") == name)
            return port.toObject();
    return {};
}

} // namespace hermes
