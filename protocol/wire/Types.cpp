#include "protocol/wire/Types.h"

namespace hermes {
namespace {

// Of all numbers a type can hold: no limits that anybody wants to read.
bool isBounded(double limit) {
    return limit > -1e18 && limit < 1e18;
}

QString describe(const char *kind, const Limits &limits) {
    const bool below = isBounded(limits.least), above = isBounded(limits.most);
    QString text = QLatin1String(kind);
    if (below && above)
        text += QStringLiteral(" from %1 to %2").arg(limits.least, 0, 'g', 10).arg(limits.most, 0, 'g', 10);
    else if (below)
        text += QStringLiteral(" of at least %1").arg(limits.least, 0, 'g', 10);
    else if (above)
        text += QStringLiteral(" of at most %1").arg(limits.most, 0, 'g', 10);
    return text;
}

QJsonObject ofType(const char *name) {
    return {{QStringLiteral("type"), QLatin1String(name)}};
}

} // namespace

double readNumber(WireView in, Limits limits, ReadReport &report) {
    const double value = in.number();
    if (value >= limits.least && value <= limits.most)
        return value;
    report.fail(in, describe("a number", limits));
    return 0;
}

qint64 readInteger(WireView in, Limits limits, ReadReport &report) {
    const auto value = in.integer();
    if (value && double(*value) >= limits.least && double(*value) <= limits.most)
        return *value;
    report.fail(in, describe("a whole number", limits));
    return 0;
}

QJsonObject numberSchema(const char *type, const Limits &limits) {
    QJsonObject schema = ofType(type);
    if (isBounded(limits.least))
        schema.insert(QStringLiteral("minimum"), limits.least);
    if (isBounded(limits.most))
        schema.insert(QStringLiteral("maximum"), limits.most);
    return schema;
}

void Type<bool>::read(WireView in, bool &value, const Limits &, ReadReport &report) {
    if (in.kind() != WireView::Kind::Boolean)
        return report.fail(in, QStringLiteral("true or false"));
    value = in.boolean();
}

QJsonObject Type<bool>::schema(const Limits &) {
    return ofType("boolean");
}

void Type<QString>::read(WireView in, QString &value, const Limits &, ReadReport &report) {
    if (in.kind() != WireView::Kind::Text)
        return report.fail(in, QStringLiteral("a text"));
    value = in.text();
}

QJsonObject Type<QString>::schema(const Limits &) {
    return ofType("string");
}

void Type<std::string>::read(WireView in, std::string &value, const Limits &limits, ReadReport &report) {
    QString text;
    Type<QString>::read(in, text, limits, report);
    value = text.toStdString();
}

QJsonObject Type<QJsonValue>::schema(const Limits &) {
    return {{QStringLiteral("x-open"), true}};
}

void Type<QJsonObject>::read(WireView in, QJsonObject &value, const Limits &, ReadReport &report) {
    if (in.kind() != WireView::Kind::Object)
        return report.fail(in, QStringLiteral("an object"));
    value = in.toJson().toObject();
}

QJsonObject Type<QJsonObject>::schema(const Limits &) {
    QJsonObject schema = ofType("object");
    schema.insert(QStringLiteral("additionalProperties"), true);
    schema.insert(QStringLiteral("x-open"), true);
    return schema;
}

bool readsAsArray(WireView in, std::size_t least, std::size_t most, ReadReport &report) {
    if (in.kind() == WireView::Kind::Array && in.size() >= least && in.size() <= most)
        return true;
    report.fail(in, least == most ? QStringLiteral("an array of %1").arg(most)
                                  : QStringLiteral("an array of at most %1").arg(most));
    return false;
}

QJsonObject arraySchema(const QJsonObject &items, std::size_t least, std::size_t most) {
    QJsonObject schema = ofType("array");
    schema.insert(QStringLiteral("items"), items);
    if (least > 0)
        schema.insert(QStringLiteral("minItems"), qint64(least));
    if (most < Limits().elements)
        schema.insert(QStringLiteral("maxItems"), qint64(most));
    return schema;
}

void Type<QStringList>::write(WireWriter &out, const QStringList &values) {
    out.beginArray();
    for (const QString &value : values)
        out.text(value);
    out.endArray();
}

void Type<QStringList>::read(WireView in, QStringList &values, const Limits &limits, ReadReport &report) {
    std::vector<QString> list;
    Type<std::vector<QString>>::read(in, list, limits, report);
    values = QStringList(list.begin(), list.end());
}

QJsonObject Type<QStringList>::schema(const Limits &limits) {
    return Type<std::vector<QString>>::schema(limits);
}

} // namespace hermes
