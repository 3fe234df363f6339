#pragma once

#include "gui/desktop/widgets/ForeignText.h"

#include <QLabel>

namespace hermes::desktop {

/// A label for text that may be foreign: plain, and not longer than somebody reads.
class PlainLabel : public QLabel {
    Q_OBJECT
public:
    explicit PlainLabel(const QString &text = {}, QWidget *parent = nullptr);

    void setText(const QString &text);
    void setBold(bool isBold);
    /// Breaks its lines; a word without end widens no panel.
    void letWrap();
    /// One line that gives way to what is beside it: dots stand for what is left out, and the tool tip has
    /// all.
    void letElide(Qt::TextElideMode mode = Qt::ElideRight);
    /// So wide it stays (pixels), as far as its text is, while others beside it are cut.
    void keepRoom(int most);
    /// Whether not all of it is seen at this width.
    bool isElided() const { return shownText() != text(); }
    /// What is seen of the text.
    QString shownText() const;

protected:
    bool event(QEvent *event) override;
    void paintEvent(QPaintEvent *event) override;

private:
    Qt::TextElideMode mode_ = Qt::ElideNone;
    int room_ = 1; ///< pixels
};

} // namespace hermes::desktop
