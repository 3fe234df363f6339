#include "gui/hermesctl/Commands.h"

#include "common/Project.h"
#include "common/client/DaemonAddress.h"
#include "common/daemon/CommandLine.h"
#include "common/schema/Angles.h"
#include "common/settings/DottedPath.h"
#include "gui/hermesctl/Descriptions.h"
#include "gui/hermesctl/Markdown.h"
#include "gui/hermesctl/NetworkBrowser.h"
#include "gui/hermesctl/Output.h"
#include "gui/hermesctl/Waiting.h"
#include "protocol/messages/Daemons.h"
#include "protocol/wire/Fields.h"
#include "protocol/wire/JsonText.h"

#include <QDateTime>
#include <QEventLoop>
#include <QJsonArray>
#include <functional>

namespace hermes::ctl {
namespace {

// "name=value" words as an object; dotted names make nested objects.
Result<QJsonObject> assignments(const QStringList &words) {
    QJsonObject object;
    for (const QString &word : words) {
        const auto assignment = parseAssignment(word);
        if (!assignment)
            return assignment.error();
        object = withValueAt(object, assignment->first, assignment->second);
    }
    return object;
}

void printChanged(const QJsonValue &result, const QString &daemon) {
    const QJsonArray restart = result["restart"].toArray();
    for (const QJsonValue &path : result["changed"].toArray())
        printLine(
            path.toString() +
            (restart.contains(path)
                 ? QString(" changed, from the next start on once saved (hermesctl call %1 settings.save)")
                       .arg(daemon)
                 : " changed"));
}

using SchemaOf = std::function<QJsonObject(const QJsonValue &)>;

/// Angles that were typed as "90deg" become radians. `method` describes the values. Where no description is
/// to be had the text stays, which the daemon refuses.
QJsonObject withAngles(Client &client, const QString &method, const QJsonObject &values,
                       const SchemaOf &schemaOf) {
    if (!holdsAngleText(values))
        return values;
    const auto description = client.callAndWait(method);
    return description ? withAnglesRead(schemaOf(*description), values).toObject() : values;
}

/// Angles in radians beyond a full turn were most often meant in degrees. `method` describes the values. The
/// daemon's log asks the same: no description is no error, and a large one does not go over a serial line.
void noteAngles(Client &client, const QString &method, const QJsonObject &values, const SchemaOf &schemaOf) {
    if (!holdsBeyondTurn(values) || client.isLossy())
        return;
    if (const auto description = client.callAndWait(method))
        for (const QString &text : beyondTurn(schemaOf(*description), values))
            note(text);
}

QString logLine(WireView record) {
    ReadReport report;
    const auto read = readMessage<LogMessage>(record, report);
    if (!read)
        return "a record of the log cannot be read: " + report.text();
    const auto time = QDateTime::fromMSecsSinceEpoch(qint64(read->stamp * 1000));
    return QString("%1 %2 %3: %4")
        .arg(time.toString(Qt::ISODateWithMs), read->level, read->source, read->text);
}

Result<void> listNetwork(const Arguments &arguments) {
    constexpr std::chrono::seconds howLong{2};
    const auto found = [howLong] {
        const Waiting waiting(howLong, "listening, second");
        return NetworkBrowser().look(howLong);
    }();
    if (!found)
        return found.error();
    if (found->isEmpty())
        return Error(ErrorCode::Disconnected,
                     "no daemon has announced itself; only a daemon that listens on the network does so");
    QJsonArray values;
    std::vector<QStringList> rows{{"name", "host", "address", "port", "framing", "robot"}};
    const QStringList heading = rows.front();
    for (const QJsonObject &daemon : *found) {
        values.append(daemon);
        QStringList row;
        for (const QString &member : heading)
            row.append(printable(daemon[member].toVariant().toString()));
        rows.push_back(row);
    }
    arguments.json ? printJson(values) : printTable(rows);
    return {};
}

/// What is wrong with the reply of one that has taken the connection, where it lacks a text of that name;
/// nothing: empty.
QString whyUnlisted(const Client &client, const Result<QJsonValue> &reply, const char *method,
                    const char *member) {
    const QString foreign = "answers, but is no daemon of Hermes: ";
    if (reply)
        return (*reply)[member].toString().isEmpty()
                   ? foreign + QString("its reply to %1 has no %2").arg(method, member)
                   : QString();
    const Error error = reply.error();
    const Client::Rejected &rejected = client.rejected();
    if (error.is(ErrorCode::MethodNotFound) || rejected.unreadable > 0 || rejected.unasked > 0)
        return foreign + error.message;
    if (error.is(ErrorCode::TimedOut) || error.is(ErrorCode::Disconnected))
        return "does not answer: " + error.message;
    return "does not say what it is: " + error.message;
}

/// The health items that are not ok, of what daemon.status gave: name, level and message of each.
QJsonArray wrongItems(const Result<QJsonValue> &status) {
    QJsonArray wrong;
    for (const QJsonValue &item : status ? (*status)["health"].toArray() : QJsonArray())
        if (item["level"] != "ok")
            wrong.append(
                QJsonObject{{"name", item["name"]}, {"level", item["level"]}, {"message", item["message"]}});
    return wrong;
}

} // namespace

void print(const Arguments &arguments, const QJsonValue &value, const QString &text) {
    arguments.json ? printJson(value) : printLine(text);
}

Result<void> listDaemons(const Arguments &arguments) {
    if (arguments.network)
        return listNetwork(arguments);
    QStringList addresses;
    for (const QString &name : arguments.daemons.isEmpty() ? daemonNames() : arguments.daemons) {
        const auto address = daemonAddress(name, arguments.host);
        if (!address)
            return address.error();
        addresses.append(*address);
    }
    const auto all = connectAll(addresses, arguments.timeout);
    std::vector<Client *> clients;
    for (const auto &client : all) {
        if (client->isConnected())
            clients.push_back(client.get());
    }
    for (const auto &client : all)
        if (!arguments.daemons.isEmpty() && !clients.empty() && !client->isConnected())
            note(client->problem());
    const auto infos = callAllAndWait(clients, "daemon.info", arguments.timeout);
    auto answering = clients;
    for (std::size_t i = 0; i < clients.size(); ++i)
        if (!infos[i])
            answering[i] = nullptr; // is not waited for again
    const auto states = callAllAndWait(answering, "daemon.status", arguments.timeout);
    const auto text = [](const Result<QJsonValue> &reply, const char *member, const char *unknown) {
        const QString found = reply ? (*reply)[member].toString() : QString();
        return found.isEmpty() ? QString::fromLatin1(unknown) : printable(found);
    };
    QJsonArray found;
    for (std::size_t i = 0; i < clients.size(); ++i) {
        const QString name = text(infos[i], "name", "?"), state = text(states[i], "state", "?");
        const QString version = text(infos[i], "version", ""), address = clients[i]->address();
        const QJsonValue robot = infos[i] ? (*infos[i])["robot"] : QJsonValue::Undefined;
        const QString nameless = whyUnlisted(*clients[i], infos[i], "daemon.info", "name");
        const QString unlisted =
            nameless.isEmpty() ? whyUnlisted(*clients[i], states[i], "daemon.status", "state") : nameless;
        const QJsonArray wrong =
            unlisted.isEmpty()
                ? wrongItems(states[i])
                : QJsonArray{QJsonObject{{"name", "daemon"}, {"level", "error"}, {"message", unlisted}}};
        if (!arguments.json) {
            printLine(QString("%1 %2 %3 %4 %5")
                          .arg(name, -16)
                          .arg(state, -10)
                          .arg(version, -8)
                          .arg(address, -22)
                          .arg(printable(robot["name"].toString()))
                          .trimmed());
            for (const QJsonValue &item : wrong)
                printLine(printable(
                    QString("  %1: %2: %3")
                        .arg(item["level"].toString(), item["name"].toString(), item["message"].toString())));
        }
        QJsonObject one{
            {"name", name}, {"state", state}, {"version", version}, {"address", address}, {"wrong", wrong}};
        if (robot.isObject())
            one.insert("robot", robot);
        found.append(one);
    }
    if (arguments.json && !clients.empty())
        printJson(found);
    if (!clients.empty())
        return {};
    for (const auto &client : all)
        if (!client->problem().contains("Connection refused")) // by a host that cannot be asked
            return Error(ErrorCode::Disconnected, client->problem());
    return Error(
        ErrorCode::Disconnected,
        QString(
            "no daemon answers at its default port on %1; start one, as hermes-simulator; on a robot see "
            "systemctl status hermes-supervisor; --host HOST asks another computer, --network all of them")
            .arg(arguments.host));
}

Result<void> discover(Client &client, const Arguments &arguments) {
    const auto description = ask(client, arguments, "rpc.discover");
    if (!description)
        return description.error();
    printLine(arguments.json ? indentedJson(*description) : descriptionAsText(description->toObject()));
    return {};
}

Result<void> document(Client &client, const Arguments &arguments) {
    const auto description = ask(client, arguments, "rpc.discover");
    if (!description)
        return description.error();
    const auto schema = ask(client, arguments, "settings.schema");
    if (!schema)
        return schema.error();
    print(arguments, QJsonObject{{"description", *description}, {"settings", *schema}},
          descriptionAsMarkdown(description->toObject(), schema->toObject()).trimmed());
    return {};
}

Result<void> call(Client &client, const Arguments &arguments) {
    const auto given = assignments(arguments.words.mid(2));
    if (!given)
        return given.error();
    const auto schemaOf = [&arguments](const QJsonValue &description) {
        const QJsonArray methods = description["methods"].toArray();
        return parametersSchema(named(methods, arguments.words.at(1)));
    };
    const QJsonObject params = withAngles(client, "rpc.discover", *given, schemaOf);
    const auto result = askAgain(client, arguments, arguments.words.at(1), params);
    if (!result)
        return result.error();
    printLine(indentedJson(*result));
    noteAngles(client, "rpc.discover", params, schemaOf);
    return {};
}

Result<void> getSettings(Client &client, const Arguments &arguments) {
    const auto value =
        ask(client, arguments, "settings.get", QJsonObject{{"path", arguments.words.value(1)}});
    if (!value)
        return value.error();
    printLine(indentedJson(*value));
    return {};
}

Result<void> setSettings(Client &client, const Arguments &arguments) {
    const auto given = assignments(arguments.words.mid(1));
    if (!given)
        return given.error();
    const auto schemaOf = [](const QJsonValue &schema) { return schema.toObject(); };
    const QJsonObject values = withAngles(client, "settings.schema", *given, schemaOf);
    const auto result = ask(client, arguments, "settings.set", QJsonObject{{"values", values}});
    if (!result)
        return result.error();
    if (arguments.json)
        printJson(*result);
    else
        printChanged(*result, arguments.words.first());
    noteAngles(client, "settings.schema", values, schemaOf);
    return {};
}

Result<void> showLog(Client &client, const Arguments &arguments) {
    const int count = arguments.count > 0 ? arguments.count : 100;
    const auto records = ask(client, arguments, "log.tail", QJsonObject{{"count", count}});
    if (!records)
        return records.error();
    const auto show = [&arguments](const WireValue &record) {
        print(arguments, record.toJson(), logLine(record));
    };
    for (const QJsonValue &record : records->toArray())
        show(WireValue(record));
    if (!arguments.follow)
        return {};
    QEventLoop loop;
    Result<void> result;
    QObject::connect(&client, &Client::disconnected, &loop, [&](const QString &reason) {
        result = Error(ErrorCode::Disconnected, reason);
        loop.quit();
    });
    client.subscribe("log", {{"queue", 1000}}, [&show](const TopicUpdate &update) { show(update.data); });
    runStream(loop);
    return result;
}

} // namespace hermes::ctl
