#include "common/schema/SchemaValidator.h"

#include "common/schema/Angles.h"
#include "common/schema/CheckableSchema.h"
#include "common/schema/SchemaKeys.h"
#include "common/schema/SchemaText.h"

#include <QRegularExpression>
#include <QStringList>
#include <algorithm>
#include <cmath>

// Without it valijson ends the program at a schema that it refuses.
#define VALIJSON_USE_EXCEPTIONS 1
#include <valijson/adapters/qtjson_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

namespace hermes {
namespace {

// More of them tell nobody more, and a request may hold a hundred thousand.
constexpr std::size_t maxViolations = 20;

const QString typeKey = QStringLiteral("type");
const QString patternKey = QStringLiteral("pattern");

QString joined(const QString &path, const QString &key) {
    return path.isEmpty() ? key : path + QLatin1Char('.') + key;
}

// "$" of a JSON Schema is the very end, not before a last line feed as well.
QString withStrictEnd(const QString &pattern) {
    QString strict;
    bool isClass = false;
    for (int i = 0; i < pattern.size(); ++i) {
        const QChar c = pattern[i];
        isClass = c == QLatin1Char('[') || (isClass && c != QLatin1Char(']'));
        if (c == QLatin1Char('$') && !isClass)
            strict += QStringLiteral("\\z");
        else
            strict += c;
        if (c == QLatin1Char('\\') && ++i < pattern.size())
            strict += pattern[i];
    }
    return strict;
}

// What the expression cannot decide within its limit is left to whoever applies the value.
bool isMatch(const QString &pattern, const QString &text) {
    const QRegularExpression expression(QStringLiteral("(*LIMIT_MATCH=100000)") + withStrictEnd(pattern));
    const QRegularExpressionMatch match = expression.match(text);
    return match.hasMatch() || !match.isValid();
}

// Missing and unknown members, numbers that should be whole and patterns, each named by its own path.
void checkStructure(const QJsonObject &schema, const QJsonValue &value, const QString &path,
                    std::vector<SchemaViolation> &found) {
    if (schema.value(typeKey) == QStringLiteral("integer") && value.isDouble() &&
        value.toDouble() != std::floor(value.toDouble()))
        found.push_back({path, value, expectation(schema)});
    if (schema.contains(patternKey) && value.isString() &&
        !isMatch(schema.value(patternKey).toString(), value.toString()))
        found.push_back({path, value, expectation(schema)});
    if (value.isArray() && schema.value(itemsKey).isObject()) {
        const QJsonArray array = value.toArray();
        for (int i = 0; i < array.size() && found.size() < maxViolations; ++i)
            checkStructure(schema.value(itemsKey).toObject(), array.at(i), joined(path, QString::number(i)),
                           found);
    }
    if (!value.isObject())
        return;
    const QJsonObject object = value.toObject();
    const QJsonObject properties = schema.value(propertiesKey).toObject();
    for (const QJsonValue &required : schema.value(QStringLiteral("required")).toArray()) {
        const QString key = required.toString();
        if (!object.contains(key))
            found.push_back(
                {joined(path, key), QJsonValue::Undefined, expectation(properties.value(key).toObject())});
    }
    const bool closed = schema.value(QStringLiteral("additionalProperties")) == QJsonValue(false);
    for (auto member = object.begin(); member != object.end() && found.size() < maxViolations; ++member) {
        const QString memberPath = joined(path, member.key());
        if (properties.contains(member.key()))
            checkStructure(properties.value(member.key()).toObject(), member.value(), memberPath, found);
        else if (closed)
            found.push_back({memberPath, member.value(),
                             properties.isEmpty() ? QStringLiteral("nothing of this name")
                                                  : QStringLiteral("nothing of this name; known are: ") +
                                                        properties.keys().join(QStringLiteral(", "))});
    }
}

struct Place {
    QString path;
    QJsonValue value;
    QJsonObject schema;
};

// Follows valijson's context ("<root>", "[motor]", "[0]") through the schema and the value.
Place locate(const std::vector<std::string> &context, const QJsonObject &schema, const QJsonValue &root) {
    Place place{QString(), root, schema};
    for (size_t i = 1; i < context.size(); ++i) {
        const QString key = QString::fromStdString(context[i].substr(1, context[i].size() - 2));
        place.path = joined(place.path, key);
        if (place.value.isArray()) {
            place.value = place.value.toArray().at(key.toInt());
            place.schema = place.schema.value(itemsKey).toObject();
        } else {
            place.value = place.value.toObject().value(key);
            place.schema = place.schema.value(propertiesKey).toObject().value(key).toObject();
        }
    }
    return place;
}

// ": 90 rad is 14.3 turns; did you mean ...", of an angle beyond a turn.
QString degreesText(const Place &place) {
    return place.value.isDouble() ? beyondTurn(place.schema, place.value).join(QString()) : QString();
}

} // namespace

struct SchemaValidator::Compiled {
    QJsonObject source;
    valijson::Schema schema;
};

SchemaValidator::SchemaValidator(const QJsonObject &schema)
    : compiled_(new Compiled) {
    compiled_->source = schema;
    const QJsonValue adapted = checkable(schema).schema;
    valijson::SchemaParser parser;
    parser.populateSchema(valijson::adapters::QtJsonAdapter(adapted), compiled_->schema);
}

Result<SchemaValidator> SchemaValidator::make(const QJsonObject &schema) {
    const QString problem = checkable(schema).problem;
    if (!problem.isEmpty())
        return Error(ErrorCode::InvalidParams, problem);
    try {
        return SchemaValidator(schema);
    } catch (const std::exception &error) {
        return Error(ErrorCode::InvalidParams, QString::fromUtf8(error.what()));
    }
}

SchemaValidator::~SchemaValidator() = default;
SchemaValidator::SchemaValidator(SchemaValidator &&) noexcept = default;
SchemaValidator &SchemaValidator::operator=(SchemaValidator &&) noexcept = default;

std::vector<SchemaViolation> SchemaValidator::check(const QJsonValue &value) const {
    std::vector<SchemaViolation> found;
    checkStructure(compiled_->source, value, QString(), found);
    if (found.size() >= maxViolations)
        return found;
    valijson::Validator validator;
    valijson::ValidationResults results;
    validator.validate(compiled_->schema, valijson::adapters::QtJsonAdapter(value), &results);
    std::vector<Place> places;
    for (const auto &error : results) {
        if (places.size() < maxViolations)
            places.push_back(locate(error.context, compiled_->source, value));
    }
    // valijson reports each parent of a bad value too; only the innermost place says something.
    for (const Place &place : places) {
        const auto inside = [&place](const QString &path) {
            return path == place.path || place.path.isEmpty() ||
                   path.startsWith(place.path + QLatin1Char('.'));
        };
        const bool known =
            std::any_of(found.begin(), found.end(), [&](const auto &one) { return inside(one.path); });
        const bool outer = std::any_of(places.begin(), places.end(), [&](const auto &other) {
            return other.path != place.path && inside(other.path);
        });
        if (!known && !outer)
            found.push_back({place.path, place.value, expectation(place.schema) + degreesText(place)});
    }
    return found;
}

QString SchemaViolation::toString() const {
    const QString name = path.isEmpty() ? QStringLiteral("the value") : path;
    if (value.isUndefined())
        return QStringLiteral("%1 is missing, expected %2").arg(name, expected);
    return QStringLiteral("%1 is %2, expected %3").arg(name, shown(value), expected);
}

QJsonObject SchemaViolation::toJson() const {
    QJsonObject object{{QStringLiteral("path"), path}, {QStringLiteral("expected"), expected}};
    if (!value.isUndefined())
        object.insert(QStringLiteral("value"), value);
    return object;
}

QString toString(const std::vector<SchemaViolation> &violations) {
    QStringList texts;
    for (const SchemaViolation &violation : violations)
        texts.append(violation.toString());
    return texts.join(QStringLiteral("; "));
}

QJsonArray toJson(const std::vector<SchemaViolation> &violations) {
    QJsonArray array;
    for (const SchemaViolation &violation : violations)
        array.append(violation.toJson());
    return array;
}

Error invalidParams(const std::vector<SchemaViolation> &violations, const QString &message) {
    return Error(ErrorCode::InvalidParams,
                 message.isEmpty() ? QStringLiteral("invalid params: ") + toString(violations) : message,
                 QJsonObject{{QStringLiteral("errors"), toJson(violations)}});
}

} // namespace hermes
