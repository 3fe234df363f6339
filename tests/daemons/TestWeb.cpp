// What hermes-web makes of requests, schemas and messages, without a network.
#include "common/settings/DottedPath.h"
#include "daemons/web/FoxgloveSchemas.h"
#include "daemons/web/Frames.h"
#include "daemons/web/HttpRequest.h"
#include "daemons/web/MapScene.h"
#include "daemons/web/PlainJson.h"
#include "protocol/messages/Fixes.h"
#include "protocol/wire/Fields.h"
#include "protocol/wire/JsonText.h"

using namespace hermes;
using namespace hermes::web;

class TestWeb : public QObject {
    Q_OBJECT
private:
    static TopicUpdate update(const char *topic, const QJsonValue &data) {
        TopicUpdate made;
        made.topic = topic;
        made.stamp = 12.5;
        made.data = WireValue(data);
        return made;
    }
    static QJsonObject shown(View &view, const TopicUpdate &update) {
        ReadReport report;
        const QByteArray json = view.take({"one", update}, report);
        return QJsonDocument::fromJson(json.isEmpty() ? view.due() : json).object();
    }
    static std::unique_ptr<View> viewOf(const char *topic, FrameTree &frames) {
        for (const ViewKind &kind : viewKinds())
            if (QByteArray(kind.topic) == topic)
                return kind.make(frames);
        return nullptr;
    }

private Q_SLOTS:
    void requestHeads_data() {
        QTest::addColumn<QByteArray>("head");
        QTest::addColumn<bool>("isOne");
        QTest::newRow("plain") << QByteArray("GET / HTTP/1.1\r\nHost: a\r\n\r\n") << true;
        QTest::newRow("line feeds alone") << QByteArray("GET / HTTP/1.1\nHost: a\n\n") << true;
        QTest::newRow("empty") << QByteArray("\r\n\r\n") << false;
        QTest::newRow("no path") << QByteArray("GET  HTTP/1.1\r\n\r\n") << false;
        QTest::newRow("old") << QByteArray("GET / HTTP/1.0\r\n\r\n") << false;
        QTest::newRow("no colon") << QByteArray("GET / HTTP/1.1\r\nHost\r\n\r\n") << false;
        QTest::newRow("no name") << QByteArray("GET / HTTP/1.1\r\n: a\r\n\r\n") << false;
        QTest::newRow("a folded line") << QByteArray("GET / HTTP/1.1\r\nA: b\r\n c: d\r\n\r\n") << false;
        QTest::newRow("a zero") << QByteArray("GET / HTTP/1.1\r\nA: b\0c\r\n\r\n", 26) << false;
        QTest::newRow("JSON") << QByteArray("{\"id\": 1}\r\n\r\n") << false;
    }
    void requestHeads() {
        QFETCH(QByteArray, head);
        QFETCH(bool, isOne);
        QCOMPARE(HttpRequest::parse(head).has_value(), isOne);
    }

    void subprotocolThatIsOfferedFirst() {
        const auto chosen = [](const QByteArray &offered) {
            return HttpRequest::parse("GET / HTTP/1.1\r\nSEC-WebSocket-Protocol: " + offered + "\r\n\r\n")
                ->subprotocol();
        };
        QCOMPARE(chosen("foxglove.sdk.v1, foxglove.websocket.v1"), QByteArray("foxglove.sdk.v1"));
        QCOMPARE(chosen("chat\r\nSec-WebSocket-Protocol: foxglove.websocket.v1"),
                 QByteArray("foxglove.websocket.v1"));
        QCOMPARE(chosen("Foxglove.sdk.v1, foxglove.sdk.v10"), QByteArray());
    }

