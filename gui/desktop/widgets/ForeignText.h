#pragma once

#include <QDateTime>
#include <QString>
#include <optional>

namespace hermes::desktop {

// What daemons say is foreign: it may be a megabyte long, hold control characters or look like HTML.

constexpr int longestName = 60; // of a recording, a topic, a mark

/// As one line without control characters, cut where it is longer than somebody reads.
QString shortLine(const QString &text, int longest = 200);
/// The same with its lines kept.
QString shortText(const QString &text, int longest = 1000);
/// A text of a button or a menu, in which "&" is no mark of a key.
QString labelText(QString text);
/// A tooltip, which Qt takes for HTML where it looks like it, with this plain text.
QString toolTipOf(const QString &text);
/// With so many decimals while that is short, else as a power of ten.
QString shortNumber(double value, int decimals);
/// What daemons tell, in words of the window: addresses without "tcp://", buttons in place of commands.
QString inPlainWords(QString text);
/// Of a stamp in seconds since the epoch; nothing where no clock of a robot can stand.
std::optional<QDateTime> timeOf(double stamp);

} // namespace hermes::desktop
