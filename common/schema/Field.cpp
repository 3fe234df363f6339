#include "common/schema/Field.h"

#include "protocol/wire/Fields.h"
#include "vectorlib/geometry/Angle.h"

namespace hermes {
namespace {

QJsonObject ofType(const char *type) {
    return {{QStringLiteral("type"), QLatin1String(type)}};
}

} // namespace

Field::Field(QString name, const QString &description, QJsonObject schema)
    : fieldName_(std::move(name))
    , content_(std::move(schema)) {
    content_.insert(QStringLiteral("description"), description);
}

Field Field::number(const QString &name, const QString &description) {
    return Field(name, description, ofType("number"));
}

Field Field::angle(const QString &name, const QString &description) {
    return number(name, description).unit(QStringLiteral("rad")).range(-2 * vectorlib::pi, 2 * vectorlib::pi);
}

Field Field::integer(const QString &name, const QString &description) {
    return Field(name, description, ofType("integer"));
}

Field Field::text(const QString &name, const QString &description) {
    return Field(name, description, ofType("string"));
}

Field Field::boolean(const QString &name, const QString &description) {
    return Field(name, description, ofType("boolean"));
}

Field Field::array(const QString &name, const QString &description, const QJsonObject &itemSchema) {
    return Field(name, description, ofType("array")).with(QStringLiteral("items"), itemSchema);
}

Field Field::object(const QString &name, const QString &description) {
    return Field(name, description, schemaOf<QJsonObject>());
}

Field Field::any(const QString &name, const QString &description) {
    return Field(name, description, schemaOf<QJsonValue>());
}

Field Field::schema(const QString &name, const QString &description, const QJsonObject &schema) {
    return Field(name, description, schema);
}

Field &Field::title(const QString &text) {
    return with(QStringLiteral("title"), text);
}
Field &Field::unit(const QString &text) {
    return with(QStringLiteral("unit"), text);
}
Field &Field::minimum(double value) {
    return with(QStringLiteral("minimum"), value);
}
Field &Field::maximum(double value) {
    return with(QStringLiteral("maximum"), value);
}
Field &Field::range(double least, double most) {
    return minimum(least).maximum(most);
}
Field &Field::step(double increment) {
    return with(QStringLiteral("increment"), increment);
}

Field &Field::choices(const QStringList &allowed) {
    return with(QStringLiteral("enum"), QJsonArray::fromStringList(allowed));
}

Field &Field::byDefault(const QJsonValue &value) {
    return optional().with(QStringLiteral("default"), value);
}

Field &Field::optional() {
    required_ = false;
    return *this;
}

Field &Field::group(const QString &name) {
    return with(QStringLiteral("group"), name);
}

Field &Field::appliesOnRestart() {
    return with(QStringLiteral("x-applies"), QStringLiteral("restart"));
}

Field &Field::with(const QString &keyword, const QJsonValue &value) {
    content_.insert(keyword, value);
    return *this;
}

} // namespace hermes