    void pagesThatMayConnect_data() {
        QTest::addColumn<QByteArray>("host");
        QTest::addColumn<QByteArray>("origin");
        QTest::addColumn<bool>("may");
        const QByteArray own = QSysInfo::machineHostName().toLatin1();
        QTest::newRow("no page") << QByteArray("a:1") << QByteArray() << true;
        QTest::newRow("its own") << QByteArray("10.0.0.2:8765") << QByteArray("http://10.0.0.2:8765") << true;
        QTest::newRow("by IPv6") << QByteArray("[::1]:8765") << QByteArray("http://[::1]:8765") << true;
        QTest::newRow("by name") << own + ":8765"
                                 << "http://" + own + ":8765" << true;
        QTest::newRow("in the network") << own + ".local:1"
                                        << "http://" + own + ".local:1" << true;
        QTest::newRow("allowed") << QByteArray("10.0.0.2:8765") << QByteArray("https://app.example") << true;
        QTest::newRow("another port")
            << QByteArray("127.0.0.1:8765") << QByteArray("http://127.0.0.1:80") << false;
        QTest::newRow("a name that was bent")
            << QByteArray("evil.example:1") << QByteArray("http://evil.example:1") << false;
        QTest::newRow("a longer one")
            << QByteArray("127.0.0.1:8765") << QByteArray("http://127.0.0.1:8765.evil.example") << false;
        QTest::newRow("with a user") << QByteArray("evil@127.0.0.1:1") << QByteArray("http://127.0.0.1:1")
                                     << false;
        QTest::newRow("hidden") << QByteArray("127.0.0.1:8765") << QByteArray("null") << false;
    }
    void pagesThatMayConnect() {
        QFETCH(QByteArray, host);
        QFETCH(QByteArray, origin);
        QFETCH(bool, may);
        HttpRequest request{"GET", "/", {{"host", host}}};
        if (!origin.isEmpty())
            request.headers["origin"] = origin;
        QCOMPARE(request.isFromOwnPage({"https://app.example"}), may);
    }

    void framesOfClients_data() {
        using Kind = ClientFrame::Kind;
        QTest::addColumn<QByteArray>("hex");
        QTest::addColumn<int>("kind");
        QTest::addColumn<QByteArray>("content");
        const auto row = [](const char *name, const char *hex, Kind kind, const char *content = "") {
            QTest::newRow(name) << QByteArray(hex) << int(kind) << QByteArray(content);
        };
        row("empty", "", Kind::Bad);
        row("a message", "01 07000000 7b7d", Kind::Message, "{}");
        row("a message without content", "01 07000000", Kind::Message);
        row("a message cut short", "01 070000", Kind::Bad);
        row("a call", "02 07000000 09000000 04000000 6a736f6e 7b7d", Kind::Call, "{}");
        row("a call without parameters", "02 07000000 09000000 04000000 6a736f6e", Kind::Call);
        row("a call cut short", "02 07000000 09000000 0400", Kind::Bad);
        row("an encoding beyond the end", "02 07000000 09000000 05000000 6a736f6e", Kind::Bad);
        row("an encoding beyond all", "02 07000000 09000000 ffffffff 6a736f6e", Kind::Bad);
        row("of the server", "03 07000000 09000000 04000000 6a736f6e", Kind::Bad);
    }
    void framesOfClients() {
        QFETCH(QByteArray, hex);
        const ClientFrame frame = ClientFrame::parse(QByteArray::fromHex(hex));
        QTEST(int(frame.kind), "kind");
        QTEST(frame.content, "content");
        QCOMPARE(frame.id, frame.kind == ClientFrame::Kind::Bad ? 0u : 7u);
        QCOMPARE(frame.call, frame.kind == ClientFrame::Kind::Call ? 9u : 0u);
    }
    void framesOfTheServer() {
        QCOMPARE(messageFrame(0x01020304, 1.5, "{}").toHex(), QByteArray("01"
                                                                         "04030201"
                                                                         "002f685900000000"
                                                                         "7b7d"));
        QCOMPARE(answerFrame(5, 6, "{}").toHex(), QByteArray("03"
                                                             "05000000"
                                                             "06000000"
                                                             "04000000"
                                                             "6a736f6e"
                                                             "7b7d"));
        QCOMPARE(messageFrame(0, -1e300, "").toHex(), QByteArray("01000000000000000000000000"));
    }

