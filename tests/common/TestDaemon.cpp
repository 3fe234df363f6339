#include "common/Log.h"
#include "common/Project.h"
#include "common/daemon/Daemon.h"
#include "protocol/jsonrpc/JsonText.h"

#include <QNetworkDatagram>
#include <QTcpSocket>
#include <QUdpSocket>
#include <QtTest>
#include <stdexcept>
#include <thread>

using namespace hermes;

namespace {

class TestedDaemon : public Daemon {
public:
    TestedDaemon()
        : Daemon({"tested", "Tested daemon", "For tests", 1}) {
        addSetting(Field::number("gain", "A number").range(0, 10).byDefault(1));
        addTopic(Topic("numbers", "Numbers").schema({{"type", "object"}}));
        addTopic(Topic("state", "Begins with all").snapshot([] { return QJsonValue("all"); }));
        addCommand(Command("subtract", "As in the specification")
                       .param(Field::number("minuend", "From"))
                       .param(Field::number("subtrahend", "What"))
                       .returns({{"type", "number"}})
                       .example({{"minuend", 42}, {"subtrahend", 23}}, 19)
                       .handler([](const Call &call) {
                           return call.number("minuend") - call.number("subtrahend");
                       }));
        addCommand(
            Command("later", "Answers when told to").asyncHandler([this](const Call &, const Reply &reply) {
                replies.push_back(reply);
            }));
        addCommand(
            Command("thread", "Answers from a thread").asyncHandler([](const Call &, const Reply &reply) {
                std::thread([reply] { reply.result("from a thread"); }).detach();
            }));
        addCommand(Command("throw", "Throws").handler([](const Call &) -> Result<QJsonValue> {
            throw std::runtime_error("on purpose");
        }));
        addCommand(
            Command("nan", "Gives what JSON cannot carry").handler([](const Call &) { return qQNaN(); }));
        addCommand(Command("silent", "Forgets to answer").asyncHandler([](const Call &, const Reply &) {}));
        addCommand(Command("large", "Gives much")
                       .param(Field::integer("bytes", "How much").byDefault(100000))
                       .handler([](const Call &call) { return QString(call.integer("bytes"), 'x'); }));
        addCommand(Command("fault", "Fails").handler([](const Call &) -> Result<QJsonValue> {
            return Error(ErrorCode::DeviceFault, "unplugged", QJsonObject{{"device", "t0"}});
        }));
    }

    using Daemon::publish;
    using Daemon::setState;
    std::vector<Reply> replies;
};

// A client that sees the bytes.
class RawClient {
public:
    explicit RawClient(const QString &address) {
        const QUrl url(address);
        socket.connectToHost(url.host(), quint16(url.port()));
    }
    void send(const QByteArray &text) { socket.write(text + '\n'); }
    void request(int id, const QString &method, const QJsonValue &params = QJsonObject()) {
        send(compactJson(makeRequest(id, method, params)));
    }
    QByteArray line() {
        QElapsedTimer limit;
        limit.start();
        while (!socket.canReadLine() && limit.elapsed() < 5000)
            QTest::qWait(1);
        return socket.readLine().trimmed();
    }
    QJsonObject message() { return QJsonDocument::fromJson(line()).object(); }
    QJsonObject ask(const QString &method, const QJsonValue &params = QJsonObject()) {
        request(1, method, params);
        return message();
    }

    QTcpSocket socket;
};

} // namespace

class TestDaemon : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void init();
    void cleanup();
    void specificationExamples_data();
    void specificationExamples();
    void handlerErrorsEndThatRequestOnly_data();
    void handlerErrorsEndThatRequestOnly();
    void invalidParamsNameEachOffender();
    void answersMayComeLaterAndFromThreads();
    void batchRepliesKeepOrder();
    void commonCommands_data();
    void commonCommands();
    void descriptionIsComplete();
    void settingsOverTheWire();
    void subscribeWithSnapshotAndUnsubscribe();
    void rateIsLimitedAndNewestArrives();
    void slowReaderLosesTopicsButNoReplies();
    void clientThatNeverReadsIsClosed();
    void oneClientCannotDisturbAnother();
    void clientLimit();
    void idleClientIsClosed();
    void oversizedRequest();
    void networkNeedsInsecure();
    void datagramsCarryRequests();
    void healthDegradesAndGoesStale();
    void logIsATopic();

private:
    void start(const QStringList &more = {});
    QString address() const { return daemon->server().addresses().value(0); }

    std::unique_ptr<TestedDaemon> daemon;
};

