// Every framing over every carrier, also over one that cuts what it carries into pieces and delays it: a
// daemon and a client say the same to each other.
#include "DaemonFixture.h"
#include "common/client/Client.h"
#include "common/interface/InterfaceRegistry.h"
#include "common/tls/Authority.h"
#include "tests/support/FaultyInterface.h"

#include <QNetworkDatagram>

#include <sys/socket.h>

using namespace hermes;

class TestChannels : public QObject, DaemonFixture {
    Q_OBJECT

    /// With FOLDER, KEYS and PORT.
    struct Carrier {
        const char *name;
        const char *listen;
        const char *connect;
        int maxBytes; ///< of a frame; a pseudo-terminal holds 4096
    };

    static inline const Carrier carriers[] = {
        {"tcp", "tcp://127.0.0.1:0", "tcp://127.0.0.1:PORT", 500000},
        {"tls", "tls://127.0.0.1:0?keys=KEYS/issued-for/robot", "tls://127.0.0.1:PORT?keys=KEYS", 500000},
        {"local", "local://FOLDER/socket", "local://FOLDER/socket", 500000},
        {"udp", "udp://127.0.0.1:0", "udp://127.0.0.1:0?peer=127.0.0.1:PORT", 20000},
        {"serial line", "pty://FOLDER/line", "serial://FOLDER/line?baud=115200", 3000},
    };

private Q_SLOTS:
    void initTestCase() {
        Log::instance().setStderr(false);
        const Authority authority(keys_.path());
        QVERIFY(authority.init("tester", 1, 1) && authority.issue({"robot", "daemon"}, 1));
    }
    void cleanup() { tearDown(); }

    void sayTheSame_data() {
        Rows<QString, int, bool>("protocol", "carrier", "faulty");
        for (const QString &protocol : codecNames())
            for (int i = 0; i < int(std::size(carriers)); ++i)
                for (const bool faulty : {false, true})
                    QTest::addRow("%s over %s%s", qPrintable(protocol), carriers[i].name,
                                  faulty ? ", in pieces" : "")
                        << protocol << i << faulty;
    }

    void sayTheSame() {
        FETCH(QString, protocol, int, carrier, bool, faulty);
        const Carrier &kind = carriers[carrier];
        if (faulty && QString(kind.name) == "udp")
            return; // a datagram comes whole or not at all
        QTemporaryDir folder;
        const auto with = [&protocol](QString url) {
            return url + (url.contains('?') ? '&' : '?') + "protocol=" + protocol;
        };
        daemon = std::make_unique<TestedDaemon>();
        launch(*daemon, {},
               with(QString(kind.listen).replace("FOLDER", folder.path()).replace("KEYS", keys_.path())));
        const QString url = with(QString(kind.connect)
                                     .replace("FOLDER", folder.path())
                                     .replace("KEYS", keys_.path())
                                     .replace("PORT", QString::number(QUrl(address()).port())));
        const auto inner = makeInterface(*InterfaceUrl::parse(url), nullptr);
        QVERIFY(inner);
        Interface *carried = *inner;
        if (faulty)
            carried = new FaultyInterface(carried, {0, 0, 0.7, 3, 7}, nullptr);
        Client client;
        client.connectTo(new Channel(carried, makeCodec(protocol), nullptr));
        QVERIFY(client.waitConnected());

        const auto result = [&client](const QString &method, const QJsonArray &params) {
            const auto answer = client.callAndWait(method, params);
            return answer ? *answer : QJsonValue(answer.error().message);
        };
        for (int i = 0; i < 50; ++i)
            QCOMPARE(result("subtract", {i, 0.5}), QJsonValue(i - 0.5));
        QCOMPARE(result("large", {kind.maxBytes}), QJsonValue(QString(kind.maxBytes, 'x')));
        QVERIFY(client.callAndWait("nothing").error().is(ErrorCode::MethodNotFound));
        QCOMPARE(client.callAndWait("fault").error().data["device"].toString(), QString("t0"));
        QVERIFY(
            client.callAndWait("subtract", QJsonArray{"\u00e4\n\"", 1}).error().is(ErrorCode::InvalidParams));
        QVERIFY(client.callAndWait("nan").error().is(ErrorCode::InternalError));

        std::vector<int> sizes;
        client.subscribe("numbers", {{"queue", 100}}, [&](const TopicUpdate &update) {
            std::vector<float> numbers(update.data["x"].size());
            QCOMPARE(update.data["x"].numbers(numbers.data()), numbers.size());
            for (size_t i = 0; i < numbers.size(); ++i)
                QCOMPARE(numbers[i], float(i) * 0.1f);
            sizes.push_back(int(numbers.size()));
        });
        QTRY_VERIFY(daemon->hasSubscribers("numbers"));
        const std::vector<int> sent{0, 1, 2, 3, 10, kind.maxBytes / 40};
        for (const int size : sent)
            daemon->publish("numbers", Outgoing::writtenBy([size](WireWriter &out) {
                                std::vector<float> numbers;
                                for (int i = 0; i < size; ++i)
                                    numbers.push_back(float(i) * 0.1f);
                                out.beginObject();
                                out.key("x");
                                out.numbers(numbers.data(), numbers.size());
                                out.endObject();
                            }));
        QTRY_COMPARE(sizes, sent);
        QCOMPARE(client.rejected().unreadable, 0);
        QCOMPARE(daemon->server().counters()["malformed_frames"].toInt(), 0);
    }

