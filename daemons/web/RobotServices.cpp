// What web clients may ask of the robot: its commands as services, its settings as parameters.
#include "common/settings/DottedPath.h"
#include "daemons/web/PlainJson.h"
#include "daemons/web/RobotView.h"
#include "protocol/wire/JsonText.h"

#include <algorithm>
#include <cmath>

namespace hermes::web {
namespace {

/// Of the connection, which web clients share, or of who drives: that is done by a teleop panel.
bool isOfConnection(const QString &method, const QJsonObject &told) {
    return method == "rpc.discover" || method.startsWith("topics.") || method.startsWith("control.") ||
           told["x-needs-lease"].toBool();
}

QJsonObject typeOf(const QString &name, const QJsonObject &schema) {
    return {{"encoding", "json"},
            {"schemaName", name},
            {"schemaEncoding", "jsonschema"},
            {"schema", QString::fromUtf8(compactJson(schema))}};
}

QJsonObject answerSchema(const QJsonObject &result) {
    const QJsonObject properties =
        plainSchema({{"type", "object"}, {"properties", QJsonObject{{"result", result}}}})["properties"]
            .toObject();
    QJsonObject all{{"ok", QJsonObject{{"type", "boolean"}}},
                    {"error", QJsonObject{{"type", "string"}}},
                    {"code", QJsonObject{{"type", "integer"}}}};
    return {{"type", "object"}, {"properties", merged(all, properties)}};
}

QJsonObject parameterJson(const QString &name, const QJsonValue &value) {
    QJsonObject told{{"name", name}, {"value", value}};
    const QJsonArray list = value.toArray();
    const bool isNumbers =
        !list.isEmpty() &&
        std::all_of(list.begin(), list.end(), [](const QJsonValue &one) { return one.isDouble(); });
    if (value.isDouble() || isNumbers)
        told["type"] = isNumbers ? "float64_array" : "float64";
    return told;
}

} // namespace

void RobotView::addService(RobotDaemons::Daemon *daemon, const QJsonObject &method) {
    Service service;
    service.daemon = daemon->name;
    service.method = method["name"].toString();
    if (isOfConnection(service.method, method))
        return;
    service.role = roleFrom(method["x-role"].toString()).value_or(Role::Engineer);
    service.isUrgent = method["x-urgent"].toBool();
    QJsonObject properties;
    for (const QJsonValue &param : method["params"].toArray()) {
        const QString name = param["name"].toString();
        properties[name] = param["schema"];
        service.takesClient = service.takesClient || name == "client";
        service.takesConfirm = service.takesConfirm || name == "confirm";
        if (param["schema"]["x-role"].isString())
            service.restricted[name] = param["schema"]["x-role"];
    }
    const QString name = daemon->name + '/' + service.method;
    service.told = {
        {"name", name},
        {"type", name},
        {"request", typeOf(name + " request", plainSchema({{"type", "object"}, {"properties", properties}}))},
        {"response", typeOf(name + " response", answerSchema(method["result"]["schema"].toObject()))}};
    service.id = idOf(service.told);
    service.told["id"] = double(service.id);
    services_[service.id] = service;
}

QJsonArray RobotView::services(Role role) const {
    QJsonArray all;
    for (const auto &[id, service] : services_)
        if (role >= service.role)
            all.append(service.told);
    return all;
}

const Service *RobotView::service(quint32 id) const {
    const auto found = services_.find(id);
    return found == services_.end() ? nullptr : &found->second;
}

void RobotView::call(const Service &service, const QJsonObject &params, const Client::Callback &done) {
    RobotDaemons::Daemon *const daemon = daemons_.find(service.daemon);
    if (!daemon)
        return done(Error(ErrorCode::Disconnected, service.daemon + " does not answer"));
    daemon->client->call(service.method, params, done, std::chrono::seconds(30),
                         service.isUrgent ? Client::Repeats::AtOnce : Client::Repeats::Usual);
}

QString RobotView::motors() const {
    for (const auto &[address, daemon] : daemons_.all())
        if (daemon->isKnown && daemon->commands.contains("motor.drive"))
            return address;
    return {};
}

void RobotView::takeSettings(RobotDaemons::Daemon *daemon, const QJsonObject &values) {
    frames_.robot().takeSettings(daemon->name, values);
    QStringList changed;
    for (const QString &path : leafPaths(values)) {
        const QString name = daemon->name + '.' + path;
        const QJsonValue value = valueAt(values, path);
        if (!value.isNull() && parameters_.value(name) != value) {
            parameters_[name] = value;
            changed.append(name);
        }
    }
    if (!changed.isEmpty())
        Q_EMIT parametersChanged(changed);
}

QJsonArray RobotView::parameters(const QStringList &names) const {
    QJsonArray all;
    for (const QString &name : names.isEmpty() ? QStringList(parameters_.keys()) : names)
        if (parameters_.contains(name))
            all.append(parameterJson(name, parameters_[name]));
    return all;
}

/// What is in force now; the topic may tell it later.
void RobotView::readSettings(const QString &name, const std::function<void()> &done) {
    RobotDaemons::Daemon *const daemon = daemons_.find(name);
    if (!daemon)
        return done();
    daemon->client->call("settings.get", QJsonObject(), [this, name, done](const Result<QJsonValue> &values) {
        RobotDaemons::Daemon *const answering = daemons_.find(name);
        if (values && answering)
            takeSettings(answering, values->toObject());
        done();
    });
}

void RobotView::setParameters(const QJsonArray &parameters,
                              const std::function<void(const QString &)> &done) {
    const auto refusals = std::make_shared<QStringList>();
    const auto waiting = std::make_shared<int>(1);
    const auto end = [refusals, waiting, done] {
        if (--*waiting == 0)
            done(refusals->join("; "));
    };
    for (const QJsonValue &parameter : parameters) {
        const QString name = parameter["name"].toString();
        RobotDaemons::Daemon *daemon = nullptr;
        for (const auto &entry : daemons_.all())
            if (entry.second->isKnown && name.startsWith(entry.second->name + '.'))
                daemon = entry.second.get();
        if (!daemon || !parameters_.contains(name)) {
            refusals->append(name.left(100) + " is no setting");
            continue;
        }
        const QString path = name.mid(daemon->name.size() + 1);
        const QJsonValue value = parameter["value"];
        ++*waiting;
        const auto changed = [this, end, refusals, name,
                              daemonName = daemon->name](const Result<QJsonValue> &result) {
            if (!result)
                refusals->append(name + ": " + result.error().message);
            readSettings(daemonName, end);
        };
        if (value.isUndefined())
            daemon->client->call("settings.reset", QJsonObject{{"paths", QJsonArray{path}}}, changed);
        else
            daemon->client->call("settings.set", QJsonObject{{"values", withValueAt({}, path, value)}},
                                 changed);
    }
    end();
}

} // namespace hermes::web
