#include "protocol/jsonrpc/JsonRpc.h"
#include "protocol/wire/JsonText.h"

using namespace hermes;

// The rules of JSON-RPC 2.0 for single messages and batches.
class TestJsonRpc : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void reads_data() {
        Rows<QByteArray, int>("text", "kind"); // kind: index in RpcMessage: request, response, invalid
        const auto row = [](const char *text, int kind) { QTest::newRow(text) << QByteArray(text) << kind; };
        row(R"({"jsonrpc":"2.0","id":1,"method":"a"})", 0);
        row(R"({"jsonrpc":"2.0","id":"x","method":"a","params":{}})", 0);
        row(R"({"jsonrpc":"2.0","id":null,"method":"a","params":[]})", 0);
        row(R"({"jsonrpc":"2.0","method":"a"})", 0);
        row(R"({"jsonrpc":"2.0","id":1,"result":null})", 1);
        row(R"({"jsonrpc":"2.0","id":null,"error":{"code":-32700,"message":"m"}})", 1);
        row(R"({"jsonrpc":"2.0","id":1,"error":{"code":1,"message":"m","data":[1]}})", 1);
        row(R"({"jsonrpc":"2.0","id":1,"result":1,"error":{"code":1,"message":"m"}})", 2);
        row(R"({"jsonrpc":"2.0","id":1,"error":"m"})", 2);
        row(R"({"jsonrpc":"2.0","result":1})", 2);
        row(R"({"jsonrpc":"2.0","id":1})", 2);
        row(R"({"jsonrpc":"1.0","id":1,"method":"a"})", 2);
        row(R"({"jsonrpc":2.0,"id":1,"method":"a"})", 2);
        row(R"({"id":1,"method":"a"})", 2);
        row(R"({"jsonrpc":"2.0","id":1,"method":1,"params":"bar"})", 2);
        row(R"({"jsonrpc":"2.0","id":1,"method":"a","params":"bar"})", 2);
        row(R"({"jsonrpc":"2.0","id":1,"method":"a","params":null})", 2);
        row(R"({"jsonrpc":"2.0","id":[1],"method":"a"})", 2);
        row(R"({"jsonrpc":"2.0","id":true,"method":"a"})", 2);
        row("1", 2);
        row("null", 2);
        row(R"("text")", 2);
    }

    void reads() {
        FETCH(QByteArray, text, int, kind);
        const RpcFrame frame = readFrame(*parseJson(text, nullptr));
        QVERIFY(!frame.batch);
        QCOMPARE(frame.messages.size(), size_t(1));
        QCOMPARE(int(frame.messages[0].index()), kind);
        if (const auto *invalid = std::get_if<RpcInvalid>(&frame.messages[0]))
            QVERIFY(invalid->error.is(ErrorCode::InvalidRequest));
    }

    void invalidKeepsIdWhereReadable_data() {
        const Rows<QByteArray, QJsonValue> row("text", "id");
        row("number", R"({"id":7,"method":"a"})", QJsonValue(7));
        row("string", R"({"jsonrpc":"2.0","id":"k","method":2})", QJsonValue("k"));
        row("large", R"({"jsonrpc":"2.0","id":9007199254740991,"method":5})", QJsonValue(9007199254740991.0));
        for (const char *number :
             {"9007199254740992", "9007199254740993", "-9007199254740993", "123456789012345678901234567890"})
            row(number, QByteArray(R"({"jsonrpc":"2.0","method":"a","id":)") + number + '}', QJsonValue());
        row("object", R"({"jsonrpc":"2.0","id":{},"method":"a"})", QJsonValue());
        row("none", R"({"jsonrpc":"2.0","params":[]})", QJsonValue());
    }

    void invalidKeepsIdWhereReadable() {
        FETCH(QByteArray, text, QJsonValue, id);
        const RpcFrame frame = readFrame(*parseJson(text, nullptr));
        QCOMPARE(std::get<RpcInvalid>(frame.messages[0]).id, id);
    }

    void batchKeepsOrder() {
        const auto frame = readFrame(*parseJson(
            R"([{"jsonrpc":"2.0","id":2,"method":"b"},1,{"jsonrpc":"2.0","method":"n"},{"jsonrpc":"2.0","id":1,"method":"a"}])",
            nullptr));
        QVERIFY(frame.batch);
        QCOMPARE(frame.messages.size(), size_t(4));
        QCOMPARE(std::get<RpcRequest>(frame.messages[0]).method, QString("b"));
        QVERIFY(std::holds_alternative<RpcInvalid>(frame.messages[1]));
        QVERIFY(std::get<RpcRequest>(frame.messages[2]).isNotification());
        QCOMPARE(std::get<RpcRequest>(frame.messages[3]).method, QString("a"));
    }

    void emptyBatchIsOneInvalidRequest() {
        const auto frame = readFrame(QJsonArray());
        QVERIFY(!frame.batch); // its answer is a single object
        QCOMPARE(frame.messages.size(), size_t(1));
        QVERIFY(std::holds_alternative<RpcInvalid>(frame.messages[0]));
    }

    void parametersByNameAndPosition() {
        const auto read = [](const QJsonValue &params) {
            return std::get<RpcRequest>(readFrame(makeRequest(1, "m", params)).messages[0]).params;
        };
        QCOMPARE(read(QJsonArray{42, 23}), QJsonValue(QJsonArray{42, 23}));
        QCOMPARE(read(QJsonObject{{"a", 1}}), QJsonValue(QJsonObject{{"a", 1}}));
        QVERIFY(read(QJsonValue::Undefined).isUndefined());
    }

    void makesAndReadsBack() {
        const auto response = std::get<RpcResponse>(readFrame(makeResult("k", 19)).messages[0]);
        QCOMPARE(response.id, QJsonValue("k"));
        QCOMPARE(response.result, QJsonValue(19));
        QVERIFY(!response.failed);
        const RpcError error(ErrorCode::DeviceFault, "unplugged", QJsonObject{{"device", "t0"}});
        const auto failure = std::get<RpcResponse>(readFrame(makeError(3, error)).messages[0]);
        QVERIFY(failure.failed);
        QCOMPARE(failure.error.code, -32004);
        QCOMPARE(failure.error.message, error.message);
        QCOMPARE(failure.error.data, error.data);
        QVERIFY(makeResult(1, QJsonValue::Undefined).value("result").isNull());
        QVERIFY(!makeError(1, RpcError(ErrorCode::NotReady, "m")).value("error").toObject().contains("data"));
        QVERIFY(std::get<RpcRequest>(readFrame(makeNotification("n", QJsonArray{1})).messages[0])
                    .isNotification());
    }

    void codesAreThoseOfTheSpecification() {
        QCOMPARE(int(ErrorCode::ParseError), -32700);
        QCOMPARE(int(ErrorCode::InvalidRequest), -32600);
        QCOMPARE(int(ErrorCode::MethodNotFound), -32601);
        QCOMPARE(int(ErrorCode::InvalidParams), -32602);
        QCOMPARE(int(ErrorCode::InternalError), -32603);
        QCOMPARE(int(ErrorCode::NotAuthorised), -32001);
        QCOMPARE(int(ErrorCode::InputOutput), -32008);
    }
};
