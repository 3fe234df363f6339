#include "gui/hermesctl/Markdown.h"

#include "common/schema/SchemaText.h"
#include "protocol/wire/JsonText.h"

#include <QJsonArray>
#include <QStringList>

namespace hermes::ctl {
namespace {

const QString nameKey = QStringLiteral("name");
const QString schemaKey = QStringLiteral("schema");
const QString defaultKey = QStringLiteral("default");

QString text(const QJsonValue &object, const char *key) {
    return object[QLatin1String(key)].toString();
}

QString parameterList(const QJsonObject &method) {
    QStringList names;
    for (const QJsonValue &param : method[QStringLiteral("params")].toArray()) {
        const bool required = param[QStringLiteral("required")].toBool();
        names.append(text(param, "name") + (required ? QString() : QStringLiteral("?")));
    }
    return names.join(QStringLiteral(", "));
}

QString cell(QString content) {
    return content.replace(QLatin1Char('|'), QStringLiteral("\\|"));
}

/// A line for each field, those of inner objects by their path; nothing where the schema has none.
QString fieldLines(const QJsonObject &schema, const QString &path) {
    if (schema.contains(QStringLiteral("items")))
        return fieldLines(schema[QStringLiteral("items")].toObject(), path + QStringLiteral("[]"));
    const QString prefix = path.isEmpty() ? path : path + QLatin1Char('.');
    const QJsonObject others = schema[QStringLiteral("additionalProperties")].toObject();
    QString lines = others.isEmpty() ? QString() : fieldLines(others, prefix + QLatin1Char('*'));
    const QJsonObject properties = schema[QStringLiteral("properties")].toObject();
    const QJsonArray required = schema[QStringLiteral("required")].toArray();
    for (auto property = properties.begin(); property != properties.end(); ++property) {
        const QJsonObject below = property.value().toObject();
        const QString name = prefix + property.key();
        const bool mayBeMissing = !required.contains(property.key());
        lines += QStringLiteral("| `%1` | %2%3 | %4 |\n")
                     .arg(name, cell(expectation(below)),
                          mayBeMissing ? QStringLiteral("; may be missing") : QString(),
                          cell(text(below, "description")));
        lines += fieldLines(below, name);
    }
    return lines;
}

/// Of a value that is called path; nothing for one without fields.
QString fieldTable(const QJsonObject &schema, const QString &path = {}) {
    const QString lines = fieldLines(schema, path);
    return lines.isEmpty() ? lines
                           : QStringLiteral("| field | what | meaning |\n|---|---|---|\n%1\n").arg(lines);
}

QString parameterTable(const QJsonArray &params) {
    QString table = QStringLiteral("| parameter | expected | default | meaning |\n|---|---|---|---|\n");
    for (const QJsonValue &param : params) {
        const QJsonObject schema = param[schemaKey].toObject();
        const QString fallback = schema.contains(defaultKey)                  ? shown(schema[defaultKey])
                                 : param[QStringLiteral("required")].toBool() ? QStringLiteral("required")
                                                                              : QStringLiteral("optional");
        table += QStringLiteral("| `%1` | %2 | %3 | %4 |\n")
                     .arg(text(param, "name"), cell(expectation(schema)), cell(fallback),
                          cell(text(schema, "description")));
    }
    table += QLatin1Char('\n');
    for (const QJsonValue &param : params)
        table += fieldTable(param[schemaKey].toObject(), text(param, "name"));
    return table;
}

QString example(const QString &method, const QJsonObject &pairing) {
    QJsonObject params;
    for (const QJsonValue &param : pairing[QStringLiteral("params")].toArray())
        params.insert(text(param, "name"), param[QStringLiteral("value")]);
    const QJsonObject request{{QStringLiteral("jsonrpc"), QStringLiteral("2.0")},
                              {QStringLiteral("id"), 1},
                              {QStringLiteral("method"), method},
                              {QStringLiteral("params"), params}};
    return QStringLiteral("```json\n%1\n%2\n```\n\n")
        .arg(QString::fromUtf8(compactJson(request)),
             QString::fromUtf8(
                 compactJson(pairing[QStringLiteral("result")].toObject()[QStringLiteral("value")])));
}

QString topicSection(const QJsonObject &topic) {
    const QJsonObject schema = topic[schemaKey].toObject();
    return QStringLiteral("### %1\n\n%2.%3\n\nData: %4.\n\n%5")
        .arg(text(topic, "name"), text(topic, "summary"),
             topic[QStringLiteral("snapshot")].toBool() ? QStringLiteral(" Begins with the full state.")
                                                        : QString(),
             expectation(schema), fieldTable(schema));
}

/// {x, y, theta}: of an object, or of the objects of a list.
QString fieldList(const QJsonObject &schema) {
    if (schema.contains(QStringLiteral("items")))
        return fieldList(schema[QStringLiteral("items")].toObject());
    const QStringList names = schema[QStringLiteral("properties")].toObject().keys();
    return names.isEmpty() ? QString() : QStringLiteral(" {%1}").arg(names.join(QStringLiteral(", ")));
}

QString methodSection(const QJsonObject &method) {
    const QString name = text(method, "name");
    QString section = QStringLiteral("### %1\n\n%2.\n\n").arg(name, text(method, "summary"));
    const QJsonArray params = method[QStringLiteral("params")].toArray();
    if (!params.isEmpty())
        section += parameterTable(params);
    const QJsonObject result = method[QStringLiteral("result")].toObject()[schemaKey].toObject();
    section += QStringLiteral("Result: %1.\n\n").arg(expectation(result)) + fieldTable(result);
    for (const QJsonValue &pairing : method[QStringLiteral("examples")].toArray())
        section += example(name, pairing.toObject());
    return section;
}

void addSettings(QString &table, const QJsonObject &schema, const QString &prefix) {
    const QJsonObject properties = schema[QStringLiteral("properties")].toObject();
    for (auto property = properties.begin(); property != properties.end(); ++property) {
        const QJsonObject below = property.value().toObject();
        const QString path = prefix + property.key();
        if (below.contains(QStringLiteral("properties"))) {
            addSettings(table, below, path + QLatin1Char('.'));
            continue;
        }
        table += QStringLiteral("| `%1` | %2 | %3 | %4 | %5 |\n")
                     .arg(path, cell(expectation(below)), cell(shown(below[defaultKey])),
                          text(below, "x-applies"), cell(text(below, "description")));
    }
}

} // namespace

QString descriptionAsMarkdown(const QJsonObject &description, const QJsonObject &settingsSchema) {
    const QJsonObject info = description[QStringLiteral("info")].toObject();
    QString page = QStringLiteral("# %1\n\n%2. Version %3.\n\n## Commands\n\n")
                       .arg(text(info, "title"), text(info, "description"), text(info, "version"));
    for (const QJsonValue &method : description[QStringLiteral("methods")].toArray())
        page += methodSection(method.toObject());
    page += QStringLiteral("## Topics\n\n");
    for (const QJsonValue &topic : description[QStringLiteral("x-topics")].toArray())
        page += topicSection(topic.toObject());
    page += QStringLiteral(
        "## Settings\n\n| path | expected | default | applies | meaning |\n|---|---|---|---|---|\n");
    addSettings(page, settingsSchema, QString());
    return page;
}

QString descriptionAsText(const QJsonObject &description) {
    QString page = QStringLiteral("commands:\n");
    for (const QJsonValue &method : description[QStringLiteral("methods")].toArray()) {
        page += QStringLiteral("  %1 {%2}\n      %3\n")
                    .arg(text(method, "name"), parameterList(method.toObject()), text(method, "summary"));
    }
    page += QStringLiteral("topics:\n");
    for (const QJsonValue &topic : description[QStringLiteral("x-topics")].toArray())
        page += QStringLiteral("  %1%2\n      %3\n")
                    .arg(text(topic, "name"), fieldList(topic[schemaKey].toObject()), text(topic, "summary"));
    return page.trimmed();
}

} // namespace hermes::ctl
