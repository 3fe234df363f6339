#include "common/client/Client.h"
#include "common/interface/InterfaceRegistry.h"
#include "common/interface/PtyInterface.h"
#include "common/recording/Sidecar.h"
#include "daemons/seriallogger/SerialLogger.h"
#include "tests/support/FreePort.h"

#include <QTcpServer>
#include <QTcpSocket>
#include <QTemporaryDir>
#include <QUdpSocket>
#include <QtTest>

using namespace hermes;

namespace {

const QByteArray rmc("$GPRMC,123519,A,4807.038,N,01131.000,E,022.4,084.4,230394,003.1,W*6A\r\n");
const QByteArray gga("$GPGGA,123519,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,*47\r\n");

QByteArray contentOf(const QString &path) {
    QFile file(path);
    return file.open(QIODevice::ReadOnly) ? file.readAll() : "unreadable: " + path.toUtf8();
}

} // namespace

/// The daemon in this process, with devices on pseudo-terminals and sockets, and a client.
class TestSerialLogger : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void init();
    void cleanup();
    void wrongPortsAreNamed_data();
    void wrongPortsAreNamed();
    void withoutPortsItWaits();
    void recordsASerialLine();
    void recordsDatagramsAndStreams();
    void showsLines();
    void showsFixes();
    void sendsToTheDevice();
    void marksNeedARecording();
    void exportsToCsv();
    void saysWhatAPortLacks();
    void replaysARecording();

private:
    void launch(const QJsonArray &ports);
    QJsonValue call(const QString &method, const QJsonObject &params = {});
    Error failure(const QString &method, const QJsonObject &params = {});
    QJsonObject port(const QString &name);
    QJsonObject healthItem(const QString &name);
    bool isOpen(const QString &name) { return port(name).value("state") == "open"; }
    QString deviceUrl() const { return "serial://" + folder_->filePath("device"); }
    void plug();

    std::unique_ptr<QTemporaryDir> folder_;
    std::unique_ptr<PtyInterface> device_;
    std::unique_ptr<SerialLogger> daemon_;
    std::unique_ptr<Client> client_;
};

void TestSerialLogger::init() {
    folder_ = std::make_unique<QTemporaryDir>();
    plug();
}

void TestSerialLogger::plug() {
    device_ =
        std::make_unique<PtyInterface>(*InterfaceUrl::parse("pty://" + folder_->filePath("device")), nullptr);
    device_->open();
    QVERIFY(device_->isOpen());
}

void TestSerialLogger::cleanup() {
    client_.reset();
    if (daemon_)
        daemon_->shutDown();
    daemon_.reset();
    device_.reset();
}

void TestSerialLogger::launch(const QJsonArray &ports) {
    daemon_ = std::make_unique<SerialLogger>();
    client_ = std::make_unique<Client>();
    const QString text = QString::fromUtf8(QJsonDocument(ports).toJson(QJsonDocument::Compact));
    QVERIFY(!daemon_->prepare({"seriallogger", "--listen", "tcp://127.0.0.1:0", "--set", "ports=" + text,
                               "--set", "record.folder=" + folder_->filePath("recordings"), "--set",
                               "record.free_floor_bytes=0", "--set", "record.free_warn_bytes=0"}));
    QVERIFY(daemon_->launch().ok());
    QVERIFY(client_->connectTo(daemon_->server().addresses().value(0)).ok());
    QVERIFY(client_->waitConnected().ok());
}

QJsonValue TestSerialLogger::call(const QString &method, const QJsonObject &params) {
    const auto result = client_->callAndWait(method, params);
    if (!result)
        qWarning("%s: %s", qPrintable(method), qPrintable(result.error().message));
    return result ? *result : QJsonValue();
}

Error TestSerialLogger::failure(const QString &method, const QJsonObject &params) {
    const auto result = client_->callAndWait(method, params);
    return result ? Error(ErrorCode::InternalError, "succeeded, though it should not") : result.error();
}

QJsonObject TestSerialLogger::port(const QString &name) {
    for (const QJsonValue &port : call("ports.list").toArray())
        if (port.toObject().value("name") == name)
            return port.toObject();
    return {};
}

QJsonObject TestSerialLogger::healthItem(const QString &name) {
    for (const QJsonValue &item : call("daemon.status").toObject().value("health").toArray())
        if (item.toObject().value("name") == name)
            return item.toObject();
    return {};
}

