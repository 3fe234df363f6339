#include "gui/desktop/drive/StopKeys.h"

#include "gui/desktop/widgets/Typing.h"

#include <QAbstractButton>
#include <QApplication>
#include <QDialog>
#include <QKeyEvent>
#include <QMouseEvent>

namespace hermes::desktop {

StopKeys::StopKeys(DriveControl &drive, QAbstractButton &button)
    : QObject(&button)
    , drive_(drive)
    , button_(button) {
    qApp->installEventFilter(this);
}

// A key and a press of the mouse are seen twice, by the window and then by the widget in it: tests begin with
// the widget.
bool StopKeys::eventFilter(QObject *watched, QEvent *event) {
    if (!watched->isWidgetType() && !watched->isWindowType())
        return false;
    switch (event->type()) {
    case QEvent::ShortcutOverride: // else a shortcut of the same key would come first
        if (isStop(static_cast<QKeyEvent *>(event)->key()))
            event->accept();
        return false;
    case QEvent::KeyPress: {
        const auto *const key = static_cast<QKeyEvent *>(event);
        if (!isStop(key->key()))
            return false;
        if (!key->isAutoRepeat())
            stop();
        return true;
    }
    case QEvent::MouseButtonPress:
    case QEvent::MouseButtonDblClick:
        if (!QApplication::activePopupWidget() || !isOnButton(static_cast<QMouseEvent *>(event)->globalPos()))
            return false;
        stop();
        return true;
    default:
        return false;
    }
}

bool StopKeys::isStop(int key) const {
    if (key == Qt::Key_F12)
        return true;
    const bool isPopupOpen = QApplication::activePopupWidget() != nullptr;
    if (key == Qt::Key_Space)
        return drive_.isDriving() || isPopupOpen || !isTyping(QApplication::focusWidget());
    const bool closes = isPopupOpen || qobject_cast<QDialog *>(QApplication::activeWindow());
    return key == Qt::Key_Escape && (drive_.isDriving() || (doesEscapeStop_ && !closes));
}

bool StopKeys::isOnButton(const QPoint &global) const {
    const QWidget *const popup = QApplication::activePopupWidget();
    return button_.isVisible() && button_.rect().contains(button_.mapFromGlobal(global)) &&
           !popup->geometry().contains(global);
}

void StopKeys::stop() {
    drive_.stop();
    while (QWidget *const popup = QApplication::activePopupWidget())
        if (!popup->close())
            break;
}

} // namespace hermes::desktop
