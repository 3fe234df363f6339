#pragma once

#include <QJsonObject>
#include <QString>

namespace hermes {

/// What a schema expects, in words: "a number from 0 to 5 in m/s", "one of \"live\", \"file\"".
QString expectation(const QJsonObject &schema);

/// A value as it is shown in messages: compact JSON, cut where it is long.
QString shown(const QJsonValue &value);

} // namespace hermes
