#include "common/Project.h"
#include "common/client/DaemonAddress.h"
#include "common/interface/InterfaceRegistry.h"
#include "daemons/softwaretrigger/Definition.h"
#include "protocol/wire/JsonWriters.h"

#include <QHash>
#include <QJsonArray>
#include <QRegularExpression>

namespace hermes::softwaretrigger {
namespace {

using Violations = std::vector<SchemaViolation>;

struct Members {
    QStringList needed, allowed; ///< allowed: besides those needed
};

// What each kind of cause and of action has beside "kind" and "do".
const QHash<QString, Members> causeMembers{{"period", {{"period_s"}, {}}},
                                           {"distance", {{"distance_m"}, {"daemon", "topic"}}},
                                           {"angle", {{"angle_rad"}, {"daemon", "topic"}}},
                                           {"time_of_day", {{"at"}, {"zone"}}},
                                           {"condition", {{"daemon", "topic", "path", "op", "value"}, {}}},
                                           {"trigger", {{"trigger"}, {}}},
                                           {"command", {{}, {}}}};
const QHash<QString, Members> actionMembers{{"call", {{"daemon", "method"}, {"params", "timeout_s"}}},
                                            {"serial", {{"url"}, {"text", "hex"}}},
                                            {"pulse", {{"url", "line", "length_s"}, {}}},
                                            {"gpio", {{"chip", "offset", "length_s"}, {}}}};

class Checker {
public:
    explicit Checker(QString path)
        : path_(std::move(path)) {}

    void refuse(const QString &member, const QJsonValue &value, const QString &expected) {
        found.push_back({path_ + member, value, expected});
    }
    void checkTrigger(const QJsonObject &trigger);
    Violations found;

private:
    void checkMembers(const QString &base, const QJsonObject &object, const QString &tag,
                      const QHash<QString, Members> &table);
    void checkWhen(const QJsonObject &when);
    void checkAction(const QString &base, const QJsonObject &action);
    void checkDaemon(const QString &member, const QJsonValue &daemon);
    void checkSerial(const QString &base, const QJsonObject &action);

