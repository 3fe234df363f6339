#include "common/interface/PtyInterface.h"
#include "common/ports/PortThread.h"

using namespace hermes;

class TestPortThread : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void jobsHaveTheCarrier() {
        QTemporaryDir folder;
        const QString path = folder.filePath("device");
        PtyInterface device(*InterfaceUrl::parse("pty://" + path), nullptr);
        device.open();
        QByteArray came;
        connect(&device, &Interface::received, this, [&](const QByteArray &bytes) { came += bytes; });
        ChunkQueue recording(1000), view(1000);
        PortThread port(
            "a", "serial://" + path, recording, view, [] {}, [](const QString &, const QJsonObject &) {});
        port.start();
        QTRY_VERIFY(port.state().carrier == Interface::State::Open);
        port.with([](Interface &carrier) {
            carrier.close();
            carrier.open();
            carrier.write("hello");
        });
        QTRY_COMPARE(came, QByteArray("hello"));
        QTRY_COMPARE(port.state().counters.bytesOut, quint64(5));
        QCOMPARE(port.state().counters.opened, quint64(2));
        port.end();
        port.with([](Interface &) { qFatal("there is no carrier"); });
    }
};
