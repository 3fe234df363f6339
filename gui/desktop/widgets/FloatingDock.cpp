#include "gui/desktop/widgets/FloatingDock.h"

#include "gui/desktop/widgets/FocusInSight.h"

#include <QScreen>
#include <algorithm>

namespace hermes::desktop {

FloatingDock::FloatingDock(const QString &title, QWidget *parent)
    : QDockWidget(title, parent) {
    connect(this, &QDockWidget::topLevelChanged, this, &FloatingDock::moveOff);
}

void FloatingDock::moveOff(bool isFloating) {
    const bool isDragged = windowFlags() & Qt::X11BypassWindowManagerHint; // it is where the mouse has it
    if (!isFloating || isRestoring_ || isDragged)
        return;
    const QRect room = screen()->availableGeometry();
    const QPoint wanted = place_.value_or(pos() + QPoint(step, -step));
    move(std::clamp(wanted.x(), room.left(), std::max(room.left(), room.right() - width())),
         std::clamp(wanted.y(), room.top(), std::max(room.top(), room.bottom() - height())));
    place_ = pos();
    comeForward();
}

bool FloatingDock::focusNextPrevChild(bool isNext) {
    return isWindow() ? FocusInSight::move(*this, isNext) : QDockWidget::focusNextPrevChild(isNext);
}

void FloatingDock::comeForward() {
    if (isFloating() && isVisible())
        raise();
}

} // namespace hermes::desktop