void TestDaemon::init() {
    Log::instance().setStderr(false);
    start();
}

void TestDaemon::start(const QStringList &more) {
    daemon.reset();
    daemon = std::make_unique<TestedDaemon>();
    QStringList arguments{"tested", "--listen", "tcp://127.0.0.1:0"};
    for (const QString &assignment : more)
        arguments << "--set" << assignment;
    QVERIFY(!daemon->prepare(arguments));
    QVERIFY(daemon->launch());
}

void TestDaemon::cleanup() {
    daemon.reset();
}

void TestDaemon::specificationExamples_data() {
    QTest::addColumn<QByteArray>("request");
    QTest::addColumn<QByteArray>("response"); // "" for none; error messages are ours and not compared
    const auto row = [](const char *name, const char *request, const char *response) {
        QTest::newRow(name) << QByteArray(request) << QByteArray(response);
    };
    row("positional", R"({"jsonrpc":"2.0","method":"subtract","params":[42,23],"id":1})",
        R"({"jsonrpc":"2.0","result":19,"id":1})");
    row("positional swapped", R"({"jsonrpc":"2.0","method":"subtract","params":[23,42],"id":2})",
        R"({"jsonrpc":"2.0","result":-19,"id":2})");
    row("named", R"({"jsonrpc":"2.0","method":"subtract","params":{"subtrahend":23,"minuend":42},"id":3})",
        R"({"jsonrpc":"2.0","result":19,"id":3})");
    row("string id", R"({"jsonrpc":"2.0","method":"subtract","params":[1,1],"id":"1"})",
        R"({"jsonrpc":"2.0","result":0,"id":"1"})");
    row("null id", R"({"jsonrpc":"2.0","method":"subtract","params":[1,1],"id":null})",
        R"({"jsonrpc":"2.0","result":0,"id":null})");
    row("notification", R"({"jsonrpc":"2.0","method":"subtract","params":[1,1]})", "");
    row("notification of a missing method", R"({"jsonrpc":"2.0","method":"foobar"})", "");
    row("missing method", R"({"jsonrpc":"2.0","method":"foobar","id":"1"})",
        R"({"jsonrpc":"2.0","error":{"code":-32601},"id":"1"})");
    row("invalid JSON", R"({"jsonrpc":"2.0","method":"foobar,"params":"bar","baz])",
        R"({"jsonrpc":"2.0","error":{"code":-32700},"id":null})");
    row("invalid request", R"({"jsonrpc":"2.0","method":1,"params":"bar"})",
        R"({"jsonrpc":"2.0","error":{"code":-32600},"id":null})");
    row("invalid JSON in a batch", R"([{"jsonrpc":"2.0","method":"sum","id":"1"},{"jsonrpc":"2.0","method")",
        R"({"jsonrpc":"2.0","error":{"code":-32700},"id":null})");
    row("empty batch", "[]", R"({"jsonrpc":"2.0","error":{"code":-32600},"id":null})");
    row("invalid batch", "[1]", R"([{"jsonrpc":"2.0","error":{"code":-32600},"id":null}])");
    row("batch of three invalid", "[1,2,3]",
        R"([{"jsonrpc":"2.0","error":{"code":-32600},"id":null},{"jsonrpc":"2.0","error":{"code":-32600},"id":null},{"jsonrpc":"2.0","error":{"code":-32600},"id":null}])");
    row("mixed batch",
        R"([{"jsonrpc":"2.0","method":"subtract","params":[42,23],"id":"2"},{"jsonrpc":"2.0","method":"subtract","params":[7,1]},{"foo":"boo"},{"jsonrpc":"2.0","method":"foo.get","params":{"name":"myself"},"id":"5"}])",
        R"([{"jsonrpc":"2.0","result":19,"id":"2"},{"jsonrpc":"2.0","error":{"code":-32600},"id":null},{"jsonrpc":"2.0","error":{"code":-32601},"id":"5"}])");
    row("batch of notifications",
        R"([{"jsonrpc":"2.0","method":"subtract","params":[1,2]},{"jsonrpc":"2.0","method":"foobar"}])", "");
    row("response to nothing", R"({"jsonrpc":"2.0","result":19,"id":1})", "");
}

static QJsonValue withoutTexts(const QJsonValue &value) {
    if (value.isArray()) {
        QJsonArray array;
        for (const QJsonValue &one : value.toArray())
            array.append(withoutTexts(one));
        return array;
    }
    QJsonObject object = value.toObject();
    if (object.contains("error"))
        object["error"] = QJsonObject{{"code", object["error"].toObject()["code"]}};
    return object;
}

