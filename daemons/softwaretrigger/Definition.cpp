#include "daemons/softwaretrigger/Definition.h"
#include "protocol/wire/FieldTable.h"

#include <QJsonArray>
#include <algorithm>
#include <iterator>

namespace hermes::softwaretrigger {
namespace {

constexpr double shortestPeriod_s = 0.001, longestPeriod_s = 7 * 86400.0;

// In the order of ActionDefinition::Kind.
const QStringList actionKinds{"call", "serial", "pulse", "gpio"};

QJsonObject text(const char *description) {
    return {{"type", "string"}, {"description", description}, {"minLength", 1}, {"maxLength", 4096}};
}

QJsonObject choice(const char *description, const QStringList &values) {
    return {{"type", "string"}, {"description", description}, {"enum", QJsonArray::fromStringList(values)}};
}

QJsonObject number(const char *description, const char *unit, double least, double most) {
    return {{"type", "number"},
            {"description", description},
            {"unit", unit},
            {"minimum", least},
            {"maximum", most}};
}

QJsonObject whenSchema() {
    return objectSchema(
        {{"kind", choice("What fires it", causeKinds())},
         {"period_s", number("period: firing n is n periods after the trigger was armed", "s",
                             shortestPeriod_s, longestPeriod_s)},
         {"distance_m", number("distance: metres between two firings", "m", 0.001, 1e6)},
         {"angle_rad",
          number("angle: the turn, left and right added up, between two firings", "rad", 0.001, 1e6)},
         {"at", text("time_of_day: HH:MM, HH:MM:SS or HH:MM:SS.mmm")},
         {"zone", choice("time_of_day: local (the default) or UTC", {"local", "utc"})},
         {"daemon", text("condition: whose topic, by name, HOST:PORT or URL; distance and angle: whose "
                         "odometry (motorcontrol)")},
         {"topic", text("condition: the topic; distance and angle: the odometry (odometry)")},
         {"path", QJsonObject{{"type", "string"},
                              {"description", "condition: dotted path in the data, with numbers for elements "
                                              "of arrays; empty: the data"},
                              {"maxLength", 4096}}},
         {"op", choice("condition: value in the topic OP value", {"<", "<=", "==", "!=", ">=", ">"})},
         {"value", QJsonObject{{"type", QJsonArray{"number", "string", "boolean", "null"}},
                               {"description", "condition: fires when it becomes true"}}},
         {"trigger", text("trigger: id of the one whose firing fires this one")}},
        {"kind"});
}

QJsonObject actionSchema() {
    return objectSchema(
        {{"do",
          choice("call a command of a daemon, write bytes to a serial line, pulse RTS or DTR of one, or "
                 "pulse a GPIO line",
                 actionKinds)},
         {"daemon", text("call: name, HOST:PORT or URL")},
         {"method", text("call: the command")},
         {"params", QJsonObject{{"type", "object"},
                                {"description", "call: its parameters by name"},
                                {"additionalProperties", true},
                                {"x-open", true}}},
         {"timeout_s", number("call: without a reply so long it has failed (2)", "s", 0.01, 60)},
         {"url", text("serial, pulse: serial:///dev/ttyS1?baud=9600")},
         {"text", text("serial: what to write, as UTF-8")},
         {"hex", text("serial: what to write, as hexadecimal digits")},
         {"line", choice("pulse: which line", {"rts", "dtr"})},
         {"chip", text("gpio: the chip, as gpiochip0")},
         {"offset", QJsonObject{{"type", "integer"},
                                {"description", "gpio: the line of the chip"},
                                {"minimum", 0},
                                {"maximum", 1023}}},
         {"length_s", number("pulse, gpio: how long the line is on", "s", 0.001, 60)}},
        {"do"});
}

} // namespace

const QStringList &causeKinds() {
    static const QStringList kinds{"period",    "distance", "angle",  "time_of_day",
                                   "condition", "trigger",  "command"};
    return kinds;
}

QTime timeOfDay(const QString &text) {
    for (const char *format : {"HH:mm", "HH:mm:ss", "HH:mm:ss.zzz"}) {
        const QTime time = QTime::fromString(text, format);
        if (time.isValid())
            return time;
    }
    return {};
}

QString ActionDefinition::name() const {
    switch (kind) {
    case Kind::Call:
        return "call " + daemon + " " + method;
    case Kind::Serial:
        return "serial " + url;
    case Kind::Pulse:
        return "pulse " + url + (dtr ? " dtr" : " rts");
    case Kind::Gpio:
        return QString("gpio %1 %2").arg(chip).arg(offset);
    }
    return {};
}

Cause TriggerDefinition::cause() const {
    return Cause(causeKinds().indexOf(text("kind")));
}

TriggerDefinition TriggerDefinition::from(const QJsonObject &json) {
    TriggerDefinition result;
    result.id = json.value("id").toString();
    result.armed = json.value("armed").toBool(true);
    result.when = json.value("when").toObject();
    if (result.cause() == Cause::Distance || result.cause() == Cause::Angle) {
        result.when.insert("daemon", result.when.value("daemon").toString("motorcontrol"));
        result.when.insert("topic", result.when.value("topic").toString("odometry"));
    }
    for (const QJsonValue &element : json.value("actions").toArray()) {
        const QJsonObject action = element.toObject();
        ActionDefinition one;
        one.kind = ActionDefinition::Kind(actionKinds.indexOf(action.value("do").toString()));
        one.daemon = action.value("daemon").toString();
        one.method = action.value("method").toString();
        one.params = action.value("params").toObject();
        one.timeout_s = action.value("timeout_s").toDouble(one.timeout_s);
        one.url = action.value("url").toString();
        one.bytes = action.contains("hex") ? QByteArray::fromHex(action.value("hex").toString().toLatin1())
                                           : action.value("text").toString().toUtf8();
        one.dtr = action.value("line").toString() == "dtr";
        one.chip = action.value("chip").toString();
        one.offset = action.value("offset").toInt();
        one.length_s = action.value("length_s").toDouble();
        result.actions.push_back(one);
    }
    return result;
}

std::vector<TriggerDefinition> definitions(const QJsonObject &settings) {
    const QJsonArray array = settings.value("triggers").toArray();
    std::vector<TriggerDefinition> result;
    std::transform(array.begin(), array.end(), std::back_inserter(result),
                   [](const QJsonValue &one) { return TriggerDefinition::from(one.toObject()); });
    return result;
}

QJsonObject triggerSchema() {
    const QJsonObject id{{"type", "string"},
                         {"description", "Its name: letters, digits, _ and -"},
                         {"pattern", "^[A-Za-z0-9_-]{1,64}$"}};
    const QJsonObject armed{
        {"type", "boolean"}, {"description", "Whether it fires by itself"}, {"default", true}};
    const QJsonObject actions{{"type", "array"},
                              {"description", "What a firing does, all at once"},
                              {"items", actionSchema()},
                              {"maxItems", 16}};
    return objectSchema({{"id", id}, {"armed", armed}, {"when", whenSchema()}, {"actions", actions}},
                        {"id", "when", "actions"});
}

} // namespace hermes::softwaretrigger
