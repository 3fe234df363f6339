#pragma once

#include "gui/desktop/widgets/PlainLabel.h"

namespace hermes::desktop {

/// One line that takes what room there is: where that is too small, dots stand for what is left out, and the
/// tool tip has all of it.
class ElidedLabel : public PlainLabel {
    Q_OBJECT
public:
    explicit ElidedLabel(Qt::TextElideMode mode, QWidget *parent = nullptr);

    /// What is seen of the text.
    QString shownText() const;
    QSize sizeHint() const override { return {1, PlainLabel::sizeHint().height()}; }
    QSize minimumSizeHint() const override { return sizeHint(); }

protected:
    void paintEvent(QPaintEvent *event) override;

private:
    const Qt::TextElideMode mode_;
};

} // namespace hermes::desktop
