// The commands trigger.*.
#include "common/settings/DottedPath.h"
#include "daemons/softwaretrigger/SoftwareTrigger.h"
#include "protocol/wire/Fields.h"

namespace hermes::softwaretrigger {
namespace {

Field idField() {
    return Field::text("id", "Of a trigger");
}

QJsonObject memberSchema(const char *name) {
    return triggerSchema().value("properties").toObject().value(QLatin1String(name)).toObject();
}

Field schemaField(const char *name) {
    const QJsonObject schema = memberSchema(name);
    return Field::schema(name, schema.value("description").toString(), schema);
}

// Definition and state together.
QJsonObject listedSchema() {
    QJsonObject schema = triggerSchema(), state = schemaOf<TriggerState>();
    QJsonArray required = state["required"].toArray();
    for (const QJsonValue &member : schema["required"].toArray())
        required.append(member);
    schema["properties"] = merged(schema["properties"].toObject(), state["properties"].toObject());
    schema["required"] = required;
    return schema;
}

} // namespace

void SoftwareTrigger::declareCommands() {
    const QJsonObject when{{"kind", "period"}, {"period_s", 0.1}};
    const QJsonArray actions{QJsonObject{{"do", "call"},
                                         {"daemon", "seriallogger"},
                                         {"method", "mark"},
                                         {"params", QJsonObject{{"text", "tick"}}}}};
    addCommand(Command("trigger.list", "All triggers: their definitions, and how they are")
                   .needs(Role::Observer)
                   .returns({{"type", "array"}, {"items", listedSchema()}})
                   .handler([this](const Call &) { return list(); }));
    addCommand(
        Command("trigger.define",
                "Adds a trigger, or replaces the one of that id; settings.save keeps it. Period, distance "
                "and time of day begin again where `when` changes, else they go on")
            .needs(Role::Engineer)
            .param(schemaField("id"))
            .param(Field::schema("when", "What fires it", memberSchema("when")))
            .param(schemaField("actions"))
            .param(Field::boolean("armed", "Whether it fires by itself").byDefault(true))
            .returns(triggerSchema())
            .example({{"id", "tick"}, {"when", when}, {"actions", actions}},
                     QJsonObject{{"id", "tick"}, {"when", when}, {"actions", actions}, {"armed", true}})
            .handler([this](const Call &call) { return define(call.params); }));
    addCommand(Command("trigger.remove", "Removes a trigger")
                   .needs(Role::Engineer)
                   .param(idField())
                   .answers([this](const Call &call) { return remove(call.text("id")); }));
    addCommand(Command("trigger.arm", "Lets a trigger fire by itself; its period or distance begins now")
                   .param(idField())
                   .answers([this](const Call &call) { return setArmed(call.text("id"), true); }));
    addCommand(Command("trigger.disarm", "It fires no more, until it is armed; definition and counts stay")
                   .param(idField())
                   .answers([this](const Call &call) { return setArmed(call.text("id"), false); }));
    addCommand(Command("trigger.fire", "Fires an armed trigger now, and gives the firing, as in the topic "
                                       "fired, when its last action has ended")
                   .param(idField())
                   .gives<FiringMessage>()
                   .asyncHandler([this](const Call &call, const Reply &reply) { fireNow(call, reply); }));
}

Result<QJsonValue> SoftwareTrigger::list() {
    std::map<QString, TriggerState> states;
    inEngine([&](TriggerEngine &engine) { states = engine.state(); });
    QJsonArray result;
    for (const QJsonValue &definition : settings().value("triggers").toArray())
        result.append(merged(definition.toObject(), asJson(states[definition["id"].toString()]).toObject()));
    return QJsonValue(result);
}

Result<int> SoftwareTrigger::indexOf(const QString &id) {
    const QJsonArray triggers = settings().value("triggers").toArray();
    QStringList known;
    for (int i = 0; i < triggers.size(); ++i) {
        known.append(triggers.at(i)["id"].toString());
        if (known.last() == id)
            return i;
    }
    const SchemaViolation unknown{
        "id", id, known.isEmpty() ? QString("a trigger; there is none") : "one of " + known.join(", ")};
    return invalidParams({unknown});
}

// edited: the element that a command changed; what is wrong with it is told by its own path.
Result<void> SoftwareTrigger::replaceTriggers(const QJsonArray &triggers, int edited) {
    const auto changed = settings().set({{"triggers", triggers}});
    if (changed)
        return {};
    const QString prefix = QString("triggers.%1.").arg(edited);
    QJsonArray errors;
    for (const QJsonValue &error : changed.error().data["errors"].toArray()) {
        QJsonObject one = error.toObject();
        const QString path = one.value("path").toString();
        if (path.startsWith(prefix))
            one.insert("path", path.mid(prefix.size()));
        errors.append(one);
    }
    return Error(ErrorCode::InvalidParams,
                 "invalid params: " + QString(changed.error().message).replace(prefix, ""),
                 QJsonObject{{"errors", errors}});
}

Result<QJsonValue> SoftwareTrigger::define(const QJsonObject &trigger) {
    QJsonArray triggers = settings().value("triggers").toArray();
    const auto old = indexOf(trigger.value("id").toString());
    const int index = old ? *old : triggers.size();
    if (old)
        triggers.replace(index, trigger);
    else
        triggers.append(trigger);
    const auto replaced = replaceTriggers(triggers, index);
    return replaced ? Result<QJsonValue>(QJsonValue(trigger)) : replaced.error();
}

Result<void> SoftwareTrigger::remove(const QString &id) {
    const auto index = indexOf(id);
    if (!index)
        return index.error();
    QJsonArray triggers = settings().value("triggers").toArray();
    triggers.removeAt(*index);
    return replaceTriggers(triggers, *index);
}

Result<void> SoftwareTrigger::setArmed(const QString &id, bool armed) {
    const auto index = indexOf(id);
    if (!index)
        return index.error();
    QJsonArray triggers = settings().value("triggers").toArray();
    QJsonObject trigger = triggers.at(*index).toObject();
    trigger.insert("armed", armed);
    triggers.replace(*index, trigger);
    return replaceTriggers(triggers, *index);
}

void SoftwareTrigger::fireNow(const Call &call, const Reply &reply) {
    const auto known = indexOf(call.text("id"));
    if (!known)
        return reply.error(known.error());
    Result<void> begun;
    inEngine([&](TriggerEngine &engine) {
        begun = engine.fireNow(call.text("id"), call.clientName,
                               [reply](const FiringMessage &firing) { reply.result(asJson(firing)); });
    });
    if (!begun)
        reply.error(begun.error());
}

} // namespace hermes::softwaretrigger