    void agreeOnAFraming() {
        start();
        const QString place = address();
        Client client;
        client.prefer("cbor");
        QSignalSpy connected(&client, &Client::connected);
        std::vector<double> got;
        client.subscribe("numbers", {{"queue", 10}},
                         [&](const TopicUpdate &update) { got.push_back(update.data.number()); });
        client.connectTo(place);
        QVERIFY(!client.isConnected());
        QVERIFY(client.callAndWait("daemon.info").error().is(ErrorCode::Disconnected)); // before it is agreed
        const auto check = [&] {
            QVERIFY(client.waitConnected());
            QCOMPARE(client.callAndWait("subtract", QJsonArray{5, 3})->toInt(), 2);
            QTRY_VERIFY(daemon->hasSubscribers("numbers"));
            got.clear();
            daemon->publish("numbers", 7.5);
            QTRY_COMPARE(got, std::vector<double>{7.5});
            // From here on the daemon does not understand lines.
            const double malformed = daemon->server().counters()["malformed_frames"].toDouble();
            QCOMPARE(malformed, 0.0);
            QCOMPARE(client.rejected().unreadable, quint64(0));
        };
        check();
        daemon.reset(); // and one that begins anew begins with lines
        QTRY_VERIFY(!client.isConnected());
        daemon = std::make_unique<TestedDaemon>();
        launch(*daemon, {}, place);
        QTRY_COMPARE(connected.count(), 2);
        check();
    }

    void goOnWithAnOldDaemon() {
        QTcpServer server;
        QVERIFY(server.listen(QHostAddress(QHostAddress::LocalHost)));
        Client client;
        client.prefer("cbor");
        client.connectTo(QString("127.0.0.1:%1").arg(server.serverPort()));
        QTRY_VERIFY(server.hasPendingConnections());
        QTcpSocket *const peer = server.nextPendingConnection();
        QTRY_VERIFY(peer->canReadLine());
        QVERIFY(peer->readLine().contains("protocol.use"));
        QVERIFY(!client.isConnected());
        peer->write(
            "{\"jsonrpc\":\"2.0\",\"id\":1,\"error\":{\"code\":-32601,\"message\":\"no such method\"}}\n");
        QVERIFY(client.waitConnected());
        client.notify("hello", QJsonObject());
        QTRY_VERIFY(peer->canReadLine());
        QCOMPARE(peer->readLine(), QByteArray("{\"jsonrpc\":\"2.0\",\"method\":\"hello\",\"params\":{}}\n"));
        peer->close(); // while a new one is agreed on
        QTRY_VERIFY(!client.isConnected());
        QTRY_VERIFY(server.hasPendingConnections());
        client.close();
        QVERIFY(!client.isConnected());
    }

