#pragma once

#include <QBoxLayout>
#include <QWidget>
#include <initializer_list>

class QMenu;
class QScrollArea;
class QToolButton;

namespace hermes::desktop {
// How panels are put together.

/// Gives a widget, an action or a menu its name, by which others find it, and its tool tip.
template <typename T>
T *named(T *object, const QString &name, const QString &toolTip = {}) {
    object->setObjectName(name);
    object->setToolTip(toolTip);
    return object;
}

/// A part of a row or a column: a widget, a layout, or room that nothing takes.
struct Part {
    Part(QWidget *part, int share = 0, Qt::Alignment place = {})
        : widget(part)
        , stretch(share)
        , alignment(place) {}
    Part(QLayout *part, int share = 0)
        : layout(part)
        , stretch(share) {}
    static Part room() { return static_cast<QLayout *>(nullptr); }

    QWidget *widget = nullptr;
    QLayout *layout = nullptr;
    int stretch; ///< its share of the room that is left
    Qt::Alignment alignment;
};

QBoxLayout *inRow(std::initializer_list<Part> parts);
QBoxLayout *inColumn(std::initializer_list<Part> parts);

/// Gives a widget this layout, without margins; spacing: as usual, or so many pixels between the parts.
QWidget *filled(QWidget *widget, QLayout *layout, int spacing = -1);

/// It is gone for who looks; later in truth, for it may be what asks.
void discard(QWidget *widget);

/// A button in a line of tools that opens a menu.
QToolButton *menuButton(const QString &text, const QIcon &icon, QMenu *menu);

/// All of it can be seen by scrolling, without a frame.
QScrollArea *scrolled(QWidget *widget);
} // namespace hermes::desktop