    void schemasBecomePlain() {
        const QJsonObject maybe{
            {"type", QJsonArray{"number", "null"}}, {"unit", "m"}, {"description", "How far"}};
        const QJsonObject pairs{{"type", "array"}, {"items", QJsonObject{{"type", "array"}}}};
        const QJsonObject numbers{{"type", "array"}, {"items", QJsonObject{{"type", "number"}}}};
        const QJsonObject schema = plainSchema(
            {{"type", "object"},
             {"properties",
              QJsonObject{{"a", maybe}, {"b", pairs}, {"c", numbers}, {"d", QJsonObject{{"x-open", true}}}}},
             {"required", QJsonArray{"a", "b", "c"}},
             {"additionalProperties", false}});
        QCOMPARE(schema["properties"].toObject().keys(), (QStringList{"a", "c"}));
        QCOMPARE(schema["properties"].toObject()["a"],
                 QJsonValue(QJsonObject{{"type", "number"}, {"description", "How far (m)"}}));
        QCOMPARE(schema["required"], QJsonValue(QJsonArray{"c"}));
        QVERIFY(!schema.contains("additionalProperties"));
        QCOMPARE(valueAt(plainSchema(numbers), "properties.value.type"), QJsonValue("array"));
        QCOMPARE(plainSchema(pairs)["properties"], QJsonValue(QJsonObject()));
        QCOMPARE(plainSchema({})["type"], QJsonValue("object"));
    }

    void dataBecomePlain() {
        const QJsonObject data{{"a", QJsonValue::Null},
                               {"b", QJsonArray{1, QJsonValue::Null, QJsonObject{{"c", QJsonValue::Null}}}},
                               {"d", "x\"y"},
                               {"replayed", false}};
        QCOMPARE(plainJson(WireValue(QJsonValue(data)), false),
                 QByteArray("{\"b\":[1,null,{}],\"d\":\"x\\\"y\",\"replayed\":false}"));
        QCOMPARE(plainJson(WireValue(QJsonValue(data)), true),
                 QByteArray("{\"replayed\":true,\"b\":[1,null,{}],\"d\":\"x\\\"y\"}"));
        QCOMPARE(plainJson(WireValue(QJsonValue(QJsonArray{1.5})), false), QByteArray("{\"value\":[1.5]}"));
        QCOMPARE(plainJson(WireValue(QJsonValue()), false), QByteArray("{}"));
    }

    void scanIsACloud() {
        FrameTree frames;
        const auto view = viewOf("scan2d", frames);
        const QJsonObject cloud =
            shown(*view, update("scan2d", QJsonObject{{"stamp", 3.25},
                                                      {"x", QJsonArray{1, -2.5}},
                                                      {"y", QJsonArray{0, 4}},
                                                      {"intensity", QJsonArray{7, 255}}}));
        const QByteArray data = QByteArray::fromBase64(cloud["data"].toString().toLatin1());
        QCOMPARE(data.size(), 2 * cloud["point_stride"].toInt());
        const auto number = [&](int point, int field) {
            return qFromLittleEndian<float>(data.constData() + 16 * point + 4 * field);
        };
        QCOMPARE(number(0, 0), 1.f);
        QCOMPARE(number(1, 0), -2.5f);
        QCOMPARE(number(1, 1), 4.f);
        QCOMPARE(number(1, 2), 0.f);
        QCOMPARE(number(1, 3), 255.f);
        QCOMPARE(cloud["timestamp"], QJsonValue(QJsonObject{{"sec", 3}, {"nsec", 250000000}}));
        QCOMPARE(cloud["frame_id"].toString(), QString("one"));
        ReadReport report;
        const TopicUpdate uneven =
            update("scan2d", QJsonObject{{"stamp", 1}, {"x", QJsonArray{1}}, {"y", QJsonArray()}});
        QVERIFY(view->take({"one", uneven}, report).isEmpty());
        QVERIFY(report.text().contains("same length"));
    }

