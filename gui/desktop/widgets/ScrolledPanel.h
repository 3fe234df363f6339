#pragma once

#include <QScrollArea>
#include <QScrollBar>
#include <algorithm>

namespace hermes::desktop {

/// Room for a panel that is scrolled where it is too low for all of it, so that a low screen is enough for
/// the window.
class ScrolledPanel : public QScrollArea {
public:
    explicit ScrolledPanel(QWidget *panel) {
        setWidget(panel);
        setWidgetResizable(true);
        setFrameShape(QFrame::NoFrame);
        setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
        setFocusPolicy(Qt::NoFocus);
    }

    QSize minimumSizeHint() const override {
        const QSize least = widget()->minimumSizeHint();
        const int bar = verticalScrollBar()->sizeHint().width();
        return {least.width() + (least.height() > lowest ? bar : 0), std::min(least.height(), lowest)};
    }
    QSize sizeHint() const override { return widget()->sizeHint(); }

private:
    static constexpr int lowest = 110;
};

} // namespace hermes::desktop
