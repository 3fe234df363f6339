#include "common/settings/Settings.h"

#include "common/files/NamedFile.h"
#include "common/files/SavedFile.h"
#include "common/schema/SchemaKeys.h"
#include "common/settings/DottedPath.h"
#include "protocol/wire/JsonText.h"

#include <QJsonDocument>

namespace hermes {
namespace {

QJsonObject emptySchema() {
    return {{"type", "object"}, {"additionalProperties", false}, {propertiesKey, QJsonObject()}};
}

QJsonObject withProperty(QJsonObject schema, const QString &path, const QJsonObject &property) {
    QJsonObject properties = schema.value(propertiesKey).toObject();
    const QString key = path.section(QLatin1Char('.'), 0, 0);
    const QString rest = path.section(QLatin1Char('.'), 1);
    const QJsonObject below = properties.contains(key) ? properties.value(key).toObject() : emptySchema();
    properties.insert(key, rest.isEmpty() ? property : withProperty(below, rest, property));
    schema.insert(propertiesKey, properties);
    return schema;
}

QJsonObject propertyAt(QJsonObject schema, const QString &path) {
    for (const QString &key : path.split(QLatin1Char('.')))
        schema = schema.value(propertiesKey).toObject().value(key).toObject();
    return schema;
}

Error settingsFileError(const QString &file, const QString &what) {
    return Error(ErrorCode::InputOutput, QString("settings file %1: %2").arg(file, what),
                 QJsonObject{{"path", file}});
}

} // namespace

Settings::Settings(QObject *parent)
    : QObject(parent)
    , fullSchema_(emptySchema()) {}

void Settings::declare(const Field &field) {
    Q_ASSERT_X(!field.defaultValue().isUndefined(), "Settings::declare", qPrintable(field.name()));
    QJsonObject property = field.schema();
    const QString applies = "x-applies";
    if (!property.contains(applies))
        property.insert(applies, "now");
    fullSchema_ = withProperty(fullSchema_, field.name(), property);
    initial_ = withValueAt(initial_, field.name(), field.defaultValue());
    put(withValueAt(current_, field.name(), field.defaultValue()));
    validator_.reset();
}

QJsonObject Settings::changes() const {
    return difference(current_, initial_);
}

QJsonValue Settings::value(const QString &path) const {
    return valueAt(inForce_, path);
}

Result<QStringList> Settings::set(const QJsonObject &partial) {
    return apply(merged(current_, partial));
}

Result<QStringList> Settings::insist(const QJsonObject &partial) {
    const auto applied = set(partial);
    if (applied)
        insisted_ = merged(insisted_, partial);
    return applied;
}

Result<QStringList> Settings::reset(const QStringList &paths) {
    if (paths.isEmpty())
        return apply(initial_);
    QJsonObject proposed = current_;
    for (const QString &path : paths) {
        const QJsonValue value = valueAt(initial_, path);
        if (path.isEmpty() || value.isUndefined()) {
            const SchemaViolation unknown{path, QJsonValue::Undefined, "the path of a setting"};
            return Error(ErrorCode::InvalidSetting, QString("no setting \"%1\"").arg(path),
                         QJsonObject{{"errors", QJsonArray{unknown.toJson()}}});
        }
        proposed = withValueAt(proposed, path, value);
    }
    return apply(proposed);
}

bool Settings::suitsSchema(const QJsonObject &partial) const {
    return checkSchema(merged(current_, partial)).empty();
}

std::vector<SchemaViolation> Settings::checkSchema(const QJsonObject &proposed) const {
    if (!validator_)
        validator_.emplace(fullSchema_);
    return validator_->check(proposed);
}

std::vector<SchemaViolation> Settings::check(const QJsonObject &proposed) const {
    auto violations = checkSchema(proposed);
    if (violations.empty()) {
        for (const Rule &rule : rules_) {
            for (const SchemaViolation &violation : rule(proposed))
                violations.push_back(violation);
        }
    }
    return violations;
}

Result<QStringList> Settings::apply(const QJsonObject &proposed) {
    const auto violations = check(proposed);
    if (!violations.empty()) {
        return Error(ErrorCode::InvalidSetting, toString(violations),
                     QJsonObject{{"errors", toJson(violations)}});
    }
    return take(proposed);
}

QStringList Settings::take(const QJsonObject &values) {
    const QStringList paths = leafPaths(difference(values, current_));
    put(values);
    if (!paths.isEmpty())
        Q_EMIT changed(paths);
    return paths;
}

void Settings::put(const QJsonObject &values) {
    QJsonObject next = values;
    if (begun_)
        for (const QString &path : needRestart(leafPaths(values)))
            next = withValueAt(next, path, valueAt(inForce_, path));
    current_ = values;
    inForce_ = next;
}

void Settings::begin() {
    begun_ = true;
}

void Settings::takeWaiting(const QStringList &butFor) {
    for (const QString &path : waiting())
        if (!butFor.contains(path))
            inForce_ = withValueAt(inForce_, path, valueAt(current_, path));
}

QStringList Settings::waiting() const {
    return leafPaths(difference(current_, inForce_));
}

Result<QByteArray> readSettingsFile(const QString &name) {
    auto text = readNamedFile(name, {"/"}, maxSettingsBytes);
    if (!text)
        return Error(ErrorCode::InputOutput, "settings file " + text.error().message, text.error().data);
    if (text->startsWith("\xff\xfe") || text->startsWith("\xfe\xff"))
        return settingsFileError(name, "line 1: found UTF-16, expected UTF-8");
    if (text->startsWith("\xef\xbb\xbf")) // as some editors write it
        text->remove(0, 3);
    return text;
}

Result<void> checkSettingsFile(const QString &name, const QByteArray &text) {
    if (text.size() > maxSettingsBytes)
        return settingsFileError(
            name,
            QString("it would have %1 bytes, expected at most %2").arg(text.size()).arg(maxSettingsBytes));
    const auto replaceable = checkReplaceable(name);
    if (replaceable)
        return {};
    return Error(ErrorCode::InputOutput, "settings file " + replaceable.error().message,
                 replaceable.error().data);
}

Result<QJsonObject> Settings::read(const QString &name) const {
    const auto text = readSettingsFile(name);
    if (!text)
        return text.error();
    WireError error;
    const auto value = parseJson(*text, &error);
    if (!value)
        return settingsFileError(name, QString("line %1: %2").arg(error.line).arg(error.message));
    if (!value->isObject())
        return settingsFileError(name, "line 1: expected a JSON object");
    const QJsonObject proposed = merged(merged(initial_, value->toObject()), insisted_);
    const auto violations = check(proposed);
    if (!violations.empty())
        return Error(ErrorCode::InvalidSetting,
                     QString("settings file %1: %2").arg(name, toString(violations)),
                     QJsonObject{{"errors", toJson(violations)}});
    return proposed;
}

Result<void> Settings::load(const QString &name) {
    const auto proposed = read(name);
    if (!proposed)
        return proposed.error();
    take(*proposed);
    fileName_ = name;
    return {};
}

Result<QString> Settings::save(const QString &name) const {
    const QString target = name.isEmpty() ? fileName_ : name;
    if (target.isEmpty())
        return Error(ErrorCode::InputOutput, "no settings file to save to: start with --config FILE");
    const QByteArray text = QJsonDocument(changes()).toJson();
    if (const auto fine = checkSettingsFile(target, text); !fine)
        return fine.error();
    if (const auto saved = saveFile(target, text); !saved)
        return saved.error();
    return target;
}

QStringList Settings::needRestart(const QStringList &paths) const {
    QStringList result;
    for (const QString &path : paths) {
        if (propertyAt(fullSchema_, path).value("x-applies") == "restart")
            result.append(path);
    }
    return result;
}

} // namespace hermes
