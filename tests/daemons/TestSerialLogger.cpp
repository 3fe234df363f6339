#include "SerialLoggerFixture.h"

#include "common/Time.h"

using namespace hermes;

class TestSerialLogger : public QObject, SerialLoggerFixture {
    Q_OBJECT
private Q_SLOTS:
    void init() { setUp(); }
    void cleanup() { tearDown(); }
    void wrongPortsAreNamed_data();
    void wrongPortsAreNamed();
    void withoutPortsItWaits();
    void sendsToTheDevice();
    void saysWhatAPortLacks();
    void showsLines();
    void showsFixes();
    void theLastFixIsNotHeldBack();
};

void TestSerialLogger::wrongPortsAreNamed_data() {
    const Rows<QString, QString> row("ports", "complaint");
    row("no array", "{}", "ports");
    row("no url", R"([{"name":"a"}])", "url");
    row("no name", R"([{"url":"tcp://127.0.0.1:1"}])", "name");
    row("path as name", R"([{"name":"a/b","url":"tcp://127.0.0.1:1"}])", "name");
    row("unknown member", R"([{"name":"a","url":"tcp://127.0.0.1:1","baud":1}])", "baud");
    row("unknown scheme", R"([{"name":"a","url":"usb://x"}])", "ports.0.url");
    row("no address", R"([{"name":"a","url":""}])", "ports.0.url");
    row("no device", R"([{"name":"a","url":"serial://"}])", "ports.0.url");
    row("unknown view", R"([{"name":"a","url":"tcp://127.0.0.1:1","view":"hex"}])", "view");
    row("twice", R"([{"name":"a","url":"tcp://127.0.0.1:1"},{"name":"a","url":"tcp://127.0.0.1:2"}])",
        "ports.1.name");
}

void TestSerialLogger::wrongPortsAreNamed() {
    FETCH(QString, ports, QString, complaint);
    SerialLogger daemon;
    const auto array = QJsonDocument::fromJson(ports.toUtf8());
    const auto result = daemon.settings().set(
        {{"ports", array.isArray() ? QJsonValue(array.array()) : QJsonValue(array.object())}});
    QVERIFY(!result.ok());
    const QString text = QJsonDocument(result.error().data.toObject()).toJson();
    VERIFY_CONTAINS(text, complaint);
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
    VERIFY_CONTAINS(closed.message, "dev is closed");
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

void TestSerialLogger::showsLines() {
    launch({QJsonObject{{"name", "dev"}, {"url", deviceUrl()}}});
    QTRY_VERIFY(isOpen("dev"));
    QList<QJsonObject> lines;
    client_->subscribe("lines", {{"queue", 100}},
                       [&](const TopicUpdate &update) { lines << update.json().toObject(); });
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
                       [&](const TopicUpdate &update) { fixes << update.json().toObject(); });
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

/// Of a receiver that may say more, and then says nothing at all.
void TestSerialLogger::theLastFixIsNotHeldBack() {
    launch({QJsonObject{{"name", "gps"}, {"url", deviceUrl()}, {"view", "nmea"}}});
    QTRY_VERIFY(isOpen("gps"));
    QList<double> late;
    client_->subscribe("fix", {{"queue", 100}}, [&](const TopicUpdate &update) {
        late << monotonicNow() - update.json().toObject().value("mono").toDouble();
    });
    QTRY_VERIFY(daemon_->hasSubscribers("fix"));
    device_->write(gga);
    QTRY_COMPARE(late.size(), 1);
    QVERIFY(late[0] > 0.45);
    device_->write(rmc); // of the same moment
    QTRY_COMPARE(port("gps").value("nmea").toObject().value("late").toInt(), 1);
    QCOMPARE(late.size(), 1);
}
