#include "common/daemon/Command.h"

#include "common/Log.h"
#include "protocol/wire/FieldTable.h"

#include <exception>

namespace hermes {
namespace {

const QString nameKey = QStringLiteral("name");
const QString schemaKey = QStringLiteral("schema");

} // namespace

Command::Command(const QString &name, const QString &text)
    : commandName(name)
    , summary(text) {}

Command &Command::param(const Field &field) {
    fields.push_back(field);
    return *this;
}

Command &Command::returns(const QJsonObject &schema) {
    resultSchema = schema;
    return *this;
}

Command &Command::returnsNull() {
    return returns({{QStringLiteral("type"), QStringLiteral("null")}});
}

Command &Command::example(const QJsonObject &params, const QJsonValue &result) {
    exampleParams = params;
    exampleResult = result;
    return *this;
}

Command &Command::with(const QString &keyword, const QJsonValue &value) {
    extra.insert(keyword, value);
    return *this;
}

Command &Command::urgent() {
    return with(urgentKey(), true);
}

Command &Command::fresh() {
    return with(freshKey(), true);
}

Command &Command::handler(const Handler &function) {
    return asyncHandler([function](const Call &call, const Reply &reply) { reply.give(function(call)); });
}

Command &Command::asyncHandler(const AsyncHandler &function) {
    run = function;
    return *this;
}

QJsonObject Command::description() const {
    QJsonArray params;
    for (const Field &field : fields) {
        params.append(QJsonObject{{nameKey, field.name()},
                                  {QStringLiteral("required"), field.isRequired()},
                                  {schemaKey, field.schema()}});
    }
    QJsonObject method = extra;
    method.insert(nameKey, commandName);
    method.insert(QStringLiteral("summary"), summary);
    method.insert(QStringLiteral("paramStructure"), QStringLiteral("either"));
    method.insert(QStringLiteral("params"), params);
    method.insert(QStringLiteral("result"),
                  QJsonObject{{nameKey, QStringLiteral("result")}, {schemaKey, resultSchema}});
    if (!exampleResult.isUndefined()) {
        QJsonArray values;
        for (auto member = exampleParams.begin(); member != exampleParams.end(); ++member)
            values.append(QJsonObject{{nameKey, member.key()}, {QStringLiteral("value"), member.value()}});
        const QJsonObject pairing{
            {nameKey, QStringLiteral("example")},
            {QStringLiteral("params"), values},
            {QStringLiteral("result"),
             QJsonObject{{nameKey, QStringLiteral("result")}, {QStringLiteral("value"), exampleResult}}}};
        method.insert(QStringLiteral("examples"), QJsonArray{pairing});
    }
    return method;
}

QJsonObject Command::paramsSchema() const {
    QJsonObject properties;
    QJsonArray required;
    for (const Field &field : fields) {
        properties.insert(field.name(), field.schema());
        if (field.isRequired())
            required.append(field.name());
    }
    return objectSchema(properties, required);
}

Result<QJsonObject> Command::accept(const QJsonValue &params) const {
    QJsonObject named = params.toObject();
    const QJsonArray positional = params.toArray();
    if (positional.size() > int(fields.size())) {
        return invalidParams({{QStringLiteral("[%1]").arg(fields.size()), positional.at(int(fields.size())),
                               QStringLiteral("at most %1 parameters").arg(fields.size())}});
    }
    for (int i = 0; i < positional.size(); ++i)
        named.insert(fields[size_t(i)].name(), positional.at(i));
    if (!validator)
        validator = std::make_shared<const SchemaValidator>(paramsSchema());
    const auto violations = validator->check(named);
    if (!violations.empty())
        return invalidParams(violations);
    for (const Field &field : fields) {
        if (!field.defaultValue().isUndefined() && !named.contains(field.name()))
            named.insert(field.name(), field.defaultValue());
    }
    return named;
}

void Command::execute(const QJsonValue &params, Call call, const Reply &reply) const {
    QString what = QStringLiteral("unknown exception");
    try {
        const auto accepted = accept(params);
        if (!accepted)
            return reply.error(accepted.error());
        call.params = *accepted;
        return run(call, reply);
    } catch (const std::exception &exception) {
        what = QString::fromUtf8(exception.what());
    } catch (...) {
        // ends this call like any other exception
    }
    logError(commandName, QStringLiteral("exception in the handler: ") + what);
    reply.error(
        Error(ErrorCode::InternalError, QStringLiteral("internal error in %1: %2").arg(commandName, what)));
}

} // namespace hermes
