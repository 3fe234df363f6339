#pragma once

#include "common/Log.h"
#include "protocol/wire/Fields.h"
#include "protocol/wire/JsonText.h"
#include "tests/support/DaemonClient.h"

#include <stdexcept>

namespace hermes {

/// Commands that answer in every way there is.
class TestedDaemon : public Daemon {
public:
    TestedDaemon()
        : Daemon({"tested", "Tested daemon", "For tests", 1}) {
        addSetting(Field::number("gain", "A number").range(0, 10).byDefault(1));
        addSetting(Field::number("heading", "An angle").unit("rad").byDefault(0));
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
        addCommand(Command("nanStruct", "The same, of a struct").handler([](const Call &) {
            return asJson(LogMessage{qQNaN(), {}, {}, {}});
        }));
        addCommand(Command("silent", "Forgets to answer").asyncHandler([](const Call &, const Reply &) {}));
        addCommand(Command("large", "Gives much")
                       .param(Field::integer("bytes", "How much").byDefault(100000))
                       .handler([](const Call &call) { return QString(call.integer("bytes"), 'x'); }));
        addCommand(Command("many", "Counts what it is given")
                       .param(Field::array("items", "Many", {{"type", "number"}}))
                       .takes(20000)
                       .handler([](const Call &call) { return call.value("items").toArray().size(); }));
        addCommand(Command("turn", "Takes an angle")
                       .param(Field::number("by", "How far").unit("rad"))
                       .handler([](const Call &call) { return call.number("by"); }));
        addCommand(Command("fault", "Fails").handler([](const Call &) -> Result<QJsonValue> {
            return Error(ErrorCode::DeviceFault, "unplugged", QJsonObject{{"device", "t0"}});
        }));
    }

    using Daemon::publish;
    using Daemon::setState;
    std::vector<Reply> replies;
};

/// A client that sees the bytes.
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
        while (!socket.canReadLine() && limit.elapsed() < 5000 * patience)
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

/// The daemon in the process of the test, without a line of its log on the terminal.
class DaemonFixture {
protected:
    void setUp() {
        Log::instance().setStderr(false);
        start();
    }
    void tearDown() { daemon.reset(); }
    void start(const QStringList &more = {});
    QString address() const { return daemon->server().addresses().value(0); }

    std::unique_ptr<TestedDaemon> daemon;
};

inline void DaemonFixture::start(const QStringList &more) {
    daemon.reset();
    daemon = std::make_unique<TestedDaemon>();
    launch(*daemon, QStringList{"access.plain=engineer"} + more);
}

} // namespace hermes
