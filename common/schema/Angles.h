#pragma once

#include <QJsonObject>
#include <QStringList>

namespace hermes {

/// Of each angle (unit rad) in a value that is beyond a full turn a text, of a few at most: "theta: 90 rad is
/// 14.3 turns; did you mean 1.571 rad (90 degrees)?". Such a value is no error.
QStringList beyondTurn(const QJsonObject &schema, const QJsonValue &value, const QString &path = QString());

/// The value, with the radians of each text as "90deg" that stands for an angle (unit rad).
QJsonValue withAnglesRead(const QJsonObject &schema, const QJsonValue &value);

/// Whether a value holds such a text, whatever it stands for.
bool holdsAngleText(const QJsonValue &value);

/// Whether a value holds a number of such a size, whatever it stands for.
bool holdsBeyondTurn(const QJsonValue &value);

} // namespace hermes
