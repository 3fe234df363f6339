#include "gui/hermesctl/Commands.h"

#include "common/Project.h"
#include "common/client/DaemonAddress.h"
#include "common/daemon/CommandLine.h"
#include "common/settings/DottedPath.h"
#include "gui/hermesctl/Markdown.h"
#include "protocol/jsonrpc/JsonText.h"

#include <QDateTime>
#include <QEventLoop>
#include <QJsonDocument>
#include <QTimer>
#include <cstdio>
#include <memory>

namespace hermes {
namespace {

QString pretty(const QJsonValue &value) {
    if (value.isObject())
        return QString::fromUtf8(QJsonDocument(value.toObject()).toJson()).trimmed();
    if (value.isArray())
        return QString::fromUtf8(QJsonDocument(value.toArray()).toJson()).trimmed();
    return QString::fromUtf8(compactJson(value));
}

Result<QJsonValue> ask(Client &client, const Arguments &arguments, const QString &method,
                       const QJsonValue &params = QJsonObject()) {
    return client.callAndWait(method, params, arguments.timeout);
}

// "name=value" words as an object; dotted names make nested objects only where the caller wants that.
Result<QJsonObject> assignments(const QStringList &words, bool nested) {
    QJsonObject object;
    for (const QString &word : words) {
        const auto assignment = parseAssignment(word);
        if (!assignment)
            return assignment.error();
        if (nested)
            object = withValueAt(object, assignment->first, assignment->second);
        else
            object.insert(assignment->first, assignment->second);
    }
    return object;
}

QString logLine(const QJsonValue &record) {
    const auto time =
        QDateTime::fromMSecsSinceEpoch(qint64(record[QStringLiteral("stamp")].toDouble() * 1000));
    return QStringLiteral("%1 %2 %3: %4")
        .arg(time.toString(Qt::ISODateWithMs), record[QStringLiteral("level")].toString(),
             record[QStringLiteral("source")].toString(), record[QStringLiteral("text")].toString());
}

struct Found {
    QString name;
    QString state = QStringLiteral("?");
    QString version;
    QString address;
};

} // namespace

void printLine(const QString &text) {
    std::fputs((text + QLatin1Char('\n')).toUtf8().constData(), stdout);
    std::fflush(stdout);
}

Result<void> listDaemons(const Arguments &arguments) {
    QEventLoop loop;
    QTimer::singleShot(arguments.timeout, &loop, &QEventLoop::quit);
    std::vector<std::unique_ptr<Client>> clients;
    std::vector<Found> found;
    int open = 0;
    const auto done = [&] {
        if (--open == 0)
            loop.quit();
    };
    for (const QString &name : daemonNames()) {
        const auto address = daemonAddress(name, arguments.host);
        Client *const client = clients.emplace_back(std::make_unique<Client>()).get();
        ++open;
        QObject::connect(client, &Client::disconnected, &loop, [client, done] {
            client->disconnect();
            done();
        });
        QObject::connect(client, &Client::connected, &loop, [client, done, &found] {
            client->disconnect(SIGNAL(disconnected(QString)));
            const size_t row = found.size();
            found.push_back({QStringLiteral("?"), QStringLiteral("?"), QString(), client->address()});
            client->call(QStringLiteral("daemon.info"), QJsonObject(),
                         [&found, row](const Result<QJsonValue> &info) {
                             if (info) {
                                 found[row].name = (*info)[QStringLiteral("name")].toString();
                                 found[row].version = (*info)[QStringLiteral("version")].toString();
                             }
                         });
            client->call(QStringLiteral("daemon.status"), QJsonObject(),
                         [&found, row, done](const Result<QJsonValue> &status) {
                             if (status)
                                 found[row].state = (*status)[QStringLiteral("state")].toString();
                             done();
                         });
        });
        const auto begun = client->connectTo(*address);
        if (!begun)
            return begun;
    }
    loop.exec();
    for (const Found &one : found) {
        printLine(QStringLiteral("%1 %2 %3 %4")
                      .arg(one.name, -16)
                      .arg(one.state, -10)
                      .arg(one.version, -8)
                      .arg(one.address));
    }
    if (found.empty())
        return Error(ErrorCode::Disconnected,
                     QStringLiteral("no daemon answers at its default port on %1").arg(arguments.host));
    return {};
}

Result<void> discover(Client &client, const Arguments &arguments) {
    const auto description = ask(client, arguments, QStringLiteral("rpc.discover"));
    if (!description)
        return description.error();
    printLine(arguments.json ? pretty(*description) : descriptionAsText(description->toObject()));
    return {};
}

Result<void> document(Client &client, const Arguments &arguments) {
    const auto description = ask(client, arguments, QStringLiteral("rpc.discover"));
    if (!description)
        return description.error();
    const auto schema = ask(client, arguments, QStringLiteral("settings.schema"));
    if (!schema)
        return schema.error();
    printLine(descriptionAsMarkdown(description->toObject(), schema->toObject()).trimmed());
    return {};
}

Result<void> call(Client &client, const Arguments &arguments) {
    const auto params = assignments(arguments.words.mid(2), false);
    if (!params)
        return params.error();
    const auto result = ask(client, arguments, arguments.words.at(1), *params);
    if (!result)
        return result.error();
    printLine(pretty(*result));
    return {};
}

Result<void> getSettings(Client &client, const Arguments &arguments) {
    const auto value = ask(client, arguments, QStringLiteral("settings.get"),
                           QJsonObject{{QStringLiteral("path"), arguments.words.value(1)}});
    if (!value)
        return value.error();
    printLine(pretty(*value));
    return {};
}

Result<void> setSettings(Client &client, const Arguments &arguments) {
    const auto values = assignments(arguments.words.mid(1), true);
    if (!values)
        return values.error();
    const auto result = ask(client, arguments, QStringLiteral("settings.set"),
                            QJsonObject{{QStringLiteral("values"), *values}});
    if (!result)
        return result.error();
    const QJsonArray restart = (*result)[QStringLiteral("restart")].toArray();
    for (const QJsonValue &path : (*result)[QStringLiteral("changed")].toArray())
        printLine(path.toString() + (restart.contains(path)
                                         ? QStringLiteral(" changed, from the next start on")
                                         : QStringLiteral(" changed")));
    return {};
}

Result<void> showLog(Client &client, const Arguments &arguments) {
    const int count = arguments.count > 0 ? arguments.count : 100;
    const auto records =
        ask(client, arguments, QStringLiteral("log.tail"), QJsonObject{{QStringLiteral("count"), count}});
    if (!records)
        return records.error();
    for (const QJsonValue &record : records->toArray())
        printLine(logLine(record));
    if (!arguments.follow)
        return {};
    QEventLoop loop;
    QObject::connect(&client, &Client::disconnected, &loop, &QEventLoop::quit);
    client.subscribe(QStringLiteral("log"), {{QStringLiteral("queue"), 1000}},
                     [](const TopicUpdate &update) { printLine(logLine(update.data)); });
    loop.exec();
    return Error(ErrorCode::Disconnected, client.lastError());
}

} // namespace hermes