    void doNotChangeMidway() {
        start();
        RawClient client(address());
        const auto code = [&client](const QJsonValue &params) {
            return client.ask("protocol.use", params)["error"].toObject()["code"].toInt();
        };
        QCOMPARE(code(QJsonArray{"morse"}), int(ErrorCode::InvalidParams));
        client.send(R"([{"jsonrpc":"2.0","id":1,"method":"protocol.use","params":["cbor"]}])");
        QVERIFY(client.line().contains("-32005"));
        client.request(5, "later"); // is answered later
        QCOMPARE(code(QJsonArray{"cbor"}), int(ErrorCode::NotReady));
        daemon->replies.back().result(1);
        QCOMPARE(client.message()["id"].toInt(), 5);
        const int subscription = client.ask("topics.subscribe", QJsonArray{"numbers"})["result"]
                                     .toObject()["subscription"]
                                     .toInt();
        QCOMPARE(code(QJsonArray{"cbor"}), int(ErrorCode::NotReady));
        client.ask("topics.unsubscribe", QJsonArray{subscription});
        QVERIFY(client.ask("protocol.use", QJsonArray{"json"}).contains("result")); // as it is already
        QVERIFY(client.ask("protocol.use", QJsonArray{"cbor"}).contains("result"));
        const auto codec = makeCodec("cbor");
        client.socket.write(codec->encode(makeRequest(9, "subtract", QJsonArray{5, 3})).bytes);
        QTRY_VERIFY(client.socket.bytesAvailable() >= 30);
        const std::vector<CodecItem> items = codec->feed(client.socket.readAll());
        QCOMPARE(items.size(), size_t(1));
        QCOMPARE(items[0].message, QJsonValue(makeResult(9, 2)));
        QCOMPARE(daemon->server().counters()["requests"].toInt(), 10);
    }

    // What is no connection has no other end to be closed: the next one who speaks may be a friend.
    void aStrangerEndsNoSharedCarrier() {
        daemon = std::make_unique<TestedDaemon>();
        launch(*daemon, {}, "udp://127.0.0.1:0");
        const auto port = quint16(QUrl(address()).port());
        for (const QByteArray &strange : {QByteArray("GET / HTTP/1.1\r\n"), QByteArray("\x16\x03\x01", 3)}) {
            QUdpSocket stranger;
            stranger.writeDatagram(strange, QHostAddress(QHostAddress::LocalHost), port);
            QUdpSocket friendly;
            const QByteArray request =
                "\n" + compactJson(makeRequest(1, "subtract", QJsonArray{5, 3})) + '\n';
            friendly.writeDatagram(request, QHostAddress(QHostAddress::LocalHost), port);
            QByteArray told;
            const auto isAnswered = [&] {
                while (friendly.hasPendingDatagrams())
                    told += friendly.receiveDatagram().data();
                return told.contains("\"result\":2");
            };
            QTRY_VERIFY(isAnswered());
        }
    }

    void emptyFramesTakeNoMemory() {
        daemon = std::make_unique<TestedDaemon>();
        launch(*daemon, {}, "tcp://127.0.0.1:0?protocol=cbor");
        QTcpSocket client;
        client.connectToHost(QHostAddress(QHostAddress::LocalHost), quint16(QUrl(address()).port()));
        QVERIFY(client.waitForConnected());
        const QByteArray zeros(1 << 16, '\0');
        qint64 sent = 0, most = 0;
        const std::size_t before = mallinfo2().uordblks; // 0 where a sanitizer has a heap of its own
        auto time = runningTimer();
        while (time.elapsed() < 1500) {
            const ssize_t taken =
                ::send(int(client.socketDescriptor()), zeros.constData(), size_t(zeros.size()), MSG_DONTWAIT);
            sent += std::max<ssize_t>(taken, 0);
            QCoreApplication::processEvents();
            client.readAll();
            most = std::max<qint64>(most, qint64(mallinfo2().uordblks) - qint64(before));
        }
        qInfo("%lld bytes sent, %lld bytes of memory at most", sent, most);
        QVERIFY(sent > 100000);
        QVERIFY(most < 4 << 20);
        QVERIFY(client.state() == QAbstractSocket::ConnectedState);
    }

private:
    QTemporaryDir keys_;
};
