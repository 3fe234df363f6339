#include "gui/hermesctl/Descriptions.h"

#include "common/schema/SchemaKeys.h"
#include "common/schema/SchemaText.h"

#include <QJsonArray>

namespace hermes::ctl {
namespace {

void addPaths(QStringList &paths, const QJsonObject &schema, const QString &prefix, bool withGroups) {
    const QJsonObject properties = schema[propertiesKey].toObject();
    for (auto property = properties.begin(); property != properties.end(); ++property) {
        const QJsonObject below = property.value().toObject();
        const bool isGroup = below.contains(propertiesKey);
        if (!isGroup || withGroups)
            paths.append(prefix + property.key());
        if (isGroup)
            addPaths(paths, below, prefix + property.key() + '.', withGroups);
    }
}

} // namespace

QStringList namesOf(const QJsonArray &list) {
    QStringList names;
    for (const QJsonValue &one : list)
        names.append(one["name"].toString());
    return names;
}

QJsonObject named(const QJsonArray &list, const QString &name) {
    for (const QJsonValue &one : list) {
        if (one["name"].toString() == name)
            return one.toObject();
    }
    return {};
}

QJsonObject parametersSchema(const QJsonObject &method) {
    QJsonObject properties;
    for (const QJsonValue &param : method["params"].toArray())
        properties.insert(param["name"].toString(), param["schema"]);
    return {{propertiesKey, properties}};
}

QJsonObject settingSchema(const QJsonObject &schema, const QString &path) {
    QJsonObject below = schema;
    for (const QString &key : path.split('.'))
        below = below[propertiesKey].toObject()[key].toObject();
    return below;
}

QStringList settingPaths(const QJsonObject &schema, bool withGroups) {
    QStringList paths;
    addPaths(paths, schema, QString(), withGroups);
    return paths;
}

QString explanation(const QJsonObject &schema) {
    QString text = expectation(schema);
    if (schema.contains("default"))
        text += "; default " + shown(schema["default"]);
    const QString description = schema["description"].toString();
    return description.isEmpty() ? text : text + "; " + description;
}

} // namespace hermes::ctl
