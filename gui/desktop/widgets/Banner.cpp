#include "gui/desktop/widgets/Banner.h"

namespace hermes::desktop {

Banner::Banner(QWidget *parent)
    : PlainLabel({}, parent) {
    letWrap();
    setMargin(8);
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

// A tool bar asks nobody how high text of its width becomes. Before it is shown it has some width, in which a
// text may be so high that the window grows beyond its screen.
void Banner::fitHeight() {
    const int across = isVisible() ? width() : window()->width();
    const QRect room(0, 0, across - 2 * margin(), 1000);
    const int height = fontMetrics().boundingRect(room, Qt::TextWordWrap, text()).height() + 2 * margin();
    if (height != maximumHeight() && !text().isEmpty())
        setFixedHeight(height);
}

void Banner::resizeEvent(QResizeEvent *event) {
    PlainLabel::resizeEvent(event);
    fitHeight();
}

} // namespace hermes::desktop
