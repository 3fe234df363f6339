// hermesctl doc --all: what several daemons tell of themselves, on one page.
#include "common/Project.h"
#include "common/client/DaemonAddress.h"
#include "common/schema/SchemaKeys.h"
#include "gui/hermesctl/Commands.h"
#include "gui/hermesctl/Markdown.h"

#include <QJsonArray>
#include <algorithm>

namespace hermes::ctl {
namespace {

const QString methodsKey = "methods";
const QString topicsKey = "x-topics";

const char *const introduction = R"(# Protocol reference

What each daemon tells of its commands, topics and settings itself (`rpc.discover`, `settings.schema`); the rules are those of
the [protocol](protocol.md). `deploy/protocol-reference` writes this page from running daemons; what `hermesctl doc D` prints is
the same of one.

A parameter without a default is marked `required` or `optional`. A setting applies `now` or after a `restart`. Keywords:

| keyword | means |
|---|---|
| `x-urgent` | carried out when it arrives, before all that others have asked for |
| `x-role` | who may call it, or give the parameter: [roles](protocol.md#who-may-do-what) |
| `x-fresh` | refused when it was received before the daemon had stood still |
| `x-destructive` | what it replaces or forgets: programs for people ask first |
| `x-needs-lease` | refused unless this client holds the control (`control.acquire`) |
| `x-open` | holds more than is described, or anything |

)";

/// What a daemon tells of itself.
struct DaemonDescription {
    QString name;            ///< as in the program hermes-NAME
    QJsonObject description; ///< OpenRPC
    QJsonObject settings;    ///< JSON Schema
};

/// As GitHub makes the anchor of a heading.
QString anchor(const QString &heading) {
    QString result;
    for (const QChar c : heading.toLower()) {
        if (c.isLetterOrNumber() || c == '_' || c == '-')
            result += c;
        else if (c == ' ')
            result += '-';
    }
    return result;
}

QString link(const QString &shown, const QString &heading) {
    return QString("[%1](#%2)").arg(shown, anchor(heading));
}

/// What is in a list of all daemons, and the same in each.
QJsonArray commonOf(const std::vector<DaemonDescription> &daemons, const QString &key) {
    QJsonArray common;
    for (const QJsonValue &one : daemons.front().description[key].toArray()) {
        if (std::all_of(daemons.begin(), daemons.end(), [&](const DaemonDescription &daemon) {
                return daemon.description[key].toArray().contains(one);
            }))
            common.append(one);
    }
    return common;
}

QJsonArray without(const QJsonArray &list, const QJsonArray &common) {
    QJsonArray rest;
    for (const QJsonValue &one : list) {
        if (!common.contains(one))
            rest.append(one);
    }
    return rest;
}

/// A schema with the settings only that are alike in both.
QJsonObject alike(const QJsonObject &a, const QJsonObject &b) {
    const QJsonObject ofA = a[propertiesKey].toObject(), ofB = b[propertiesKey].toObject();
    QJsonObject result;
    for (auto one = ofA.begin(); one != ofA.end(); ++one) {
        const QJsonObject below = one.value().toObject(), other = ofB[one.key()].toObject();
        if (!below.contains(propertiesKey) ? below == other : other.contains(propertiesKey))
            result.insert(one.key(), below.contains(propertiesKey) ? alike(below, other) : below);
    }
    return {{propertiesKey, result}};
}

/// A chapter of the page, and the lines about it in the table of contents.
struct Chapter {
    QString contents;
    QString page;