void TestDaemon::specificationExamples() {
    QFETCH(QByteArray, request);
    QFETCH(QByteArray, response);
    RawClient client(address());
    client.send(request);
    client.send(R"({"jsonrpc":"2.0","method":"subtract","params":[9,4],"id":"end"})");
    if (!response.isEmpty())
        QCOMPARE(withoutTexts(*parseJson(client.line(), nullptr)), *parseJson(response, nullptr));
    QCOMPARE(client.message()["id"].toString(), QString("end"));
}

void TestDaemon::handlerErrorsEndThatRequestOnly_data() {
    QTest::addColumn<int>("code");
    QTest::addColumn<QString>("says");
    QTest::newRow("throw") << -32603 << "on purpose";
    QTest::newRow("nan") << -32603 << "result: not a finite number";
    QTest::newRow("silent") << -32603 << "no answer";
    QTest::newRow("fault") << -32004 << "unplugged";
}

void TestDaemon::handlerErrorsEndThatRequestOnly() {
    QFETCH(int, code);
    QFETCH(QString, says);
    RawClient client(address());
    const QJsonObject error = client.ask(QTest::currentDataTag())["error"].toObject();
    QCOMPARE(error["code"].toInt(), code);
    QVERIFY2(error["message"].toString().contains(says), qPrintable(error["message"].toString()));
    QCOMPARE(client.ask("subtract", QJsonArray{3, 1})["result"].toInt(), 2);
}

void TestDaemon::invalidParamsNameEachOffender() {
    RawClient client(address());
    const auto errors = [&client](const QJsonValue &params) {
        const QJsonObject error = client.ask("subtract", params)["error"].toObject();
        return error["code"].toInt() == -32602 ? error["data"].toObject()["errors"].toArray() : QJsonArray();
    };
    const QJsonArray three = errors(QJsonObject{{"minuend", "x"}, {"foo", 1}});
    QCOMPARE(three.size(), 3);
    QCOMPARE(three[0].toObject()["path"].toString(), QString("subtrahend")); // missing
    QVERIFY(!three[0].toObject().contains("value"));
    QCOMPARE(errors(QJsonArray{1, 2, 3})[0].toObject()["path"].toString(), QString("[2]"));
    QCOMPARE(errors(QJsonArray{1}).size(), 1);
    QCOMPARE(errors(QJsonValue::Undefined).size(), 2);
}

void TestDaemon::answersMayComeLaterAndFromThreads() {
    RawClient client(address());
    client.request(1, "later");
    client.request(2, "thread");
    QCOMPARE(client.message()["result"].toString(), QString("from a thread"));
    QTRY_COMPARE(daemon->replies.size(), size_t(1));
    daemon->replies[0].result("at last");
    daemon->replies[0].result("twice");
    QCOMPARE(client.message()["result"].toString(), QString("at last"));
    client.request(3, "later");
    QTRY_COMPARE(daemon->replies.size(), size_t(2));
    client.socket.abort();
    QTRY_COMPARE(daemon->server().counters()["clients"].toInt(), 0);
    daemon->replies[1].result("to nobody"); // must do no harm
}

void TestDaemon::batchRepliesKeepOrder() {
    RawClient client(address());
    client.send(compactJson(QJsonArray{makeRequest("slow", "later", QJsonValue::Undefined), 1,
                                       makeRequest("fast", "subtract", QJsonArray{2, 1})}));
    QTRY_COMPARE(daemon->replies.size(), size_t(1));
    QCOMPARE(client.ask("subtract", QJsonArray{3, 1})["result"].toInt(), 2); // the batch waits, others do not
    daemon->replies[0].result("done");
    const QJsonArray replies = QJsonDocument::fromJson(client.line()).array();
    QCOMPARE(replies.size(), 3);
    QCOMPARE(replies[0].toObject()["id"].toString(), QString("slow"));
    QCOMPARE(replies[2].toObject()["id"].toString(), QString("fast"));
    QJsonArray many;
    for (int i = 0; i < 1001; ++i)
        many.append(i);
    client.send(compactJson(many));
    QCOMPARE(client.message()["error"].toObject()["code"].toInt(), -32007);
}

