#include "gui/desktop/model/TopicFields.h"

#include <QJsonArray>
#include <map>

namespace hermes::desktop {
namespace {

/// Longer lists are no set of numbers to choose from: a scan has thousands.
constexpr int longestList = 16;
constexpr int deepestSchema = 20;

QString inner(const QString &prefix, const QString &name) {
    return prefix.isEmpty() ? name : prefix + '.' + name;
}

void collect(WireView value, const QString &prefix, int most, QStringList &paths) {
    if (paths.size() >= most)
        return;
    switch (value.kind()) {
    case WireView::Kind::Number:
    case WireView::Kind::Boolean:
        paths.append(prefix);
        break;
    case WireView::Kind::Object: {
        std::map<QString, WireView> members;
        value.forEachMember([&](const QString &name, WireView member) { members[name] = member; });
        for (const auto &[name, member] : members)
            collect(member, inner(prefix, name), most, paths);
        break;
    }
    case WireView::Kind::Array:
        for (std::size_t i = 0; value.size() <= longestList && i < value.size(); ++i)
            collect(value[i], inner(prefix, QString::number(i)), most, paths);
        break;
    default:
        break;
    }
}

/// "type" may be one or a list of them.
bool isOfType(const QJsonObject &schema, const char *type) {
    const QJsonValue types = schema["type"];
    return types == QLatin1String(type) || types.toArray().contains(QLatin1String(type));
}

struct SchemaWalk {
    int most;
    UnknownLists lists;
    QStringList paths;

    void see(const QJsonObject &schema, const QString &prefix, int depth) {
        if (paths.size() >= most || depth > deepestSchema)
            return;
        if (isOfType(schema, "number") || isOfType(schema, "integer") || isOfType(schema, "boolean"))
            paths.append(prefix);
        const QJsonObject members = schema["properties"].toObject();
        for (auto member = members.begin(); member != members.end(); ++member)
            see(member.value().toObject(), inner(prefix, member.key()), depth + 1);
        if (!schema["items"].isObject())
            return;
        const int least = schema["minItems"].toInt(), longest = schema["maxItems"].toInt(-1);
        const bool isKnown = least == longest && longest <= longestList;
        const int count = isKnown ? longest : lists == UnknownLists::One ? 1 : 0;
        for (int i = 0; i < count; ++i)
            see(schema["items"].toObject(), inner(prefix, QString::number(i)), depth + 1);
    }
};

bool hasLongList(const QJsonObject &schema, int depth) {
    constexpr int longList = 1000;
    const QJsonObject items = schema["items"].toObject();
    const bool isList = isOfType(schema, "array") && !isOfType(items, "string"); // texts are few
    if (depth > deepestSchema || (isList && schema["maxItems"].toInt(longList + 1) > longList))
        return true;
    const QJsonObject members = schema["properties"].toObject();
    for (const QJsonValue &member : members)
        if (hasLongList(member.toObject(), depth + 1))
            return true;
    return !items.isEmpty() && hasLongList(items, depth + 1);
}

} // namespace

QJsonObject topicDescription(const QJsonObject &description, const QString &topic) {
    for (const QJsonValue &one : description["x-topics"].toArray())
        if (one["name"].toString() == topic)
            return one.toObject();
    return {};
}

QJsonObject schemaAt(QJsonObject schema, const QString &path) {
    for (const QString &name : path.split('.', Qt::SkipEmptyParts)) {
        const QString unit = unitOf(schema);
        const QJsonObject members = schema["properties"].toObject();
        schema = (members.contains(name) ? members[name] : schema["items"]).toObject();
        if (!unit.isEmpty() && unitOf(schema).isEmpty())
            schema["unit"] = unit; // that of a list is that of its elements
    }
    return schema;
}

QString unitAt(const QJsonObject &schema, const QString &path) {
    return unitOf(schemaAt(schema, path));
}

QString unitOf(const QJsonObject &schema) {
    QString unit = schema["unit"].toString().left(12);
    unit.replace("^2", u8"\u00b2").replace("^3", u8"\u00b3");
    return unit == "degC" ? QStringLiteral("°C") : unit == "deg" ? QStringLiteral("°") : unit;
}

bool isHeavy(const QJsonObject &schema) {
    return hasLongList(schema, 0);
}

QStringList numericPaths(WireView message, int most) {
    QStringList paths;
    collect(message, {}, most, paths);
    return paths;
}

QStringList numericPaths(const QJsonObject &schema, int most, UnknownLists lists) {
    SchemaWalk walk{most, lists, {}};
    walk.see(schema, {}, 0);
    return walk.paths;
}

WireView messageValueAt(WireView message, const QString &path) {
    if (path.isEmpty())
        return message;
    for (const QString &name : path.split('.')) {
        bool isNumber = false;
        const uint element = name.toUInt(&isNumber);
        if (message.kind() != WireView::Kind::Array)
            message = message[name.toUtf8().constData()];
        else
            message = isNumber && element < message.size() ? message[element] : WireView();
    }
    return message;
}

} // namespace hermes::desktop
