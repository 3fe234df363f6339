#include "gui/desktop/widgets/WheelGuard.h"

#include <QAbstractSpinBox>
#include <QApplication>
#include <QComboBox>
#include <QEvent>
#include <QSlider>

namespace hermes::desktop {

WheelGuard::WheelGuard(QWidget &window)
    : QObject(&window) {
    qApp->installEventFilter(this);
}

bool WheelGuard::eventFilter(QObject *watched, QEvent *event) {
    if (event->type() != QEvent::Wheel)
        return false;
    const bool isValue = qobject_cast<QComboBox *>(watched) || qobject_cast<QAbstractSpinBox *>(watched) ||
                         qobject_cast<QSlider *>(watched);
    if (isValue)
        event->ignore(); // so its parent gets it
    return isValue;
}

} // namespace hermes::desktop
