#include "common/schema/CheckableSchema.h"

#include "common/schema/SchemaKeys.h"
#include "common/schema/SchemaText.h"

#include <QJsonArray>
#include <QRegularExpression>
#include <QStringList>

namespace hermes {
namespace {

const QStringList branchKeys{QStringLiteral("allOf"), QStringLiteral("anyOf"), QStringLiteral("oneOf")};

constexpr int longestPattern = 1000;

/// What one keyword of a schema hinders; empty: nothing.
QString hindrance(const QString &keyword, const QJsonValue &value) {
    // References may go round in circles, the others cost the square of what is checked, or more.
    static const QStringList unbounded{
        "$ref",     "uniqueItems", "patternProperties", "propertyNames", "dependencies",
        "contains", "if",          "extends",           "disallow"};
    if (unbounded.contains(keyword))
        return QString("%1 is not supported").arg(keyword);
    if (keyword == "multipleOf" && !(value.toDouble() > 0))
        return QString("multipleOf is %1, expected a number above 0").arg(shown(value));
    if (keyword == "pattern") {
        const QRegularExpression pattern(value.toString().left(longestPattern));
        if (value.toString().size() > longestPattern)
            return QString("pattern is longer than %1 characters").arg(longestPattern);
        if (!pattern.isValid())
            return QString("pattern is %1: %2").arg(shown(value), pattern.errorString());
    }
    return {};
}

class Adapter {
public:
    QJsonObject adapt(const QJsonObject &schema, const QString &path) {
        QJsonObject result;
        for (auto member = schema.begin(); member != schema.end(); ++member) {
            const QString key = member.key();
            if (const QString found = hindrance(key, member.value()); !found.isEmpty() && problem_.isEmpty())
                problem_ = path.isEmpty() ? found : path + ": " + found;
            if (key != "pattern" && key != "format")
                result.insert(key, adapted(key, member.value(), path));
        }
        return result;
    }
    const QString &problem() const { return problem_; }

private:
    QJsonValue adapted(const QString &key, const QJsonValue &value, const QString &path) {
        if (key == "type" && value == "integer")
            return "number";
        if (key == propertiesKey && value.isObject()) {
            QJsonObject result;
            const QJsonObject properties = value.toObject();
            for (auto one = properties.begin(); one != properties.end(); ++one)
                result.insert(
                    one.key(),
                    inner(one.value(), path.isEmpty() ? one.key() : path + QLatin1Char('.') + one.key()));
            return result;
        }
        if (value.isArray() && (branchKeys.contains(key) || key == itemsKey)) {
            QJsonArray result;
            for (const QJsonValue &one : value.toArray())
                result.append(inner(one, path));
            return result;
        }
        static const QStringList schemaKeys{itemsKey, "not", "additionalItems", "additionalProperties"};
        return schemaKeys.contains(key) ? inner(value, path) : value;
    }
    QJsonValue inner(const QJsonValue &schema, const QString &path) {
        return schema.isObject() ? QJsonValue(adapt(schema.toObject(), path)) : schema;
    }

    QString problem_;
};

bool spend(const QJsonObject &schema, const QJsonValue &value, int &steps) {
    const QJsonValue items = schema.value(itemsKey);
    steps -= 1 + schema.value("enum").toArray().size() + schema.size();
    if (value.isArray())
        for (const QJsonValue &element : value.toArray())
            if (steps < 0 || !spend(items.toObject(), element, steps))
                return false;
    if (value.isObject()) {
        const QJsonObject properties = schema.value(propertiesKey).toObject(), object = value.toObject();
        for (auto member = object.begin(); member != object.end(); ++member)
            if (steps < 0 || !spend(properties.value(member.key()).toObject(), member.value(), steps))
                return false;
    }
    for (const QString &key : branchKeys)
        for (const QJsonValue &branch : schema.value(key).toArray())
            if (steps < 0 || !spend(branch.toObject(), value, steps))
                return false;
    const QJsonValue opposite = schema.value("not");
    return steps >= 0 && (!opposite.isObject() || spend(opposite.toObject(), value, steps));
}

} // namespace

CheckableSchema checkable(const QJsonObject &schema) {
    Adapter adapter;
    const QJsonObject adapted = adapter.adapt(schema, QString());
    return {adapted, adapter.problem()};
}

bool isCheapToCheck(const QJsonObject &schema, const QJsonValue &value, int steps) {
    return spend(schema, value, steps);
}

} // namespace hermes
