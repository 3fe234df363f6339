#include "gui/desktop/widgets/Banner.h"

namespace hermes::desktop {

Banner::Banner(QWidget *parent)
    : PlainLabel({}, parent) {
    setWordWrap(true);
    setMargin(8);
    setMinimumWidth(1);
    setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Preferred);
    setBold(true);
}

void Banner::tell(const QString &text, const QString &style) {
    setText(text);
    fitHeight();
    if (style != styleSheet())
        setStyleSheet(style);
    Q_EMIT shown(!text.isEmpty());
}

// A tool bar asks nobody how high text of its width becomes.
void Banner::fitHeight() {
    const QRect room(0, 0, width() - 2 * margin(), 1000);
    const int height = fontMetrics().boundingRect(room, Qt::TextWordWrap, text()).height() + 2 * margin();
    if (height != maximumHeight() && !text().isEmpty())
        setFixedHeight(height);
}

void Banner::resizeEvent(QResizeEvent *event) {
    PlainLabel::resizeEvent(event);
    fitHeight();
}

} // namespace hermes::desktop