void TestDaemon::commonCommands_data() {
    QTest::addColumn<QJsonValue>("params");
    QTest::addColumn<QString>("member"); // of the result
    QTest::newRow("rpc.discover") << QJsonValue(QJsonObject()) << "openrpc";
    QTest::newRow("daemon.info") << QJsonValue(QJsonObject()) << "description_hash";
    QTest::newRow("daemon.status") << QJsonValue(QJsonObject()) << "health";
    QTest::newRow("settings.schema") << QJsonValue(QJsonObject()) << "properties";
    QTest::newRow("settings.get") << QJsonValue(QJsonArray{"limits"}) << "clients";
    QTest::newRow("settings.reset") << QJsonValue(QJsonObject()) << "changed";
    QTest::newRow("topics.list") << QJsonValue(QJsonObject()) << "";
    QTest::newRow("log.tail") << QJsonValue(QJsonArray{10}) << "";
}

void TestDaemon::commonCommands() {
    QFETCH(QJsonValue, params);
    QFETCH(QString, member);
    RawClient client(address());
    const QJsonObject reply = client.ask(QTest::currentDataTag(), params);
    QVERIFY2(reply.contains("result"), compactJson(reply));
    QVERIFY(member.isEmpty() ? reply["result"].isArray() : reply["result"].toObject().contains(member));
}

void TestDaemon::descriptionIsComplete() {
    const QJsonObject description = daemon->description();
    bool found = false;
    for (const QJsonValue &method : description["methods"].toArray()) {
        QVERIFY2(!method["summary"].toString().isEmpty(), qPrintable(method["name"].toString()));
        QVERIFY(method["params"].isArray() && method["result"]["schema"].isObject());
        for (const QJsonValue &param : method["params"].toArray())
            QVERIFY(!param["schema"]["description"].toString().isEmpty());
        if (method["name"].toString() == "subtract") {
            found = true;
            QCOMPARE(method["examples"][0]["result"]["value"].toInt(), 19);
        }
    }
    QVERIFY(found);
    QCOMPARE(description["x-topics"].toArray().size(), 5);
    const QString hash = daemon->descriptionHash();
    start();
    QCOMPARE(daemon->descriptionHash(), hash);
}

void TestDaemon::settingsOverTheWire() {
    RawClient client(address());
    const auto refused =
        client.ask("settings.set", QJsonObject{{"values", QJsonObject{{"gain", 11}, {"foo", 1}}}});
    QCOMPARE(refused["error"].toObject()["code"].toInt(), -32003);
    QCOMPARE(refused["error"].toObject()["data"].toObject()["errors"].toArray().size(), 2);
    QCOMPARE(daemon->settings().number("gain"), 1.0);
    const auto set = client.ask("settings.set", QJsonObject{{"values", QJsonObject{{"gain", 2}}}});
    QCOMPARE(set["result"].toObject()["changed"].toArray(), QJsonArray{"gain"});
    QCOMPARE(client.ask("settings.get", QJsonArray{"gain"})["result"].toDouble(), 2.0);
    QCOMPARE(client.ask("settings.get", QJsonArray{"", true})["result"].toObject()["gain"].toDouble(), 2.0);
    QCOMPARE(client.ask("settings.get", QJsonArray{"no"})["error"].toObject()["code"].toInt(), -32003);
    QCOMPARE(client.ask("settings.save")["error"].toObject()["code"].toInt(), -32008); // no file was given
}

void TestDaemon::subscribeWithSnapshotAndUnsubscribe() {
    RawClient client(address());
    QVERIFY(!daemon->hasSubscribers("state"));
    const QJsonValue id =
        client.ask("topics.subscribe", QJsonArray{"state"})["result"].toObject()["subscription"];
    const QJsonObject first = client.message();
    QCOMPARE(first["method"].toString(), QString("topic"));
    QCOMPARE(first["params"].toObject()["data"].toString(), QString("all"));
    QCOMPARE(first["params"].toObject()["subscription"].toInt(), id.toInt());
    daemon->publish("state", "news", 12.5);
    const QJsonObject second = client.message()["params"].toObject();
    QCOMPARE(second["stamp"].toDouble(), 12.5);
    QCOMPARE(second["seq"].toInt(), 1);
    QCOMPARE(second["dropped"].toInt(), 0);
    RawClient other(address());
    QCOMPARE(other.ask("topics.unsubscribe", QJsonArray{id})["error"].toObject()["code"].toInt(), -32006);
    QVERIFY(client.ask("topics.unsubscribe", QJsonArray{id}).contains("result"));
    QVERIFY(!daemon->hasSubscribers("state"));
    QCOMPARE(client.ask("topics.subscribe", QJsonArray{"none"})["error"].toObject()["code"].toInt(), -32006);
    QCOMPARE(client.ask("topics.subscribe", QJsonArray{"state", 0, 0})["error"].toObject()["code"].toInt(),
             -32602);
}