    QString path_;
};

void Checker::checkMembers(const QString &base, const QJsonObject &object, const QString &tag,
                           const QHash<QString, Members> &table) {
    const QString kind = object.value(tag).toString();
    const Members members = table.value(kind);
    for (const QString &needed : members.needed) {
        if (!object.contains(needed))
            refuse(base + needed, QJsonValue::Undefined, QString("a value: %1 %2 needs it").arg(tag, kind));
    }
    for (const QString &member : object.keys()) {
        if (member != tag && !members.needed.contains(member) && !members.allowed.contains(member))
            refuse(base + member, object.value(member),
                   QString("nothing: %1 %2 has no such member").arg(tag, kind));
    }
}

void Checker::checkTrigger(const QJsonObject &trigger) {
    JsonTextWriter writer;
    writer.json(trigger);
    if (writer.hasRefused())
        return refuse(writer.refused(), "NaN or infinite", "a finite number");
    checkWhen(trigger.value("when").toObject());
    const QJsonArray actions = trigger.value("actions").toArray();
    for (int i = 0; i < actions.size(); ++i)
        checkAction(QString("actions.%1.").arg(i), actions.at(i).toObject());
}

void Checker::checkWhen(const QJsonObject &when) {
    static const QRegularExpression dotted("^$|^[A-Za-z0-9_-]+(\\.[A-Za-z0-9_-]+)*$");
    checkMembers("when.", when, "kind", causeMembers);
    if (when.contains("daemon"))
        checkDaemon("when.daemon", when.value("daemon"));
    if (when.contains("at") && !timeOfDay(when.value("at").toString()).isValid())
        refuse("when.at", when.value("at"), "a time of day as HH:MM, HH:MM:SS or HH:MM:SS.mmm");
    if (!dotted.match(when.value("path").toString()).hasMatch())
        refuse("when.path", when.value("path"), "names and numbers separated by single dots");
    const QString op = when.value("op").toString();
    const QJsonValue value = when.value("value");
    if (!op.isEmpty() && op != "==" && op != "!=" && !value.isUndefined() && !value.isDouble())
        refuse("when.value", value, "a number, which " + op + " compares");
}

void Checker::checkAction(const QString &base, const QJsonObject &action) {
    static const QRegularExpression method("^[A-Za-z_][A-Za-z0-9_]*(\\.[A-Za-z_][A-Za-z0-9_]*)*$");
    checkMembers(base, action, "do", actionMembers);
    const QString kind = action.value("do").toString();
    if (action.contains("daemon"))
        checkDaemon(base + "daemon", action.value("daemon"));
    const QString name = action.value("method").toString();
    if (action.contains("method") && !method.match(name).hasMatch())
        refuse(base + "method", name, "the name of a command, as record.start");
    if (name == "trigger.fire" && action.value("daemon") == "softwaretrigger")
        refuse(base + "method", name,
               "another command; a trigger that fires after this one has when.trigger");
    if (kind == "serial" || kind == "pulse")
        checkSerial(base, action);
}

void Checker::checkDaemon(const QString &member, const QJsonValue &daemon) {
    const auto address = daemonAddress(daemon.toString());
    if (!address)
        return refuse(member, daemon, "one of " + daemonNames().join(", ") + ", or HOST:PORT, or a URL");
    if (const Result<void> fine = checkAddress(*address); !fine)
        refuse(member, daemon, fine.error().message);
}

void Checker::checkSerial(const QString &base, const QJsonObject &action) {
    static const QRegularExpression pairs("^([0-9A-Fa-f]{2})+$");
    const auto url = InterfaceUrl::parse(action.value("url").toString());
    if (action.contains("url") && (!url || url->scheme != "serial" || url->path.isEmpty()))
        refuse(base + "url", action.value("url"), "a serial line, as serial:///dev/ttyS1?baud=9600");
    if (action.value("do") != "serial")
        return;
    if (action.contains("text") == action.contains("hex"))
        refuse(base + "text", action.value("text"), "either text or hex");
    if (action.contains("hex") && !pairs.match(action.value("hex").toString()).hasMatch())
        refuse(base + "hex", action.value("hex"), "pairs of hexadecimal digits");
}

// Each id once, each trigger that is named exists, no way along them leads back.
Violations checkChains(const QJsonArray &triggers) {
    Violations found;
    QHash<QString, QString> follows; // id -> the id whose firing fires it
    for (int i = 0; i < triggers.size(); ++i) {
        const QString id = triggers.at(i)["id"].toString();
        if (follows.contains(id))
            found.push_back({QString("triggers.%1.id").arg(i), id, "an id that no other trigger has"});
        follows.insert(id, triggers.at(i)["when"]["trigger"].toString());
    }
    for (int i = 0; i < triggers.size(); ++i) {
        const QString path = QString("triggers.%1.when.trigger").arg(i);
        const QString first = triggers.at(i)["id"].toString(), next = follows.value(first);
        if (!next.isEmpty() && !follows.contains(next)) {
            found.push_back({path, next, "the id of a trigger"});
            continue;
        }
        QString at = next;
        for (int steps = 0; !at.isEmpty() && at != first && steps < triggers.size(); ++steps)
            at = follows.value(at);
        if (at == first && !at.isEmpty())
            found.push_back({path, next, "a trigger that " + first + " does not fire itself, by any chain"});
    }
    return found;
}

} // namespace

std::vector<SchemaViolation> checkTriggers(const QJsonObject &settings) {
    const QJsonArray triggers = settings.value("triggers").toArray();
    Violations found;
    for (int i = 0; i < triggers.size(); ++i) {
        Checker checker(QString("triggers.%1.").arg(i));
        checker.checkTrigger(triggers.at(i).toObject());
        found.insert(found.end(), checker.found.begin(), checker.found.end());
    }
    const Violations chains = checkChains(triggers);
    found.insert(found.end(), chains.begin(), chains.end());
    return found;
}

} // namespace hermes::softwaretrigger
