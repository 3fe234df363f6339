#pragma once

#include "common/schema/SchemaValidator.h"

#include <QJsonObject>
#include <QStringList>
#include <QTime>
#include <vector>

namespace hermes::softwaretrigger {

/// What fires a trigger by itself. Command: nothing does, only trigger.fire. Trigger: the firing of another.
enum class Cause { Period, Distance, Angle, TimeOfDay, Condition, Trigger, Command };

/// Their names, in that order.
const QStringList &causeKinds();

/// One thing that a firing does.
struct ActionDefinition {
    enum class Kind { Call, Serial, Pulse, Gpio };
    Kind kind = Kind::Call;
    QString daemon, method; ///< Call
    QJsonObject params;
    double timeout_s = 2;
    QString url;         ///< Serial, Pulse: serial:///dev/ttyS1?baud=9600
    QByteArray bytes;    ///< Serial
    bool dtr = false;    ///< Pulse: DTR, else RTS
    QString chip;        ///< Gpio: name or number of the chip
    int offset = 0;      ///< Gpio: the line of the chip
    double length_s = 0; ///< Pulse, Gpio

    /// For messages and the log: "call motorcontrol motor.stop".
    QString name() const;
};

/// A trigger as a person defines it.
struct TriggerDefinition {
    QString id;
    bool armed = true;
    QJsonObject when; ///< as given, with defaults: two that are equal have the same cause
    std::vector<ActionDefinition> actions;

    Cause cause() const;
    double number(const char *member) const { return when.value(QLatin1String(member)).toDouble(); }
    QString text(const char *member) const { return when.value(QLatin1String(member)).toString(); }

    /// From JSON that checkTriggers found nothing wrong with.
    static TriggerDefinition from(const QJsonObject &json);
};

/// The definitions in the array `triggers` of the settings.
std::vector<TriggerDefinition> definitions(const QJsonObject &settings);

/// The JSON Schema of one trigger. What one member demands of another is checked by checkTriggers.
QJsonObject triggerSchema();

/// What the schema cannot say of the array `triggers`: the members that each kind needs, known daemons,
/// paths, operators, bytes, ids that occur once, triggers that exist, no cycle of triggers. Paths begin with
/// "triggers.N.".
std::vector<SchemaViolation> checkTriggers(const QJsonObject &settings);

/// The time of a day from "HH:MM", "HH:MM:SS" or "HH:MM:SS.mmm"; not valid for other text.
QTime timeOfDay(const QString &text);

} // namespace hermes::softwaretrigger
