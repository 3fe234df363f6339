#include "gui/hermesctl/Markdown.h"

#include "common/schema/SchemaKeys.h"
#include "common/schema/SchemaText.h"
#include "protocol/wire/JsonText.h"

#include <QJsonArray>
#include <QStringList>

namespace hermes::ctl {
namespace {

const QString schemaKey = "schema";
const QString defaultKey = "default";

QString text(const QJsonValue &object, const char *key) {
    return object[key].toString();
}

QString parameterList(const QJsonObject &method) {
    QStringList names;
    for (const QJsonValue &param : method["params"].toArray()) {
        const bool required = param["required"].toBool();
        names.append(text(param, "name") + (required ? QString() : "?"));
    }
    return names.join(", ");
}

QString cell(QString content) {
    return content.replace('|', "\\|");
}

/// "`x-urgent`, `x-role`: "operator"": whatever keywords of our own there are, but for one that has a column.
QString keywords(const QJsonObject &object) {
    QStringList texts;
    for (auto member = object.begin(); member != object.end(); ++member) {
        if (!member.key().startsWith("x-") || member.key() == "x-applies")
            continue;
        const QString name = QString("`%1`").arg(member.key());
        texts.append(member.value() == true ? name : QString("%1: %2").arg(name, shown(member.value())));
    }
    return texts.join(", ");
}

/// What is expected, and the keywords.
QString expected(const QJsonObject &schema) {
    const QString more = keywords(schema);
    return expectation(schema) + (more.isEmpty() ? more : "; " + more);
}

/// A line for each field, those of inner objects by their path; nothing where the schema has none. What lies
/// deeper than anything that a person reads is left out.
QString fieldLines(const QJsonObject &schema, const QString &path, int depth = 0) {
    constexpr int deepest = 12;
    if (depth > deepest)
        return {};
    if (schema.contains("items"))
        return fieldLines(schema["items"].toObject(), path + "[]", depth + 1);
    const QString prefix = path.isEmpty() ? path : path + '.';
    const QJsonObject others = schema["additionalProperties"].toObject();
    QString lines = others.isEmpty() ? QString() : fieldLines(others, prefix + '*', depth + 1);
    const QJsonObject properties = schema["properties"].toObject();
    const QJsonArray required = schema["required"].toArray();
    for (auto property = properties.begin(); property != properties.end(); ++property) {
        const QJsonObject below = property.value().toObject();
        const QString name = prefix + property.key();
        const bool mayBeMissing = !required.contains(property.key());
        lines += QString("| `%1` | %2%3 | %4 |\n")
                     .arg(name, cell(expected(below)), mayBeMissing ? "; may be missing" : QString(),
                          cell(text(below, "description")));
        lines += fieldLines(below, name, depth + 1);
    }
    return lines;
}

/// Of a value that is called path; nothing for one without fields.
QString fieldTable(const QJsonObject &schema, const QString &path = {}) {
    const QString lines = fieldLines(schema, path);
    return lines.isEmpty() ? lines : QString("| field | what | meaning |\n|---|---|---|\n%1\n").arg(lines);
}

QString parameterTable(const QJsonArray &params) {
    QString table = "| parameter | expected | default | meaning |\n|---|---|---|---|\n";
    for (const QJsonValue &param : params) {
        const QJsonObject schema = param[schemaKey].toObject();
        const QString fallback = schema.contains(defaultKey)  ? shown(schema[defaultKey])
                                 : param["required"].toBool() ? "required"
                                                              : "optional";
        table += QString("| `%1` | %2 | %3 | %4 |\n")
                     .arg(text(param, "name"), cell(expected(schema)), cell(fallback),
                          cell(text(schema, "description")));
    }
    table += '\n';
    for (const QJsonValue &param : params)
        table += fieldTable(param[schemaKey].toObject(), text(param, "name"));
    return table;
}

QString example(const QString &method, const QJsonObject &pairing) {
    QJsonObject params;
    for (const QJsonValue &param : pairing["params"].toArray())
        params.insert(text(param, "name"), param["value"]);
    const QJsonObject request{{"jsonrpc", "2.0"}, {"id", 1}, {"method", method}, {"params", params}};
    return QString("```json\n%1\n%2\n```\n\n")
        .arg(QString::fromUtf8(compactJson(request)),
             QString::fromUtf8(compactJson(pairing["result"].toObject()["value"])));
}

/// {x, y, theta}: of an object, or of the objects of a list.
QString fieldList(const QJsonObject &schema) {
    if (schema.contains("items"))
        return fieldList(schema["items"].toObject());
    const QStringList names = schema["properties"].toObject().keys();
    return names.isEmpty() ? QString() : QString(" {%1}").arg(names.join(", "));
}

/// "-32002 another client holds the control; ..."
QString errorList(const QJsonArray &errors) {
    QStringList texts;
    for (const QJsonValue &error : errors)
        texts.append(QString("%1 %2").arg(error["code"].toInt()).arg(text(error, "message")));
    return texts.join("; ");
}

} // namespace

QString methodSection(const QString &heading, const QJsonObject &method) {
    QString section = QString("### %1\n\n%2.\n\n").arg(heading, text(method, "summary"));
    if (const QString more = keywords(method); !more.isEmpty())
        section += QString("Keywords: %1.\n\n").arg(more);
    const QJsonArray params = method["params"].toArray();
    if (!params.isEmpty())
        section += parameterTable(params);
    const QJsonObject result = method["result"].toObject()[schemaKey].toObject();
    section += QString("Result: %1.\n\n").arg(expected(result)) + fieldTable(result);
    if (const QString errors = errorList(method["errors"].toArray()); !errors.isEmpty())
        section += QString("Errors: %1.\n\n").arg(errors);
    for (const QJsonValue &pairing : method["examples"].toArray())
        section += example(text(method, "name"), pairing.toObject());
    return section;
}

QString topicSection(const QString &heading, const QJsonObject &topic) {
    const QJsonObject schema = topic[schemaKey].toObject();
    const QString more = keywords(topic);
    return QString("### %1\n\n%2.%3\n\n%4Data: %5.\n\n%6")
        .arg(heading, text(topic, "summary"),
             topic["snapshot"].toBool() ? " Begins with the full state." : QString(),
             more.isEmpty() ? more : QString("Keywords: %1.\n\n").arg(more), expected(schema),
             fieldTable(schema));
}

QString settingLines(const QJsonObject &schema, const QJsonObject &butFor, const QString &prefix) {
    QString lines;
    const QJsonObject properties = schema[propertiesKey].toObject();
    const QJsonObject others = butFor[propertiesKey].toObject();
    for (auto property = properties.begin(); property != properties.end(); ++property) {
        const QJsonObject below = property.value().toObject();
        const QString path = prefix + property.key();
        if (below.contains(propertiesKey))
            lines += settingLines(below, others[property.key()].toObject(), path + '.');
        else if (below != others[property.key()].toObject())
            lines += QString("| `%1` | %2 | %3 | %4 | %5 |\n")
                         .arg(path, cell(expected(below)), cell(shown(below[defaultKey])),
                              text(below, "x-applies"), cell(text(below, "description")));
    }
    return lines;
}

QString settingTable(const QString &lines) {
    return "| path | expected | default | applies | meaning |\n|---|---|---|---|---|\n" + lines;
}

QString descriptionAsMarkdown(const QJsonObject &description, const QJsonObject &settingsSchema) {
    const QJsonObject info = description["info"].toObject();
    QString page = QString("# %1\n\n%2. Version %3.\n\n## Commands\n\n")
                       .arg(text(info, "title"), text(info, "description"), text(info, "version"));
    for (const QJsonValue &method : description["methods"].toArray())
        page += methodSection(text(method, "name"), method.toObject());
    page += "## Topics\n\n";
    for (const QJsonValue &topic : description["x-topics"].toArray())
        page += topicSection(text(topic, "name"), topic.toObject());
    return page + "## Settings\n\n" + settingTable(settingLines(settingsSchema));
}

QString descriptionAsText(const QJsonObject &description) {
    QString page = "commands:\n";
    for (const QJsonValue &method : description["methods"].toArray()) {
        page += QString("  %1 {%2}\n      %3\n")
                    .arg(text(method, "name"), parameterList(method.toObject()), text(method, "summary"));
    }
    page += "topics:\n";
    for (const QJsonValue &topic : description["x-topics"].toArray())
        page += QString("  %1%2\n      %3\n")
                    .arg(text(topic, "name"), fieldList(topic[schemaKey].toObject()), text(topic, "summary"));
    return page.trimmed();
}

} // namespace hermes::ctl