void TestSerialLogger::wrongPortsAreNamed_data() {
    QTest::addColumn<QString>("ports");
    QTest::addColumn<QString>("complaint");
    QTest::newRow("no array") << "{}"
                              << "ports";
    QTest::newRow("no url") << R"([{"name":"a"}])"
                            << "url";
    QTest::newRow("no name") << R"([{"url":"tcp://127.0.0.1:1"}])"
                             << "name";
    QTest::newRow("path as name") << R"([{"name":"a/b","url":"tcp://127.0.0.1:1"}])"
                                  << "name";
    QTest::newRow("unknown member") << R"([{"name":"a","url":"tcp://127.0.0.1:1","baud":1}])"
                                    << "baud";
    QTest::newRow("unknown scheme") << R"([{"name":"a","url":"usb://x"}])"
                                    << "ports.0.url";
    QTest::newRow("no address") << R"([{"name":"a","url":""}])"
                                << "ports.0.url";
    QTest::newRow("no device") << R"([{"name":"a","url":"serial://"}])"
                               << "ports.0.url";
    QTest::newRow("unknown view") << R"([{"name":"a","url":"tcp://127.0.0.1:1","view":"hex"}])"
                                  << "view";
    QTest::newRow("twice")
        << R"([{"name":"a","url":"tcp://127.0.0.1:1"},{"name":"a","url":"tcp://127.0.0.1:2"}])"
        << "ports.1.name";
}

void TestSerialLogger::wrongPortsAreNamed() {
    QFETCH(QString, ports);
    QFETCH(QString, complaint);
    SerialLogger daemon;
    const auto array = QJsonDocument::fromJson(ports.toUtf8());
    const auto result = daemon.settings().set(
        {{"ports", array.isArray() ? QJsonValue(array.array()) : QJsonValue(array.object())}});
    QVERIFY(!result.ok());
    const QString text = QJsonDocument(result.error().data.toObject()).toJson();
    QVERIFY2(text.contains(complaint), qPrintable(text));
}

void TestSerialLogger::withoutPortsItWaits() {
    launch({});
    QCOMPARE(call("ports.list").toArray().size(), 0);
    QCOMPARE(healthItem("ports").value("level").toString(), "warn");
    QCOMPARE(call("record.start", {{"name", "nothing"}}).toObject().value("recording").toBool(), true);
    QCOMPARE(call("record.stop").toObject().value("bytes").toInt(), 0);
    call("source.open", {{"recording", "nothing"}}); // nor played: it is at its end
    QTRY_COMPARE(call("source.status")["source"]["state"].toString(), "ended");
}

void TestSerialLogger::recordsASerialLine() {
    launch({QJsonObject{{"name", "dev"}, {"url", deviceUrl()}, {"view", "none"}}});
    QTRY_VERIFY(isOpen("dev"));
    QCOMPARE(port("dev").value("device").toString(), device_->device());
    device_->write("before");
    QTRY_COMPARE(port("dev").value("bytes").toInt(), 6);
    const QString folder = call("record.start", {{"name", "run"}}).toObject().value("folder").toString();
    QByteArray all;
    for (int i = 0; i < 256; ++i)
        all += char(i);
    device_->write(all);
    call("mark", {{"text", "here"}});
    QTRY_COMPARE(port("dev").value("bytes").toInt(), 6 + all.size());
    const QJsonObject result = call("record.stop").toObject();
    QCOMPARE(contentOf(folder + "/seriallogger-dev.raw"), all);
    QCOMPARE(result.value("counts").toObject().value("bytes").toInt(), all.size());
    QCOMPARE(result.value("counts").toObject().value("marks").toInt(), 1);
    const auto sidecar = Sidecar::read(folder + "/seriallogger.json");
    QVERIFY(sidecar.ok());
    QCOMPARE(sidecar->value("ended").toString(), "stopped");
    QCOMPARE(sidecar->value("files").toArray().at(0).toObject().value("url").toString(), deviceUrl());
    QCOMPARE(healthItem("port dev").value("level").toString(), "ok");
    QCOMPARE(call("record.list").toArray().size(), 1);
}

