#pragma once

#include "gui/desktop/model/DaemonLink.h"

#include <QColor>
#include <QFont>
#include <QIcon>
#include <QPalette>
#include <optional>

namespace hermes::desktop {

/// Colours and icons of the operator's program. Each colour has one meaning, and never stands alone.
namespace theme {

/// Light or dark: as the desktop's own palette is, unless the environment's HERMES_THEME says "light" or
/// "dark".
void apply();
bool isDark();

QColor colour(Condition condition);
/// What is written on a widget has the colour of a condition; nothing: that of its palette.
void tint(QWidget &widget, QPalette::ColorRole role, std::optional<Condition> condition);
inline std::optional<Condition> faultIf(bool isFault) {
    return isFault ? std::optional(Condition::Fault) : std::nullopt;
}
/// This share of the way from one colour to another.
QColor mixed(const QColor &from, const QColor &to, double share);
/// For text in columns.
QFont fixedFont();
/// An icon of its own shape for each condition, in its colour.
QIcon icon(Condition condition);
/// An icon of icons.qrc in the colour of the text.
QIcon icon(const QString &name);

} // namespace theme
} // namespace hermes::desktop
