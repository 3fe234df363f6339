// hermesctl stop and estop: every robot that is there, at once.
#include "common/Project.h"
#include "common/client/DaemonAddress.h"
#include "gui/hermesctl/Commands.h"
#include "gui/hermesctl/NetworkBrowser.h"
#include "gui/hermesctl/Output.h"
#include "protocol/messages/Daemons.h"
#include "protocol/messages/Motors.h"
#include "protocol/wire/Fields.h"

#include <QEventLoop>
#include <QJsonArray>
#include <QSet>
#include <QTimer>

namespace hermes::ctl {
namespace {

/// Stops whoever has the command, each as soon as it is connected: nobody waits for another one.
class Stopping {
public:
    Stopping(const Arguments &arguments, const QString &method)
        : arguments_(arguments)
        , method_(method) {}

    /// isNamed: whoever asks means this one, so that it is told when it is not there.
    void stop(const QString &address, bool isNamed = false) {
        if (asked_.contains(address))
            return;
        asked_.insert(address);
        Client *const client = clients_.emplace_back(std::make_unique<Client>()).get();
        if (isNamed)
            missing_[client] = {address, "no connection"};
        ++open_;
        QObject::connect(client, &Client::connected, &loop_, [this, client] {
            waiting_.insert(client);
            client->call(
                method_, QJsonObject{{"wait_s", wait_s}},
                [this, client](const Result<QJsonValue> &result) { take(client, result); },
                arguments_.timeout, Client::Repeats::AtOnce);
        });
        QObject::connect(client, &Client::disconnected, &loop_, [this, client] {
            if (!waiting_.contains(client)) { // else its call tells
                miss(client, client->problem());
                finish(client);
            }
        });
        if (const auto begun = client->connectTo(asOwner(address)); !begun) {
            miss(client, begun.error().message);
            finish(client);
        }
    }

    void wait() {
        QTimer::singleShot(arguments_.timeout, &loop_, &QEventLoop::quit);
        if (open_ > 0)
            loop_.exec();
    }

    Result<void> outcome() {
        for (Client *client : qAsConst(waiting_))
            note(client, false, "does not answer");
        const bool isNobody = told_.isEmpty();
        for (const auto &[address, why] : qAsConst(missing_))
            note(nullptr, false, QString(why).remove("tcp://" + address + ": "), address);
        if (arguments_.json)
            printJson(told_);
        if (told_.isEmpty())
            return Error(ErrorCode::Disconnected,
                         QString("no robot is there: no daemon at %1, or announced on the network, has %2; "
                                 "hermesctl call HOST:PORT %2 calls another one")
                             .arg(arguments_.host, method_));
        if (isNobody)
            return Error(ErrorCode::Disconnected, "no robot is there: " + unconfirmed_.join("; "));
        return unconfirmed_.isEmpty() ? Result<void>()
                                      : Error(ErrorCode::DeviceFault, unconfirmed_.join("; "));
    }

private:
    static constexpr double wait_s = 2; // for the wheels to stand

    void take(Client *client, const Result<QJsonValue> &result) {
        if (!result && result.error().is(ErrorCode::MethodNotFound)) // perhaps one who knows others
            return client->call(
                "process.list", QJsonObject(),
                [this, client](const Result<QJsonValue> &list) {
                    miss(client, "has no " + method_);
                    for (const QJsonValue &process : list ? (*list)["processes"].toArray() : QJsonArray())
                        if (const int port = process["port"].toInt(); port != 0) {
                            missing_.remove(client);
                            stop(QString("%1:%2").arg(arguments_.host).arg(port));
                        }
                    finish(client);
                },
                arguments_.timeout);
        ReadReport report;
        const auto told = result ? readMessage<StandConfirmation>(WireValue(*result), report) : std::nullopt;
        note(client, told && told->confirmed,
             !result           ? result.error().message
             : !told           ? report.text()
             : told->confirmed ? "stands"
                               : told->text);
        finish(client);
    }

    void miss(Client *client, const QString &why) {
        if (missing_.contains(client))
            missing_[client].second = why;
    }

    void note(Client *client, bool stands, const QString &text, QString address = QString()) {
        if (client) {
            missing_.remove(client);
            address = client->address();
        }
        told_.append(QJsonObject{{"address", address}, {"confirmed", stands}, {"text", text}});
        if (!stands)
            unconfirmed_.append(address + ": " + text);
        else if (!arguments_.json)
            printLine(printable(address + ": " + text));
    }

    void finish(Client *client) {
        waiting_.remove(client);
        QObject::disconnect(client, nullptr, &loop_, nullptr);
        if (--open_ == 0)
            loop_.quit();
    }

    const Arguments &arguments_;
    const QString method_;
    QEventLoop loop_;
    QSet<QString> asked_;
    QSet<Client *> waiting_;                               // for an answer
    QHash<Client *, std::pair<QString, QString>> missing_; // that were named: address, and why
    int open_ = 0;                                         // that may still answer, or be connected
    QJsonArray told_;
    QStringList unconfirmed_;
    std::vector<std::unique_ptr<Client>> clients_; // go first: what ends with them is still told
};

Result<void> stopAll(const Arguments &arguments, const QString &method) {
    Stopping stopping(arguments, method);
    for (const QString &daemon : arguments.words.isEmpty() ? daemonNames() : arguments.words) {
        const auto address = daemonAddress(daemon, arguments.host);
        if (!address)
            return address.error();
        stopping.stop(*address, !arguments.words.isEmpty());
    }
    constexpr std::chrono::milliseconds shortly{300};
    if (arguments.words.isEmpty()) {
        if (const auto found = NetworkBrowser().look(shortly)) // those from before are on their way
            for (const QJsonObject &daemon : *found)
                stopping.stop(QString("%1:%2").arg(daemon["address"].toString()).arg(daemon["port"].toInt()));
    }
    stopping.wait();
    return stopping.outcome();
}

} // namespace

Result<void> stopRobots(const Arguments &arguments) {
    return stopAll(arguments, "motor.stop");
}

Result<void> emergencyStopRobots(const Arguments &arguments) {
    return stopAll(arguments, "motor.estop");
}

} // namespace hermes::ctl
