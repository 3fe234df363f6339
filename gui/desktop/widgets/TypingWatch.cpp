#include "gui/desktop/widgets/TypingWatch.h"

#include "gui/desktop/widgets/Typing.h"

#include <QApplication>
#include <QKeyEvent>

namespace hermes::desktop {

TypingWatch::TypingWatch(QObject *parent)
    : QObject(parent) {
    qApp->installEventFilter(this);
    connect(qApp, &QApplication::focusChanged, this, [this](const QWidget *, const QWidget *now) {
        isCutOff_ = isCutOff_ || (isTyping_ && !isTyping(now));
        isTyping_ = false;
    });
}

bool TypingWatch::eventFilter(QObject *, QEvent *event) {
    if (event->type() == QEvent::MouseButtonPress)
        isTyping_ = isCutOff_ = false;
    if (event->type() != QEvent::KeyPress)
        return false;
    const auto *const key = static_cast<const QKeyEvent *>(event);
    const bool moves = key->key() == Qt::Key_Tab || key->key() == Qt::Key_Backtab;
    if (moves || !isCutOff())
        isCutOff_ = false;
    const bool isText = !key->text().isEmpty() && key->text()[0].isPrint();
    isTyping_ = isText && isTyping(QApplication::focusWidget());
    lastKey_.start();
    return false;
}

} // namespace hermes::desktop
