#pragma once

#include <QWidget>

namespace hermes::desktop {

/// Part of it is in sight. What lies behind another tab is visible for Qt, but outside of the window.
inline bool isSeen(const QWidget &widget) {
    QRect place = widget.rect();
    for (const QWidget *inner = &widget; !inner->isWindow() && inner->parentWidget();
         inner = inner->parentWidget())
        place = place.translated(inner->pos()) & inner->parentWidget()->rect();
    return widget.isVisible() && !place.isEmpty();
}

} // namespace hermes::desktop
