#pragma once

#include "protocol/wire/WireValue.h"

#include <QJsonObject>
#include <QString>
#include <QStringList>
#include <tuple>

namespace hermes::desktop {

/// One number in the messages of a topic, e.g. {"127.0.0.1:7410", "odometry", "pose.x"}.
struct FieldId {
    QString address, topic, path;

    bool operator<(const FieldId &other) const {
        return std::tie(address, topic, path) < std::tie(other.address, other.topic, other.path);
    }
    bool operator==(const FieldId &other) const {
        return std::tie(address, topic, path) == std::tie(other.address, other.topic, other.path);
    }
};

/// What a daemon's description says of a topic: {"name", "schema", "snapshot"}; empty: nothing.
QJsonObject topicDescription(const QJsonObject &description, const QString &topic);
/// The schema of a part of what a schema describes; empty where it says nothing.
QJsonObject schemaAt(QJsonObject schema, const QString &path);
/// The unit of the numbers there, as people write it ("m/s", "°C"); empty: none.
QString unitAt(const QJsonObject &schema, const QString &path);
/// The unit of what this schema describes.
QString unitOf(const QJsonObject &schema);
/// Its messages may hold long lists of numbers or objects.
bool isHeavy(const QJsonObject &schema);

/// The dotted paths of the numbers in a message, those in short lists too ("current_a.0"), by name; no more
/// than so many.
QStringList numericPaths(WireView message, int most);
/// The same of all messages that fit a schema: lists of which the length is not known are left out, or taken
/// to have one element.
enum class UnknownLists { None, One };
QStringList numericPaths(const QJsonObject &schema, int most, UnknownLists lists);
/// The value at such a path; undefined where there is none.
WireView messageValueAt(WireView message, const QString &path);

} // namespace hermes::desktop
