#include "common/daemon/Command.h"

#include "common/Log.h"
#include "common/schema/Angles.h"
#include "protocol/wire/FieldTable.h"

#include <algorithm>
#include <exception>

namespace hermes {
namespace {

const QString nameKey = QStringLiteral("name");
const QString schemaKey = QStringLiteral("schema");
const QString roleKey = QStringLiteral("x-role");

} // namespace

Command::Command(const QString &name, const QString &text)
    : commandName_(name)
    , summary_(text) {}

Command &Command::param(const Field &field) {
    if (const auto role = roleFrom(field.schema().value(roleKey).toString()))
        restricted_.emplace_back(fields_.size(), *role);
    fields_.push_back(field);
    return *this;
}

Command &Command::returns(const QJsonObject &schema) {
    resultSchema_ = schema;
    return *this;
}

Command &Command::returnsNull() {
    return returns({{"type", "null"}});
}

Command &Command::example(const QJsonObject &params, const QJsonValue &result) {
    exampleParams_ = params;
    exampleResult_ = result;
    return *this;
}

Command &Command::with(const QString &keyword, const QJsonValue &value) {
    extra_.insert(keyword, value);
    return *this;
}

Command &Command::needs(Role role) {
    role_ = role;
    return *this;
}

Command &Command::urgent() {
    return with(urgentKey(), true);
}

Command &Command::fresh() {
    return with(freshKey(), true);
}

Command &Command::takes(int values) {
    maxValues_ = values;
    return *this;
}

Command &Command::unlisted() {
    isListed_ = false;
    return *this;
}

Command &Command::stream() {
    isStream_ = true;
    return *this;
}

Command &Command::handler(const Handler &function) {
    return asyncHandler([function](const Call &call, const Reply &reply) { reply.give(function(call)); });
}

Command &Command::asyncHandler(const AsyncHandler &function) {
    run_ = function;
    return *this;
}

QJsonObject Command::description() const {
    QJsonArray params;
    for (const Field &field : fields_) {
        params.append(QJsonObject{
            {nameKey, field.name()}, {"required", field.isRequired()}, {schemaKey, field.schema()}});
    }
    QJsonObject method = extra_;
    method.insert(nameKey, commandName_);
    method.insert("summary", summary_);
    method.insert(roleKey, toString(role_));
    method.insert("paramStructure", "either");
    method.insert("params", params);
    method.insert("result", QJsonObject{{nameKey, "result"}, {schemaKey, resultSchema_}});
    if (!exampleResult_.isUndefined()) {
        QJsonArray values;
        for (auto member = exampleParams_.begin(); member != exampleParams_.end(); ++member)
            values.append(QJsonObject{{nameKey, member.key()}, {"value", member.value()}});
        const QJsonObject pairing{{nameKey, "example"},
                                  {"params", values},
                                  {"result", QJsonObject{{nameKey, "result"}, {"value", exampleResult_}}}};
        method.insert("examples", QJsonArray{pairing});
    }
    return method;
}

QJsonObject Command::paramsSchema() const {
    QJsonObject properties;
    QJsonArray required;
    for (const Field &field : fields_) {
        properties.insert(field.name(), field.schema());
        if (field.isRequired())
            required.append(field.name());
    }
    return objectSchema(properties, required);
}

QJsonObject Command::fitting(const QJsonObject &named) const {
    QJsonObject fit;
    for (const Field &field : fields_) {
        const QJsonValue value = named.value(field.name());
        const bool isPlain = !value.isUndefined() && !value.isArray() && !value.isObject();
        if (isPlain && validator_->check(QJsonObject{{field.name(), value}}).empty())
            fit.insert(field.name(), value);
    }
    return fit;
}

Result<QJsonObject> Command::accept(const QJsonValue &params) const {
    QJsonObject named = params.toObject();
    const QJsonArray positional = params.toArray();
    if (positional.size() > int(fields_.size()) && !isUrgent()) {
        return invalidParams({{QString("[%1]").arg(fields_.size()), positional.at(int(fields_.size())),
                               QString("at most %1 parameters").arg(fields_.size())}});
    }
    for (int i = 0; i < std::min(positional.size(), int(fields_.size())); ++i)
        named.insert(fields_[size_t(i)].name(), positional.at(i));
    if (!validator_)
        validator_ = std::make_shared<const SchemaValidator>(paramsSchema());
    if (isUrgent())
        named = fitting(named);
    else if (const auto violations = validator_->check(named); !violations.empty())
        return invalidParams(violations);
    for (const Field &field : fields_) {
        if (!field.defaultValue().isUndefined() && !named.contains(field.name()))
            named.insert(field.name(), field.defaultValue());
    }
    return named;
}

Error Call::notFor(const QString &what, Role needed) const {
    return {ErrorCode::NotAuthorised,
            QString("%1 is for the role %2, this client has %3; %4")
                .arg(what, toString(needed), toString(role), moreRights),
            QJsonObject{{"role", toString(role)}, {"needed", toString(needed)}}};
}

std::optional<Error> Command::refusal(const Call &call) const {
    for (const auto &[index, needed] : restricted_) {
        const Field &field = fields_[index];
        const QJsonValue given = call.params.value(field.name());
        if (call.role < needed && !given.isUndefined() && given != field.defaultValue())
            return call.notFor(commandName_ + " with " + field.name(), needed);
    }
    return std::nullopt;
}

/// Of a set-point it would be told again and again.
void Command::warnOfAngles(const QJsonObject &params) const {
    if (isSetPoint())
        return;
    for (const Field &field : fields_)
        for (const QString &text : beyondTurn(field.schema(), params.value(field.name()), field.name()))
            logWarning(commandName_, text);
}

void Command::execute(const QJsonValue &params, Call call, const Reply &reply) const {
    QString what = "unknown exception";
    try {
        if (call.role < role_)
            return reply.error(call.notFor(commandName_, role_));
        const auto accepted = accept(params);
        if (!accepted)
            return reply.error(accepted.error());
        call.params = *accepted;
        if (const auto refused = refusal(call))
            return reply.error(*refused);
        warnOfAngles(call.params);
        return run_(call, reply);
    } catch (const std::exception &exception) {
        what = QString::fromUtf8(exception.what());
    } catch (...) {
        // ends this call like any other exception
    }
    logError(commandName_, "exception in the handler: " + what);
    reply.error(Error(ErrorCode::InternalError, QString("internal error in %1: %2").arg(commandName_, what)));
}

} // namespace hermes