void TestSerialLogger::recordsDatagramsAndStreams() {
    QTcpServer server;
    QVERIFY(server.listen(QHostAddress::LocalHost));
    const quint16 udpPort = reservePort();
    launch({QJsonObject{{"name", "udp"}, {"url", QString("udp://127.0.0.1:%1").arg(udpPort)}},
            QJsonObject{{"name", "tcp"}, {"url", QString("tcp://127.0.0.1:%1").arg(server.serverPort())}}});
    QTRY_VERIFY(server.hasPendingConnections());
    std::unique_ptr<QTcpSocket> peer(server.nextPendingConnection());
    QTRY_VERIFY(isOpen("udp") && isOpen("tcp"));
    const QString folder = call("record.start", {{"name", "net"}}).toObject().value("folder").toString();
    QUdpSocket sender;
    for (const char *datagram : {"one", "two"})
        sender.writeDatagram(datagram, QHostAddress::LocalHost, udpPort);
    peer->write("stream");
    QTRY_COMPARE(port("udp").value("bytes").toInt(), 6);
    QTRY_COMPARE(port("tcp").value("bytes").toInt(), 6);
    peer->abort(); // the server goes; a new one is found
    peer.reset();
    QTRY_VERIFY(server.hasPendingConnections());
    peer.reset(server.nextPendingConnection());
    peer->write(" goes on");
    QTRY_COMPARE(port("tcp").value("bytes").toInt(), 14);
    call("record.stop");
    QCOMPARE(contentOf(folder + "/seriallogger-udp.raw"), QByteArray("onetwo"));
    QCOMPARE(contentOf(folder + "/seriallogger-tcp.raw"), QByteArray("stream goes on"));
    QCOMPARE(QFileInfo(folder + "/seriallogger-udp.index").size(),
             qint64(16 + 2 * 24)); // datagrams stay apart
    QVERIFY(contentOf(folder + "/seriallogger-events.jsonl").contains("\"event\":\"closed\""));
}

void TestSerialLogger::showsLines() {
    launch({QJsonObject{{"name", "dev"}, {"url", deviceUrl()}}});
    QTRY_VERIFY(isOpen("dev"));
    QList<QJsonObject> lines;
    client_->subscribe("lines", {{"queue", 100}},
                       [&](const TopicUpdate &update) { lines << update.data.toObject(); });
    QTRY_VERIFY(daemon_->hasSubscribers("lines"));
    device_->write("first\r\nsec");
    QTRY_COMPARE(lines.size(), 1);
    device_->write(QByteArray("ond \xe4\n", 6) + QByteArray(1100, 'x') + "\n");
    QTRY_COMPARE(lines.size(), 4);
    QCOMPARE(lines[0].value("text").toString(), "first");
    QCOMPARE(lines[0].value("port").toString(), "dev");
    QCOMPARE(lines[1].value("text").toString(), "second \\xE4");
    QCOMPARE(lines[1].value("stamp"), lines[0].value("stamp")); // of its first byte
    QVERIFY(lines[2].value("cut").toBool() && !lines[3].value("cut").toBool());
    QCOMPARE(lines[3].value("text").toString().size(), 1100 - 1024);
}

void TestSerialLogger::showsFixes() {
    launch({QJsonObject{{"name", "gps"}, {"url", deviceUrl()}, {"view", "nmea"}}});
    QTRY_VERIFY(isOpen("gps"));
    QList<QJsonObject> fixes;
    client_->subscribe("fix", {{"queue", 100}},
                       [&](const TopicUpdate &update) { fixes << update.data.toObject(); });
    QTRY_VERIFY(daemon_->hasSubscribers("fix"));
    device_->write("\xff\xfe$GPRMC,1\r\n" + rmc.left(40));
    device_->write(rmc.mid(40) + gga);
    QTRY_COMPARE(fixes.size(), 1);
    QCOMPARE(fixes[0].value("port").toString(), "gps");
    QCOMPARE(fixes[0].value("time").toDouble(), 764426119.0);
    QCOMPARE(fixes[0].value("satellites").toInt(), 8);
    const QJsonObject state = port("gps");
    QCOMPARE(state.value("nmea").toObject().value("sentences").toInt(), 2);
    QCOMPARE(state.value("nmea").toObject().value("no_checksum").toInt(), 1);
    QCOMPARE(state.value("fix").toObject().value("alt").toDouble(), 545.4);
    QCOMPARE(healthItem("port gps").value("level").toString(), "ok"); // the first may be half a sentence
    device_->write("$GPRMC,1\r\n");
    QTRY_COMPARE(healthItem("port gps").value("level").toString(), "warn");
}

