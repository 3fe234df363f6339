#pragma once

#include "gui/desktop/widgets/ValueEditor.h"

#include <QJsonObject>
#include <QString>

namespace hermes::desktop {

// The words for one value of a JSON Schema: its title, unit, limits, what it is for.

constexpr int longestTitle = 60, longestUnit = 20, longestNote = 160;

/// Of a form or table of values.
enum FieldColumn {
    TitleColumn,
    EditorColumn,
    UnitColumn,
    NoteColumn,
    DescriptionColumn,
    RemoveColumn = DescriptionColumn
};

/// The title, or words made of the path: "safety.command_timeout_s" in "s" reads "command timeout".
QString titleOf(const QString &path, const QJsonObject &schema);
/// "m/s²" of "m/s^2"; short.
QString shownUnit(const QJsonObject &schema);
/// "0.1 to 5"; sizes as "1.0 KiB to 64.0 MiB"; empty: any.
QString limitsOf(const QJsonObject &schema);
/// For a tool tip: description, path, what is expected, default.
QString explanation(const QString &path, const QJsonObject &schema);

/// What is wrong at the path or below it, in words; empty: nothing.
QString faultText(const Faults &faults, const QString &path, const QJsonObject &schema);

/// With ten digits at most, without a power of ten where that is short: "0.25", "1073741824".
QString numberText(double value);
/// The same amount as a person says it: "6.3 GiB", "3 min 20 s"; empty: the number says it already.
QString spokenAmount(double value, const QString &unit);

/// As JSON in one line; undefined: empty.
QString jsonText(const QJsonValue &value);
/// Undefined: it is no JSON.
QJsonValue fromJson(const QString &text);
/// A whole number in this JSON has more digits than a number keeps on its way.
bool losesDigits(const QString &json);
/// Of a password or the like, which nobody is to read over a shoulder.
bool isSecret(const QJsonObject &schema);
/// A value in a few words, for a row that is folded up.
QString summaryOf(const QJsonValue &value);
/// Counts the values in it, no further than most.
int countValues(const QJsonValue &value, int most);

} // namespace hermes::desktop
