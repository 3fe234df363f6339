#include "gui/desktop/widgets/PlainLabel.h"

#include <QHelpEvent>
#include <QPainter>
#include <QStyle>
#include <QToolTip>
#include <algorithm>

namespace hermes::desktop {

PlainLabel::PlainLabel(const QString &text, QWidget *parent)
    : QLabel(parent) {
    setTextFormat(Qt::PlainText);
    setText(text);
}

void PlainLabel::setText(const QString &text) {
    QLabel::setText(shortText(text));
    if (room_ > 1)
        setMinimumWidth(std::min(room_, sizeHint().width()));
}

void PlainLabel::setBold(bool isBold) {
    QFont changed = font();
    changed.setBold(isBold);
    setFont(changed);
}

void PlainLabel::letWrap() {
    setWordWrap(true);
    setMinimumWidth(1);
}

void PlainLabel::letElide(Qt::TextElideMode mode) {
    mode_ = mode;
    setMinimumWidth(1);
}

void PlainLabel::keepRoom(int most) {
    letElide();
    room_ = most;
}

QString PlainLabel::shownText() const {
    return fontMetrics().elidedText(text(), mode_, contentsRect().width() - 2 * margin());
}

bool PlainLabel::event(QEvent *event) {
    if (event->type() != QEvent::ToolTip || !isElided())
        return QLabel::event(event);
    const QString below = toolTip().isEmpty() ? QString() : '\n' + toolTip();
    QToolTip::showText(static_cast<QHelpEvent *>(event)->globalPos(), toolTipOf(text() + below), this);
    return true;
}

void PlainLabel::paintEvent(QPaintEvent *event) {
    if (!isElided())
        return QLabel::paintEvent(event);
    QFrame::paintEvent(event);
    QPainter painter(this);
    const QRect room = contentsRect().adjusted(margin(), margin(), -margin(), -margin());
    style()->drawItemText(&painter, room, int(alignment()), palette(), isEnabled(), shownText(),
                          foregroundRole());
}

} // namespace hermes::desktop