    void addSections(const QString &title, const QString &prefix, const QJsonArray &list,
                     QString (*section)(const QString &, const QJsonObject &)) {
        QStringList links;
        for (const QJsonValue &one : list) {
            const QString name = one["name"].toString();
            links.append(link(name, prefix + name));
            page += section(prefix + name, one.toObject());
        }
        if (!links.isEmpty())
            contents += QString("  * %1: %2\n").arg(title, links.join(", "));
    }
};

Chapter chapterOf(const QString &name, const QString &title, const QString &text, const QJsonArray &methods,
                  const QJsonArray &topics, const QString &settings) {
    Chapter chapter;
    chapter.contents = QString("* %1\n").arg(link(title, title));
    chapter.page = QString("## %1\n\n%2.\n\n").arg(title, text);
    chapter.addSections("commands", name + ' ', methods, methodSection);
    chapter.addSections("topics", name + " topic ", topics, topicSection);
    if (settings.isEmpty())
        return chapter;
    const QString heading = name + " settings";
    chapter.contents += QString("  * %1\n").arg(link("settings", heading));
    chapter.page += QString("### %1\n\n%2\n").arg(heading, settingTable(settings));
    return chapter;
}

Result<DaemonDescription> describe(Client &client, const Arguments &arguments) {
    const auto info = ask(client, arguments, "daemon.info");
    if (!info)
        return info.error();
    const auto description = ask(client, arguments, "rpc.discover");
    if (!description)
        return description.error();
    const auto settings = ask(client, arguments, "settings.schema");
    if (!settings)
        return settings.error();
    return DaemonDescription{(*info)["name"].toString(), description->toObject(), settings->toObject()};
}

QJsonObject asJson(const std::vector<DaemonDescription> &daemons) {
    QJsonObject all;
    for (const DaemonDescription &daemon : daemons)
        all.insert(daemon.name,
                   QJsonObject{{"description", daemon.description}, {"settings", daemon.settings}});
    return all;
}

/// The reference of all on one page, with a table of contents; what all have alike stands there once.
/// Without versions: it changes only with what they describe.
QString referenceAsMarkdown(const std::vector<DaemonDescription> &daemons) {
    const bool isOne = daemons.size() < 2;
    const QJsonArray methods = isOne ? QJsonArray() : commonOf(daemons, methodsKey);
    const QJsonArray topics = isOne ? QJsonArray() : commonOf(daemons, topicsKey);
    QJsonObject settings = isOne ? QJsonObject() : daemons.front().settings;
    for (const DaemonDescription &daemon : daemons)
        settings = alike(settings, daemon.settings);
    std::vector<Chapter> chapters;
    if (!isOne)
        chapters.push_back(
            chapterOf("all", "Every daemon", "What all have alike", methods, topics, settingLines(settings)));
    for (const DaemonDescription &daemon : daemons) {
        const QJsonObject info = daemon.description["info"].toObject();
        chapters.push_back(chapterOf(daemon.name, daemon.name, info["description"].toString(),
                                     without(daemon.description[methodsKey].toArray(), methods),
                                     without(daemon.description[topicsKey].toArray(), topics),
                                     settingLines(daemon.settings, settings)));
    }
    QString page = introduction, rest;
    for (const Chapter &chapter : chapters) {
        page += chapter.contents;
        rest += chapter.page;
    }
    return page + '\n' + rest;
}

} // namespace

Result<void> documentAll(const Arguments &arguments) {
    const QStringList words = arguments.daemons.isEmpty() ? daemonNames() : arguments.daemons;
    std::vector<DaemonDescription> daemons;
    for (const QString &word : words) {
        const auto address = daemonAddress(word, arguments.host);
        if (!address)
            return address.error();
        Client client;
        const auto connected = connectOnce(client, *address, arguments.timeout);
        if (!connected && arguments.daemons.isEmpty())
            continue;
        if (!connected)
            return connected;
        const auto daemon = describe(client, arguments);
        if (!daemon)
            return Error(ErrorCode(daemon.error().code), *address + ": " + daemon.error().message);
        daemons.push_back(*daemon);
    }
    if (daemons.empty())
        return Error(ErrorCode::Disconnected,
                     QString("no daemon answers at its default port on %1").arg(arguments.host));
    print(arguments, asJson(daemons), referenceAsMarkdown(daemons).trimmed());
    return {};
}

} // namespace hermes::ctl
