#include "common/settings/DottedPath.h"
#include "gui/hermesctl/Commands.h"
#include "protocol/wire/JsonText.h"

#include <QEventLoop>
#include <cstdio>

namespace hermes::ctl {
namespace {

QString csvField(const QJsonValue &value) {
    if (value.isUndefined() || value.isNull())
        return QString();
    const QString text = value.isString() ? value.toString() : QString::fromUtf8(compactJson(value));
    if (!text.contains(QLatin1Char(',')) && !text.contains(QLatin1Char('"')) &&
        !text.contains(QLatin1Char('\n')))
        return text;
    return QLatin1Char('"') + QString(text).replace(QLatin1Char('"'), QStringLiteral("\"\"")) +
           QLatin1Char('"');
}

// Lines of CSV: stamp, seq, dropped, then one column for each value of the first message.
class CsvPrinter {
public:
    void print(const TopicUpdate &update) {
        const QJsonObject row = update.json().isObject()
                                    ? update.json().toObject()
                                    : QJsonObject{{QStringLiteral("data"), update.json()}};
        if (columns.isEmpty()) {
            columns = leafPaths(row);
            printLine(QStringLiteral("stamp,seq,dropped,") + columns.join(QLatin1Char(',')));
        }
        QStringList fields{QString::number(update.stamp, 'f', 6), QString::number(update.seq),
                           QString::number(update.dropped)};
        for (const QString &column : qAsConst(columns))
            fields.append(csvField(valueAt(row, column)));
        printLine(fields.join(QLatin1Char(',')));
    }

private:
    QStringList columns;
};

void printJson(const TopicUpdate &update) {
    printLine(QString::fromUtf8(compactJson(QJsonObject{{QStringLiteral("stamp"), update.stamp},
                                                        {QStringLiteral("seq"), double(update.seq)},
                                                        {QStringLiteral("dropped"), double(update.dropped)},
                                                        {QStringLiteral("data"), update.json()}})));
}

} // namespace

Result<void> watch(Client &client, const Arguments &arguments) {
    QEventLoop loop;
    CsvPrinter csv;
    int left = arguments.count;
    Result<void> result;
    QObject::connect(&client, &Client::subscriptionFailed, &loop, [&](int, const RpcError &error) {
        result = error;
        loop.quit();
    });
    bool lost = false;
    QObject::connect(&client, &Client::disconnected, &loop, [&](const QString &reason) {
        if (!std::exchange(lost, true))
            std::fprintf(stderr, "hermesctl: %s; trying again\n", qPrintable(reason));
    });
    QObject::connect(&client, &Client::connected, &loop, [&lost] { lost = false; });
    QJsonObject options{{QStringLiteral("queue"), 100}};
    if (arguments.rate_hz > 0)
        options.insert(QStringLiteral("max_rate_hz"), arguments.rate_hz);
    client.subscribe(arguments.words.at(1), options, [&](const TopicUpdate &update) {
        if (arguments.count > 0 && left == 0)
            return; // more came in the same read than were asked for
        if (arguments.csv)
            csv.print(update);
        else
            printJson(update);
        if (arguments.count > 0 && --left == 0)
            loop.quit();
    });
    loop.exec();
    return result;
}

} // namespace hermes::ctl