void TestDaemon::rateIsLimitedAndNewestArrives() {
    RawClient client(address());
    client.ask("topics.subscribe", QJsonArray{"numbers", 20});
    QElapsedTimer clock;
    clock.start();
    for (int i = 1; i <= 100; ++i)
        daemon->publish("numbers", i);
    QCOMPARE(client.message()["params"].toObject()["seq"].toInt(), 1);
    QJsonObject last;
    int messages = 0;
    for (; last["seq"].toInt() < 100; ++messages) { // held until its time, then the newest
        last = client.message()["params"].toObject();
        QVERIFY(!last.isEmpty());
    }
    QCOMPARE(last["dropped"].toInt(), 0); // thinned on request, not lost
    QVERIFY(clock.elapsed() >= 40);
    QVERIFY(messages <= 1 + clock.elapsed() / 50);
}

void TestDaemon::slowReaderLosesTopicsButNoReplies() {
    RawClient client(address());
    client.socket.setReadBufferSize(1024);
    client.ask("topics.subscribe", QJsonArray{"numbers", 0, 20});
    const QString payload(20000, 'x');
    int published = 0;
    for (; published < 600; ++published) {
        daemon->publish("numbers", QJsonObject{{"text", payload}});
        if (published % 20 == 0)
            client.request(1000 + published, "subtract", QJsonArray{published, 0});
        QTest::qWait(0);
    }
    QVERIFY(daemon->server().counters()["dropped_topic_messages"].toInt() > 0);
    client.socket.setReadBufferSize(0);
    int replies = 0;
    int topics = 0;
    QJsonObject last;
    while (replies < 30 || last["seq"].toInt() < published) {
        const QJsonObject message = client.message();
        QVERIFY(!message.isEmpty());
        if (message.contains("id")) {
            QCOMPARE(message["id"].toInt(), 1000 + replies++ * 20);
        } else {
            ++topics;
            QVERIFY(message["params"].toObject()["seq"].toInt() > last["seq"].toInt());
            last = message["params"].toObject();
        }
    }
    QCOMPARE(replies, 30);
    daemon->publish("numbers", QJsonObject()); // a drop is counted in the messages that follow it
    last = client.message()["params"].toObject();
    QCOMPARE(last["seq"].toInt(), topics + 1 + last["dropped"].toInt());
}

void TestDaemon::clientThatNeverReadsIsClosed() {
    RawClient client(address());
    client.socket.setReadBufferSize(1024);
    RawClient other(address());
    other.ask("daemon.info");
    QElapsedTimer limit;
    limit.start();
    while (client.socket.state() != QAbstractSocket::UnconnectedState && limit.elapsed() < 20000 &&
           daemon->server().counters()["clients"].toInt() != 1) {
        client.request(1, "large", QJsonArray{100000});
        QTest::qWait(1);
    }
    QCOMPARE(daemon->server().counters()["clients"].toInt(), 1);
    QVERIFY(compactJson(Log::instance().tail(5)).contains("does not read its replies"));
    QVERIFY(other.ask("daemon.info").contains("result"));
}

void TestDaemon::oneClientCannotDisturbAnother() {
    RawClient good(address());
    good.ask("topics.subscribe", QJsonArray{"numbers"});
    const QList<QByteArray> hostile{
        QByteArray(2 << 20, 'x'), QByteArray("\0\xff\xfe\n\n", 5), QByteArray(5000, '['),
        "{\"jsonrpc\":\"2.0\",\"id\":1,\"method\":\"" + QByteArray(60000, 'm') + "\"}"};
    for (const QByteArray &bytes : hostile) {
        RawClient bad(address());
        bad.send(bytes);
        QVERIFY(!bad.line().isEmpty());
        QVERIFY(bad.ask("daemon.info").contains("result")); // costs an error reply and nothing else
        bad.socket.abort();
    }
    daemon->publish("numbers", 5);
    QCOMPARE(good.message()["params"].toObject()["data"].toInt(), 5);
}

