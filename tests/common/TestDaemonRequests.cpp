#include "DaemonFixture.h"

#include <QNetworkDatagram>

using namespace hermes;

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

class TestDaemonRequests : public QObject, DaemonFixture {
    Q_OBJECT
private Q_SLOTS:
    void init() { setUp(); }
    void cleanup() { tearDown(); }

    void specificationExamples_data() {
        const Rows<QByteArray, QByteArray> row(
            "request", "response"); // response: "" for none; error messages are ours and not compared
        row("positional", R"({"jsonrpc":"2.0","method":"subtract","params":[42,23],"id":1})",
            R"({"jsonrpc":"2.0","result":19,"id":1})");
        row("positional swapped", R"({"jsonrpc":"2.0","method":"subtract","params":[23,42],"id":2})",
            R"({"jsonrpc":"2.0","result":-19,"id":2})");
        row("named",
            R"({"jsonrpc":"2.0","method":"subtract","params":{"subtrahend":23,"minuend":42},"id":3})",
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
        row("invalid JSON in a batch",
            R"([{"jsonrpc":"2.0","method":"sum","id":"1"},{"jsonrpc":"2.0","method")",
            R"({"jsonrpc":"2.0","error":{"code":-32700},"id":null})");
        row("empty batch", "[]", R"({"jsonrpc":"2.0","error":{"code":-32600},"id":null})");
        row("invalid batch", "[1]", R"([{"jsonrpc":"2.0","error":{"code":-32600},"id":null}])");
        row("batch of three invalid", "[1,2,3]",
            R"([{"jsonrpc":"2.0","error":{"code":-32600},"id":null},{"jsonrpc":"2.0","error":{"code":-32600},"id":null},{"jsonrpc":"2.0","error":{"code":-32600},"id":null}])");
        row("mixed batch",
            R"([{"jsonrpc":"2.0","method":"subtract","params":[42,23],"id":"2"},{"jsonrpc":"2.0","method":"subtract","params":[7,1]},{"foo":"boo"},{"jsonrpc":"2.0","method":"foo.get","params":{"name":"myself"},"id":"5"}])",
            R"([{"jsonrpc":"2.0","result":19,"id":"2"},{"jsonrpc":"2.0","error":{"code":-32600},"id":null},{"jsonrpc":"2.0","error":{"code":-32601},"id":"5"}])");
        row("batch of notifications",
            R"([{"jsonrpc":"2.0","method":"subtract","params":[1,2]},{"jsonrpc":"2.0","method":"foobar"}])",
            "");
        row("response to nothing", R"({"jsonrpc":"2.0","result":19,"id":1})", "");
    }

    void specificationExamples() {
        FETCH(QByteArray, request, QByteArray, response);
        RawClient client(address());
        client.send(request);
        client.send(R"({"jsonrpc":"2.0","method":"subtract","params":[9,4],"id":"end"})");
        if (!response.isEmpty())
            QCOMPARE(withoutTexts(*parseJson(client.line(), nullptr)), *parseJson(response, nullptr));
        QCOMPARE(client.message()["id"].toString(), QString("end"));
    }

    void handlerErrorsEndThatRequestOnly_data() {
        const Rows<int, QString> row("code", "says");
        row("throw", -32603, "on purpose");
        row("nan", -32603, "result: not a finite number");
        row("nanStruct", -32603, "a number of the result is not finite");
        row("silent", -32603, "no answer");
        row("fault", -32004, "unplugged");
    }

    void handlerErrorsEndThatRequestOnly() {
        FETCH(int, code, QString, says);
        RawClient client(address());
        const QJsonObject error = client.ask(QTest::currentDataTag())["error"].toObject();
        QCOMPARE(error["code"].toInt(), code);
        VERIFY_CONTAINS(error["message"].toString(), says);
        QCOMPARE(client.ask("subtract", QJsonArray{3, 1})["result"].toInt(), 2);
    }

    void invalidParamsNameEachOffender() {
        RawClient client(address());
        const auto errors = [&client](const QJsonValue &params) {
            const QJsonObject error = client.ask("subtract", params)["error"].toObject();
            return error["code"].toInt() == -32602 ? error["data"].toObject()["errors"].toArray()
                                                   : QJsonArray();
        };
        const QJsonArray three = errors(QJsonObject{{"minuend", "x"}, {"foo", 1}});
        QCOMPARE(three.size(), 3);
        QCOMPARE(three[0].toObject()["path"].toString(), QString("subtrahend")); // missing
        QVERIFY(!three[0].toObject().contains("value"));
        QCOMPARE(errors(QJsonArray{1, 2, 3})[0].toObject()["path"].toString(), QString("[2]"));
        QCOMPARE(errors(QJsonArray{1}).size(), 1);
        QCOMPARE(errors(QJsonValue::Undefined).size(), 2);
    }

    void valuesOfARequestAreBounded_data() {
        const Rows<QString, int, int> row("method", "values", "code"); // code: 0: none
        const int overLimit = int(ErrorCode::OverLimit), invalid = int(ErrorCode::InvalidParams);
        // The object and the list are values, too.
        row("at most, of any command", "subtract", 2998, invalid);
        row("one more", "subtract", 2999, overLimit);
        row("at most, of a command that takes many", "many", 19998, 0);
        row("one more than many", "many", 19999, overLimit);
    }

    void valuesOfARequestAreBounded() {
        FETCH(QString, method, int, values);
        QJsonArray items;
        for (int i = 0; i < values; ++i)
            items.append(i);
        RawClient client(address());
        client.request(1, method, QJsonObject{{"items", items}});
        const QJsonObject reply = client.message();
        QTEST(reply["error"].toObject()["code"].toInt(), "code");
    }

    void answersMayComeLaterAndFromThreads() {
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

    void batchRepliesKeepOrder() {
        RawClient client(address());
        client.send(compactJson(QJsonArray{makeRequest("slow", "later", QJsonValue::Undefined), 1,
                                           makeRequest("fast", "subtract", QJsonArray{2, 1})}));
        QTRY_COMPARE(daemon->replies.size(), size_t(1));
        QCOMPARE(client.ask("subtract", QJsonArray{3, 1})["result"].toInt(),
                 2); // the batch waits, others do not
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

    void datagramsCarryRequests() {
        TestedDaemon udp;
        launch(udp, {"limits.idle_s=0.2"}, "udp://127.0.0.1:0");
        QUdpSocket client;
        client.writeDatagram(compactJson(makeRequest(1, "subtract", QJsonArray{5, 3})) + '\n',
                             QHostAddress::LocalHost,
                             quint16(QUrl(udp.server().addresses().value(0)).port()));
        QTRY_VERIFY(client.hasPendingDatagrams());
        QCOMPARE(QJsonDocument::fromJson(client.receiveDatagram().data()).object()["result"].toInt(), 2);
        QTRY_COMPARE(udp.server().counters()["clients"].toInt(), 0);
        QCOMPARE(udp.server().addresses().size(), 1); // the carrier is gone, the listener is not confused
    }
};
