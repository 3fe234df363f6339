// The recordings of the serial logger: made, exported, replayed.
#include "SerialLoggerFixture.h"
#include "common/recording/Sidecar.h"
#include "tests/support/FreePort.h"

using namespace hermes;

class TestSerialRecording : public QObject, SerialLoggerFixture {
    Q_OBJECT
    /// Fixes as a replay tells them.
    static QJsonArray marked(const QJsonArray &fixes) {
        QJsonArray all;
        for (const QJsonValue &one : fixes) {
            QJsonObject fix = one.toObject();
            fix["replayed"] = true;
            all.append(fix);
        }
        return all;
    }

private Q_SLOTS:
    void init() { setUp(); }
    void cleanup() { tearDown(); }

    void recordsASerialLine() {
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

    /// As after a kill, or a cut of the power: the same session goes on behind what was received before.
    void goesOnInTheSameSession() {
        launch({QJsonObject{{"name", "dev"}, {"url", deviceUrl()}, {"view", "none"}}});
        QTRY_VERIFY(isOpen("dev"));
        const QJsonObject session{{"name", "run"}, {"session", "id"}};
        QString folder;
        int all = 0;
        for (const char *text : {"one", "two and more"}) {
            folder = call("record.start", session).toObject().value("folder").toString();
            call("mark", {{"text", text}});
            device_->write(text);
            all += int(strlen(text));
            QTRY_COMPARE(call("record.status").toObject().value("bytes").toInt(), all);
            call("record.stop");
            // As if another run of the kernel had recorded it, by a monotonic clock of its own.
            auto sidecar = Sidecar::read(folder + "/seriallogger.json");
            QVERIFY(sidecar.ok());
            QCOMPARE(sidecar->value("counts").toObject().value("marks").toInt(), text[0] == 'o' ? 1 : 2);
            sidecar->insert("boot", "another");
            if (all == 3) // and as if the wall clock had been set by an hour then
                sidecar->insert("start", sidecar->value("start").toDouble() - 3600);
            for (const char *mono : {"start_mono", "end_mono"})
                sidecar->insert(mono, sidecar->value(mono).toDouble() + 1000);
            QVERIFY(Sidecar::write(folder + "/seriallogger.json", *sidecar, true).ok());
        }
        QCOMPARE(contentOf(folder + "/seriallogger-dev.raw"), QByteArray("onetwo and more"));
        const auto sidecar = Sidecar::read(folder + "/seriallogger.json");
        QCOMPARE(sidecar->value("losses").toObject().value("interruptions").toInt(), 1);
        QCOMPARE(sidecar->value("files").toArray().size(), 1);
        const double length = sidecar->value("end_mono").toDouble() - sidecar->value("start_mono").toDouble();
        const double byWallClock = sidecar->value("end").toDouble() - sidecar->value("start").toDouble();
        QVERIFY2(std::abs(length - (byWallClock - 3600)) < 0.1, saying(length));
        const QByteArray index = contentOf(folder + "/seriallogger-dev.index");
        const double last = double(qFromLittleEndian<qint64>(index.constData() + index.size() - 8)) * 1e-9;
        const double after = last - (sidecar->value("start_mono").toDouble() -
                                     1000); // as it was written before the last change
        QVERIFY2(after > 0 && after < length, saying(after));
    }

    void recordsDatagramsAndStreams() {
        QTcpServer server;
        QVERIFY(server.listen(QHostAddress::LocalHost));
        const quint16 udpPort = reservePort();
        launch(
            {QJsonObject{{"name", "udp"}, {"url", QString("udp://127.0.0.1:%1").arg(udpPort)}},
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

    void marksNeedARecording() {
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

    void exportsToCsv() {
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
        QCOMPARE(failure("record.export", {{"name", "none"}, {"port", "gps"}}).code,
                 int(ErrorCode::InputOutput));
        for (const char *wrong : {"../run", ".", "a/b", ""}) {
            QCOMPARE(failure("record.export", {{"name", wrong}, {"port", "gps"}}).code,
                     int(ErrorCode::InvalidParams));
            QCOMPARE(failure("record.export", {{"name", "run"}, {"port", wrong}}).code,
                     int(ErrorCode::InvalidParams));
        }
    }

    void replaysARecording() {
        launch({QJsonObject{{"name", "gps"}, {"url", deviceUrl()}, {"view", "nmea"}},
                QJsonObject{{"name", "raw"},
                            {"url", QString("udp://127.0.0.1:%1").arg(reservePort())},
                            {"view", "none"}}});
        QTRY_VERIFY(isOpen("gps"));
        QJsonArray lines, fixes;
        client_->subscribe("lines", {{"queue", 100}},
                           [&](const TopicUpdate &update) { lines << update.json(); });
        client_->subscribe("fix", {{"queue", 100}},
                           [&](const TopicUpdate &update) { fixes << update.json(); });
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
        QCOMPARE(call("source.open", {{"recording", "run"}, {"paused", true}, {"delay_s", 0.1}})["paused"]
                     .toBool(),
                 true);
        device_->write("not shown now\r\n");
        timer.start();
        call("source.pause", {{"paused", false}});
        QTRY_COMPARE(call("source.status")["source"]["state"].toString(), "ended");
        QTRY_COMPARE(lines, liveLines); // with their stamps
        QTRY_COMPARE(fixes, marked(liveFixes));
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

        QFile raw(folder_->filePath("recordings/run/seriallogger-gps.raw"));
        QVERIFY(raw.resize(raw.size() - 5));
        call("source.open", {{"recording", "run"}, {"speed", 1000}});
        QTRY_COMPARE(call("source.status")["source"]["state"].toString(), "ended");
        const QString missing = call("source.status")["source"]["error"].toString();
        VERIFY_CONTAINS(missing, raw.fileName());
        QCOMPARE(healthItem("source").value("level").toString(), "error");
        call("source.open", {{"live", true}});
        QVERIFY(QFile::remove(folder_->filePath("recordings/run/seriallogger-gps.index")));
        QVERIFY(failure("source.open", {{"recording", "run"}}).is(ErrorCode::InputOutput));
        QCOMPARE(call("source.status")["source"]["state"].toString(), "live");
    }

    // What the port gets meanwhile is not decoded, and so no sentence is found in it.
    void aReplayIsNoForeignDevice() {
        launch({QJsonObject{{"name", "gps"}, {"url", deviceUrl()}, {"view", "nmea"}}});
        QTRY_VERIFY(isOpen("gps"));
        call("record.start", {{"name", "run"}});
        device_->write(rmc + gga);
        QTRY_COMPARE(port("gps").value("bytes").toInt(), rmc.size() + gga.size());
        call("record.stop");
        call("source.open", {{"recording", "run"}, {"paused", true}});
        constexpr int seconds = 6; // more than are forgiven
        for (int i = 0; i < 2 * seconds; ++i) {
            device_->write(rmc.repeated(3) + gga.repeated(3));
            QTest::qWait(500);
            QCOMPARE(healthItem("port gps").value("level").toString(), "ok");
        }
        call("source.open", {{"live", true}});
        device_->write(rmc + gga);
        QTest::qWait(1500); // health is told each second
        QCOMPARE(healthItem("port gps").value("level").toString(), "ok");
    }

    /// Lines that came 0.3 s apart; sought while it waits, forth, back, and beyond its end.
    void seeksInAReplay() {
        launch({QJsonObject{{"name", "gps"}, {"url", deviceUrl()}, {"view", "nmea"}}});
        QTRY_VERIFY(isOpen("gps"));
        QStringList lines;
        int fixes = 0;
        client_->subscribe("lines", {{"queue", 100}},
                           [&](const TopicUpdate &update) { lines << update.json()["text"].toString(); });
        client_->subscribe("fix", {{"queue", 100}}, [&](const TopicUpdate &) { ++fixes; });
        QTRY_VERIFY(daemon_->hasSubscribers("lines") && daemon_->hasSubscribers("fix"));
        QVERIFY(failure("source.seek", {{"t_s", 1}}).is(ErrorCode::NotReady)); // it is live
        call("record.start", {{"name", "run"}});
        const auto recordLine = [&](const QByteArray &line) {
            const int before = lines.size();
            QTest::qWait(300);
            device_->write(line);
            QTRY_COMPARE(lines.size(), before + 1);
        };
        recordLine("one\r\n");
        recordLine("two\r\n");
        recordLine(rmc);
        recordLine(gga);
        QTRY_COMPARE(fixes, 1);
        const QJsonValue status = call("record.stop");
        const double length_s = stampNow() - status["start"].toDouble();
        const double delay_s = 5;
        const auto source = [&] { return call("source.status")["source"]; };
        const auto seek = [&](double t_s) {
            lines.clear();
            fixes = 0;
            return call("source.seek", {{"t_s", t_s}});
        };
        call("source.open", {{"recording", "run"}, {"paused", true}, {"delay_s", delay_s}});
        QCOMPARE(seek(delay_s + 0.45)["position_s"].toDouble(), delay_s + 0.45);
        QVERIFY(source()["paused"].toBool());
        call("source.pause", {{"paused", false}});
        QTRY_COMPARE(lines.value(0), QString("two"));
        seek(delay_s + 0.15);
        QTRY_COMPARE(lines.value(0), QString("one"));
        QCOMPARE(call("source.speed", {{"speed", 0.001}})["speed"].toDouble(), 0.001);
        seek(0); // before it begins
        QTest::qWait(300);
        QCOMPARE(lines.size(), 0);
        call("source.speed", {{"speed", 0}}); // nothing is waited for
        QTRY_COMPARE(lines.size(), 4);
        QTRY_COMPARE(fixes, 1);
        QTRY_COMPARE(source()["state"].toString(), QString("ended"));
        QVERIFY(failure("source.seek", {{"t_s", 0}}).is(ErrorCode::NotReady));
        call("source.open", {{"recording", "run"}, {"paused", true}});
        seek(length_s + 100);
        QTest::qWait(100);
        QCOMPARE(source()["state"].toString(), QString("replay")); // it waits at its end, too
        call("source.pause", {{"paused", false}});
        QTRY_COMPARE(source()["state"].toString(), QString("ended"));
        QCOMPARE(source()["error"], QJsonValue(QJsonValue::Undefined));
        QVERIFY(lines.isEmpty());
        QVERIFY(failure("source.seek", {{"t_s", -1}}).is(ErrorCode::InvalidParams));
        QVERIFY(failure("source.speed", {{"speed", -1}}).is(ErrorCode::InvalidParams));
    }

    void listsMarks() {
        launch({QJsonObject{{"name", "gps"}, {"url", deviceUrl()}, {"view", "nmea"}}});
        const QJsonValue begun = call("record.start", {{"name", "run"}});
        QVERIFY(failure("record.marks", {{"name", "run"}}).is(ErrorCode::NotReady)); // it has not ended
        QTest::qWait(200);
        const QJsonValue first = call("mark", {{"text", "at the door"}});
        call("mark", {{"text", QString("\u00fc \"event\":\"mark\"")}});
        call("record.stop");
        QFile events(folder_->filePath("recordings/run/seriallogger-events.jsonl"));
        QVERIFY(events.open(QIODevice::Append));
        events.write("no JSON\n{\"event\":\"mark\",\"text\":7}\n[1]\n" + QByteArray(100000, 'x'));
        events.close();
        const QJsonArray marks = call("record.marks", {{"name", "run"}}).toArray();
        QCOMPARE(marks.size(), 2);
        QCOMPARE(marks[0]["text"].toString(), QString("at the door"));
        QCOMPARE(marks[0]["stamp"], first["stamp"]);
        QVERIFY(std::abs(marks[0]["t_s"].toDouble() -
                         (first["stamp"].toDouble() - begun["start"].toDouble())) < 0.1);
        QVERIFY(marks[1]["t_s"].toDouble() >= marks[0]["t_s"].toDouble());
        QCOMPARE(marks[1]["text"].toString(), QString("\u00fc \"event\":\"mark\""));
        QVERIFY(events.remove());
        QCOMPARE(call("record.marks", {{"name", "run"}}).toArray().size(), 0);
        QVERIFY(failure("record.marks", {{"name", "../run"}}).is(ErrorCode::InvalidParams));
        QVERIFY(failure("record.marks", {{"name", "none"}}).is(ErrorCode::InputOutput));
    }
};