    void mapComesInParts() {
        FrameTree frames;
        MapScene scene;
        const auto edge = [](int id, double x) {
            return QJsonObject{{"id", id}, {"x1", x}, {"y1", 0}, {"x2", x}, {"y2", 1}};
        };
        const auto message = [](bool cleared, const QJsonArray &edges, const QJsonArray &removed = {}) {
            return update("map", QJsonObject{{"revision", 1},
                                             {"cleared", cleared},
                                             {"edges", edges},
                                             {"removed", removed},
                                             {"size", 0}});
        };
        const QJsonObject first = shown(scene, message(true, {edge(1, 5), edge(2, 6), edge(700, 7)}));
        QCOMPARE(first["deletions"].toArray().size(), 1);
        QCOMPARE(first["entities"].toArray().size(), 2);
        QCOMPARE(first["entities"][0]["lines"][0]["points"].toArray().size(), 4);
        QVERIFY(scene.due().isEmpty());
        const QJsonObject second = shown(scene, message(false, {edge(2, 8)}, {1, 4000}));
        QCOMPARE(second["deletions"].toArray().size(), 0);
        QCOMPARE(second["entities"].toArray().size(), 1);
        QCOMPARE(second["entities"][0]["lines"][0]["points"].toArray().size(), 2);
        QCOMPARE(second["entities"][0]["id"], first["entities"][0]["id"]);
        QCOMPARE(shown(scene, message(true, {}))["entities"].toArray().size(), 0);
    }

    /// The pose of the sensor that the frames lead to is the one that the matcher told.
    void framesLeadToThePose_data() {
        QTest::addColumn<bool>("isByOdometry");
        QTest::newRow("by odometry") << true;
        QTest::newRow("by scans alone") << false;
    }
    void framesLeadToThePose() {
        QFETCH(bool, isByOdometry);
        const Pose2D mount{0.3, -0.1, 0.5}, odometry{4, 2, 1}, map{1, 1, -0.4};
        const Pose2D pose = map * odometry * mount;
        FrameTree frames;
        frames.robot().addScanner("velodynelogger", "127.0.0.1:7420");
        frames.robot().addScanner("scanner", "127.0.0.1:7470");
        frames.robot().takeSettings(
            "scanmatcher",
            {{"source", QJsonObject{{"address", "127.0.0.1:7470"}}},
             {"sensor", QJsonObject{{"x_m", mount.x}, {"y_m", mount.y}, {"theta_rad", mount.theta}}}});
        frames.setOdometry(odometry);
        PoseMessage message;
        message.pose = pose;
        if (isByOdometry)
            message.odometryFrame = map;
        frames.setPose(message);
        const QJsonArray all = frames.transforms(1)["transforms"].toArray();
        QCOMPARE(all.size(), 4);
        Pose2D led;
        for (int i = 0; i < 3; ++i) {
            const QJsonValue one = all[i];
            led = led *
                  Pose2D{one["translation"]["x"].toDouble(), one["translation"]["y"].toDouble(),
                         2 * std::atan2(one["rotation"]["z"].toDouble(), one["rotation"]["w"].toDouble())};
        }
        QCOMPARE(all[2]["child_frame_id"], QJsonValue("scanner"));
        QVERIFY(std::hypot(led.x - pose.x, led.y - pose.y) < 1e-9);
        QVERIFY(std::abs(std::remainder(led.theta - pose.theta, 2 * M_PI)) < 1e-9);
    }

    void placeOnlyWhereTheReceiverKnowsIt() {
        FrameTree frames;
        const auto view = viewOf("fix", frames);
        QJsonObject fix = asJson(FixMessage()).toObject();
        fix["valid"] = true;
        fix["lat_deg"] = 48.1;
        fix["lon_deg"] = 11.5;
        QCOMPARE(shown(*view, update("fix", fix))["latitude"].toDouble(), 48.1);
        fix["valid"] = false;
        QVERIFY(shown(*view, update("fix", fix)).isEmpty());
        fix["valid"] = true;
        fix["lat_deg"] = QJsonValue::Null;
        QVERIFY(shown(*view, update("fix", fix)).isEmpty());
    }

    void everyViewHasASchema() {
        for (const ViewKind &kind : viewKinds())
            QVERIFY2(foxgloveSchema(kind.schema).value("properties").toObject().size() > 1, kind.schema);
        QCOMPARE(
            valueAt(
                foxgloveSchema("SceneUpdate"),
                "properties.entities.items.properties.lines.items.properties.points.items.properties.z.type"),
            QJsonValue("number"));
    }
};
