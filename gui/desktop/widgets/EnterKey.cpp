#include "gui/desktop/widgets/EnterKey.h"

#include <QAbstractButton>
#include <QAbstractItemView>
#include <QApplication>
#include <QKeyEvent>

namespace hermes::desktop {
namespace {

bool tick(QAbstractItemView &view) {
    const QModelIndex item = view.currentIndex();
    if (!(item.flags() & Qt::ItemIsUserCheckable) || !item.data(Qt::CheckStateRole).isValid())
        return false;
    const bool isTicked = item.data(Qt::CheckStateRole).toInt() == Qt::Checked;
    return view.model()->setData(item, isTicked ? Qt::Unchecked : Qt::Checked, Qt::CheckStateRole);
}

} // namespace

EnterKey::EnterKey(const TypingWatch &typing, QWidget &window)
    : QObject(&window)
    , typing_(typing)
    , window_(window) {
    qApp->installEventFilter(this);
}

bool EnterKey::eventFilter(QObject *watched, QEvent *event) {
    if (event->type() != QEvent::KeyPress)
        return false;
    const int key = static_cast<QKeyEvent *>(event)->key();
    auto *const widget = qobject_cast<QWidget *>(watched);
    if ((key != Qt::Key_Return && key != Qt::Key_Enter) || !widget || widget->window() != &window_)
        return false;
    if (typing_.isCutOff())
        return true;
    if (auto *const button = qobject_cast<QAbstractButton *>(widget)) {
        button->click();
        return true;
    }
    auto *const view = qobject_cast<QAbstractItemView *>(widget);
    return view && tick(*view);
}

} // namespace hermes::desktop