void TestSerialLogger::sendsToTheDevice() {
    launch({QJsonObject{{"name", "dev"}, {"url", deviceUrl()}}});
    QTRY_VERIFY(isOpen("dev"));
    QByteArray atDevice;
    connect(device_.get(), &Interface::received, this, [&](const QByteArray &bytes) { atDevice += bytes; });
    QCOMPARE(call("send", {{"port", "dev"}, {"bytes", "B5 62 00 ff 0d"}}).toObject().value("sent").toInt(),
             5);
    QCOMPARE(call("send", {{"port", "dev"}, {"text", "hello\r\n"}}).toObject().value("sent").toInt(), 7);
    QTRY_COMPARE(atDevice, QByteArray("\xb5\x62\x00\xff\x0dhello\r\n", 12));
    for (const QJsonObject &wrong : {QJsonObject{{"port", "dev"}},
                                     {{"port", "dev"}, {"bytes", "B5 6"}},
                                     {{"port", "dev"}, {"bytes", "xy"}},
                                     {{"port", "dev"}, {"text", ""}},
                                     {{"port", "dev"}, {"bytes", "00"}, {"text", "a"}},
                                     {{"port", "other"}, {"bytes", "00"}}})
        QCOMPARE(failure("send", wrong).code, int(ErrorCode::InvalidParams));
    QVERIFY(failure("send", {{"port", "other"}, {"bytes", "00"}}).message.contains("one of: dev"));
    device_.reset();
    QTRY_VERIFY(!isOpen("dev"));
    const Error closed = failure("send", {{"port", "dev"}, {"text", "hello"}});
    QCOMPARE(closed.code, int(ErrorCode::NotReady));
    QVERIFY2(closed.message.contains("dev is closed"), qPrintable(closed.message));
}

void TestSerialLogger::marksNeedARecording() {
    launch({});
    QCOMPARE(failure("mark", {{"text", "lost"}}).code, int(ErrorCode::NotReady));
    const QString folder = call("record.start", {{"name", "m"}}).toObject().value("folder").toString();
    const double stamp = call("mark", {{"text", "kept"}}).toObject().value("stamp").toDouble();
    call("record.stop");
    const QJsonObject event =
        QJsonDocument::fromJson(contentOf(folder + "/seriallogger-events.jsonl")).object();
    QCOMPARE(event.value("text").toString(), "kept");
    QCOMPARE(event.value("stamp").toDouble(), stamp);
}

void TestSerialLogger::exportsToCsv() {
    launch({QJsonObject{{"name", "gps"}, {"url", deviceUrl()}, {"view", "nmea"}}});
    QTRY_VERIFY(isOpen("gps"));
    const QString folder = call("record.start", {{"name", "run"}}).toObject().value("folder").toString();
    device_->write(rmc + gga);
    QTRY_COMPARE(port("gps").value("bytes").toInt(), rmc.size() + gga.size());
    call("record.stop");
    const QJsonObject params{{"name", "run"}, {"port", "gps"}};
    const QJsonObject result = call("record.export", params).toObject();
    QCOMPARE(result.value("path").toString(), folder + "/seriallogger-gps-lines.csv");
    QCOMPARE(result.value("rows").toInt(), 2);
    QVERIFY(contentOf(result.value("path").toString()).contains(",\"$GPRMC,123519,A,"));
    QCOMPARE(failure("record.export", params).code, int(ErrorCode::InputOutput)); // is there
    QVERIFY(failure("record.export", params).message.contains("force"));
    QJsonObject more = params;
    more.insert("force", true);
    QCOMPARE(call("record.export", more).toObject().value("rows").toInt(), 2);
    more.insert("rows", "fixes");
    QCOMPARE(call("record.export", more).toObject().value("rows").toInt(), 1);
    QCOMPARE(failure("record.export", {{"name", "none"}, {"port", "gps"}}).code, int(ErrorCode::InputOutput));
    for (const char *wrong : {"../run", ".", "a/b", ""}) {
        QCOMPARE(failure("record.export", {{"name", wrong}, {"port", "gps"}}).code,
                 int(ErrorCode::InvalidParams));
        QCOMPARE(failure("record.export", {{"name", "run"}, {"port", wrong}}).code,
                 int(ErrorCode::InvalidParams));
    }
}

