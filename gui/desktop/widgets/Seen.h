#pragma once

#include <QDockWidget>
#include <QScrollArea>

namespace hermes::desktop {

/// Part of it is in sight. What lies behind another tab is visible for Qt, but outside of the window.
/// scrolled: where it was scrolled out of sight counts, too.
inline bool isSeen(const QWidget &widget, bool scrolled = false) {
    QRect place = widget.rect();
    for (const QWidget *inner = &widget; !inner->isWindow() && inner->parentWidget();
         inner = inner->parentWidget()) {
        const QWidget *const outer = inner->parentWidget();
        const auto *const area = qobject_cast<const QScrollArea *>(outer->parentWidget());
        const bool isScrolled = scrolled && !place.isEmpty() && area && area->viewport() == outer;
        place = isScrolled ? outer->rect() : place.translated(inner->pos()) & outer->rect();
    }
    return widget.isVisible() && !place.isEmpty();
}

/// The dock that a widget lies in; null: in none.
inline QDockWidget *dockOf(const QWidget &widget) {
    QWidget *above = widget.parentWidget();
    while (above && !qobject_cast<QDockWidget *>(above))
        above = above->parentWidget();
    return static_cast<QDockWidget *>(above);
}

} // namespace hermes::desktop
