#include "gui/desktop/widgets/Arrangement.h"
#include <QScrollArea>
#include <QToolButton>

namespace hermes::desktop {
namespace {
QBoxLayout *laidOut(QBoxLayout::Direction direction, std::initializer_list<Part> parts) {
    auto *const layout = new QBoxLayout(direction);
    for (const Part &part : parts)
        if (part.widget)
            layout->addWidget(part.widget, part.stretch, part.alignment);
        else if (part.layout)
            layout->addLayout(part.layout, part.stretch);
        else
            layout->addStretch();
    return layout;
}
} // namespace

QBoxLayout *inRow(std::initializer_list<Part> parts) {
    return laidOut(QBoxLayout::LeftToRight, parts);
}

QBoxLayout *inColumn(std::initializer_list<Part> parts) {
    return laidOut(QBoxLayout::TopToBottom, parts);
}

QWidget *filled(QWidget *widget, QLayout *layout, int spacing) {
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(spacing);
    widget->setLayout(layout);
    return widget;
}

void discard(QWidget *widget) {
    widget->hide();
    widget->deleteLater();
}

QToolButton *menuButton(const QString &text, const QIcon &icon, QMenu *menu) {
    auto *const button = new QToolButton;
    button->setText(text);
    button->setIcon(icon);
    button->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
    button->setPopupMode(QToolButton::InstantPopup);
    button->setFocusPolicy(Qt::StrongFocus);
    button->setMenu(menu);
    return button;
}

QScrollArea *scrolled(QWidget *widget) {
    auto *const area = new QScrollArea;
    area->setWidget(widget);
    area->setWidgetResizable(true);
    area->setFrameShape(QFrame::NoFrame);
    return area;
}
} // namespace hermes::desktop