void TestSerialLogger::saysWhatAPortLacks() {
    device_.reset();
    launch({QJsonObject{{"name", "dev"}, {"url", deviceUrl()}, {"silence_s", 1}},
            QJsonObject{{"name", "odd"}, {"url", "serial:///dev/null?baud=many"}}});
    QTRY_VERIFY(port("dev").value("reason").toString().contains("there is no such device"));
    QTRY_VERIFY(healthItem("port odd").value("message").toString().contains("baud \"many\""));
    QCOMPARE(healthItem("port dev").value("level").toString(), "error");
    QTRY_COMPARE(call("daemon.status").toObject().value("state").toString(), "degraded");
    plug();
    QTRY_VERIFY(isOpen("dev"));
    QTRY_COMPARE(healthItem("port dev").value("level").toString(), "stale");
    device_->write("x");
    QTRY_COMPARE(healthItem("port dev").value("level").toString(), "ok");
}

void TestSerialLogger::replaysARecording() {
    launch({QJsonObject{{"name", "gps"}, {"url", deviceUrl()}, {"view", "nmea"}},
            QJsonObject{{"name", "raw"},
                        {"url", QString("udp://127.0.0.1:%1").arg(reservePort())},
                        {"view", "none"}}});
    QTRY_VERIFY(isOpen("gps"));
    QJsonArray lines, fixes;
    client_->subscribe("lines", {{"queue", 100}}, [&](const TopicUpdate &update) { lines << update.data; });
    client_->subscribe("fix", {{"queue", 100}}, [&](const TopicUpdate &update) { fixes << update.data; });
    QTRY_VERIFY(daemon_->hasSubscribers("lines") && daemon_->hasSubscribers("fix"));
    call("record.start", {{"name", "run"}});
    QVERIFY(failure("source.open", {{"recording", "run"}}).is(ErrorCode::NotReady)); // not ended
    device_->write(rmc + gga);
    QTRY_COMPARE(fixes.size(), 1);
    QTest::qWait(300); // a gap in time, to be found again
    device_->write("$GPTXT,1\r\nhalf a line");
    QTRY_COMPARE(lines.size(), 3);
    QTRY_COMPARE(port("gps").value("bytes").toInt(), rmc.size() + gga.size() + 21);
    call("record.stop");
    device_->write("\r\n");
    QTRY_COMPARE(lines.size(), 4);
    const QJsonArray liveLines = std::exchange(lines, {}), liveFixes = std::exchange(fixes, {});

    QElapsedTimer timer;
    QCOMPARE(
        call("source.open", {{"recording", "run"}, {"paused", true}, {"delay_s", 0.1}})["paused"].toBool(),
        true);
    device_->write("not shown now\r\n");
    timer.start();
    call("source.pause", {{"paused", false}});
    QTRY_COMPARE(call("source.status")["source"]["state"].toString(), "ended");
    QTRY_COMPARE(lines, liveLines); // with their stamps
    QTRY_COMPARE(fixes, liveFixes);
    QVERIFY(timer.elapsed() >= 400);
    QCOMPARE(healthItem("source").value("level").toString(), "ok");
    QVERIFY(failure("source.pause").is(ErrorCode::NotReady));

    QCOMPARE(call("source.open", {{"live", true}})["state"].toString(), "live");
    device_->write("live again\r\n");
    QTRY_COMPARE(lines.size(), 5);
    QCOMPARE(lines.last()["text"].toString(), "live again");
    QVERIFY(healthItem("source").isEmpty());

    QVERIFY(failure("source.open").is(ErrorCode::InvalidParams));
    QVERIFY(failure("source.open", {{"live", true}, {"recording", "run"}}).is(ErrorCode::InvalidParams));
    QVERIFY(failure("source.open", {{"recording", "../run"}}).is(ErrorCode::InvalidParams));
    QVERIFY(failure("source.open", {{"recording", "none"}}).is(ErrorCode::InputOutput));
    QVERIFY(QFile::remove(folder_->filePath("recordings/run/seriallogger-gps.index")));
    QVERIFY(failure("source.open", {{"recording", "run"}}).is(ErrorCode::InputOutput));
    QCOMPARE(call("source.status")["source"]["state"].toString(), "live");
}

QTEST_GUILESS_MAIN(TestSerialLogger)
#include "TestSerialLogger.moc"
