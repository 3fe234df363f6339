#include "gui/desktop/widgets/FocusInSight.h"

#include "gui/desktop/widgets/Seen.h"

#include <QApplication>
#include <QEvent>

namespace hermes::desktop {
namespace {

/// Or can be scrolled to, or is about to be shown: from what is hidden Qt takes the focus itself.
bool isInReach(const QWidget &widget) {
    if (!widget.isVisible() || isSeen(widget, true))
        return true;
    QCoreApplication::sendPostedEvents(nullptr, QEvent::LayoutRequest); // it may only now get its place
    return isSeen(widget, true);
}

} // namespace

FocusInSight::FocusInSight(QWidget &fallback)
    : QObject(&fallback)
    , fallback_(fallback) {
    qApp->installEventFilter(this);
}

bool FocusInSight::eventFilter(QObject *watched, QEvent *event) {
    const auto *const widget = qobject_cast<QWidget *>(watched);
    if (event->type() == QEvent::Shortcut)
        return widget && !widget->isWindow() && !isInReach(*widget);
    if (event->type() != QEvent::KeyPress || !widget || widget != QApplication::focusWidget() ||
        widget == &fallback_ || fallback_.isAncestorOf(widget) || isInReach(*widget))
        return false;
    fallback_.setFocus();
    return true;
}

bool FocusInSight::move(const QWidget &window, bool isNext) {
    const auto follow = [isNext](const QWidget *widget) {
        return isNext ? widget->nextInFocusChain() : widget->previousInFocusChain();
    };
    const QWidget *const first = window.focusWidget() ? window.focusWidget() : &window;
    for (QWidget *next = follow(first); next != first; next = follow(next))
        if ((next->focusPolicy() & Qt::TabFocus) == Qt::TabFocus && next->window() == &window &&
            next->isEnabled() && !next->focusProxy() && isSeen(*next, true)) {
            next->setFocus(isNext ? Qt::TabFocusReason : Qt::BacktabFocusReason);
            for (QWidget *outer = next->parentWidget(); outer; outer = outer->parentWidget())
                if (auto *const area = qobject_cast<QScrollArea *>(outer))
                    area->ensureWidgetVisible(next);
            return true;
        }
    return false;
}

} // namespace hermes::desktop
