#include "common/settings/DottedPath.h"

#include <QStringList>

namespace hermes {

QJsonValue valueAt(const QJsonObject &object, const QString &path) {
    QJsonValue value = object;
    if (path.isEmpty())
        return value;
    for (const QString &key : path.split(QLatin1Char('.')))
        value = value.toObject().value(key);
    return value;
}

QJsonObject withValueAt(const QJsonObject &object, const QString &path, const QJsonValue &value) {
    const QString key = path.section(QLatin1Char('.'), 0, 0);
    const QString rest = path.section(QLatin1Char('.'), 1);
    QJsonObject result = object;
    result.insert(key, rest.isEmpty() ? value : withValueAt(object.value(key).toObject(), rest, value));
    return result;
}

QJsonObject merged(const QJsonObject &base, const QJsonObject &changes) {
    QJsonObject result = base;
    for (auto member = changes.begin(); member != changes.end(); ++member) {
        const QJsonValue old = base.value(member.key());
        const bool both = old.isObject() && member.value().isObject();
        result.insert(member.key(),
                      both ? merged(old.toObject(), member.value().toObject()) : member.value());
    }
    return result;
}

QJsonObject difference(const QJsonObject &object, const QJsonObject &base) {
    QJsonObject result;
    for (auto member = object.begin(); member != object.end(); ++member) {
        const QJsonValue other = base.value(member.key());
        if (member.value() == other)
            continue;
        const bool both = member.value().isObject() && other.isObject();
        result.insert(member.key(),
                      both ? difference(member.value().toObject(), other.toObject()) : member.value());
    }
    return result;
}

QStringList leafPaths(const QJsonObject &object, const QString &prefix) {
    QStringList paths;
    for (auto member = object.begin(); member != object.end(); ++member) {
        const QString path = prefix.isEmpty() ? member.key() : prefix + QLatin1Char('.') + member.key();
        if (member.value().isObject() && !member.value().toObject().isEmpty())
            paths += leafPaths(member.value().toObject(), path);
        else
            paths.append(path);
    }
    return paths;
}

} // namespace hermes