void TestDaemon::clientLimit() {
    start({"limits.clients=2"});
    RawClient first(address());
    RawClient second(address());
    first.ask("daemon.info");
    second.ask("daemon.info");
    RawClient third(address());
    QCOMPARE(third.message()["error"].toObject()["code"].toInt(), -32007);
    QTRY_COMPARE(third.socket.state(), QAbstractSocket::UnconnectedState);
    first.socket.abort();
    QTRY_COMPARE(daemon->server().counters()["clients"].toInt(), 1);
    RawClient fourth(address());
    QVERIFY(fourth.ask("daemon.info").contains("result"));
    QCOMPARE(daemon->server().counters()["clients_turned_away"].toInt(), 1);
}

void TestDaemon::idleClientIsClosed() {
    start({"limits.idle_s=1"});
    RawClient subscriber(address());
    subscriber.ask("topics.subscribe", QJsonArray{"numbers"});
    RawClient client(address());
    client.ask("daemon.info");
    QTRY_COMPARE(client.socket.state(), QAbstractSocket::UnconnectedState);
    QVERIFY(subscriber.ask("daemon.info").contains("result"));
}

void TestDaemon::oversizedRequest() {
    start({"limits.frame_bytes=1024"});
    RawClient client(address());
    client.send(QByteArray(5000, 'x'));
    const QJsonObject error = client.message()["error"].toObject();
    QCOMPARE(error["code"].toInt(), -32007);
    QVERIFY(client.ask("daemon.info").contains("result"));
    QCOMPARE(daemon->server().counters()["oversized_frames"].toInt(), 1);
}

void TestDaemon::networkNeedsInsecure() {
    TestedDaemon open;
    QVERIFY(!open.prepare({"tested", "--listen", "tcp://0.0.0.0:0"}));
    const auto refused = open.launch();
    QVERIFY(!refused);
    QVERIFY2(refused.error().message.contains("insecure"), qPrintable(refused.error().message));
    TestedDaemon insecure;
    QVERIFY(!insecure.prepare({"tested", "--listen", "tcp://0.0.0.0:0", "--set", "insecure=true"}));
    QVERIFY(insecure.launch());
    const QByteArray status = compactJson(insecure.status());
    QVERIFY2(status.contains("\"level\":\"warn\"") && status.contains("\"name\":\"insecure\""), status);
}

void TestDaemon::datagramsCarryRequests() {
    TestedDaemon udp;
    QVERIFY(!udp.prepare({"tested", "--listen", "udp://127.0.0.1:0", "--set", "limits.idle_s=0.2"}));
    QVERIFY(udp.launch());
    QUdpSocket client;
    client.writeDatagram(compactJson(makeRequest(1, "subtract", QJsonArray{5, 3})) + '\n',
                         QHostAddress::LocalHost, quint16(QUrl(udp.server().addresses().value(0)).port()));
    QTRY_VERIFY(client.hasPendingDatagrams());
    QCOMPARE(QJsonDocument::fromJson(client.receiveDatagram().data()).object()["result"].toInt(), 2);
    QTRY_COMPARE(udp.server().counters()["clients"].toInt(), 0);
    QCOMPARE(udp.server().addresses().size(), 1); // the carrier is gone, the listener is not confused
}

void TestDaemon::healthDegradesAndGoesStale() {
    RawClient client(address());
    client.ask("topics.subscribe", QJsonArray{"status"});
    QCOMPARE(client.message()["params"].toObject()["data"].toObject()["state"].toString(), QString("ready"));
    daemon->health().set("sensor", HealthLevel::Failed, "unplugged");
    QCOMPARE(client.message()["params"].toObject()["data"].toObject()["state"].toString(),
             QString("degraded"));
    daemon->health().set("sensor", HealthLevel::Ok, "fine");
    QCOMPARE(client.message()["params"].toObject()["data"].toObject()["state"].toString(), QString("ready"));
    daemon->health().expectEvery("sensor", std::chrono::milliseconds(1));
    const QByteArray stale = client.line(); // told without being asked
    QVERIFY2(stale.contains("\"stale\"") && stale.contains("degraded"), stale);
    daemon->setState(DaemonState::Fault);
    QVERIFY(daemon->state() == DaemonState::Fault);
}

void TestDaemon::logIsATopic() {
    RawClient client(address());
    client.ask("topics.subscribe", QJsonArray{"log", 0, 100});
    std::thread([] { logWarning("worker", "from a thread"); }).join();
    QTRY_VERIFY(client.socket.canReadLine());
    const QJsonObject record = client.message()["params"].toObject()["data"].toObject();
    QCOMPARE(record["text"].toString(), QString("from a thread"));
    QCOMPARE(record["level"].toString(), QString("warning"));
}

QTEST_GUILESS_MAIN(TestDaemon)
#include "TestDaemon.moc"
