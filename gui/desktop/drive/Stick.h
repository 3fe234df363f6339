#pragma once

#include "gui/desktop/drive/DriveControl.h"

#include <QWidget>

namespace hermes::desktop {

/// The stick on the screen: drag the knob ahead or aside to drive, the ring around it to turn. It goes back
/// to the middle when it is let go.
class Stick : public QWidget {
    Q_OBJECT
public:
    explicit Stick(QWidget *parent = nullptr);
    QSize sizeHint() const override { return {120, 120}; }

Q_SIGNALS:
    /// Each from -1 to 1; isHeld: the mouse button is down.
    void moved(const vectorlib::Twist2D &request, bool isHeld);

protected:
    void paintEvent(QPaintEvent *event) override;
    void mousePressEvent(QMouseEvent *event) override;
    void mouseMoveEvent(QMouseEvent *event) override;
    void mouseReleaseEvent(QMouseEvent *event) override;
    void hideEvent(QHideEvent *) override { letGo(); }
    void changeEvent(QEvent *event) override;

private:
    enum class Grip { None, Knob, Ring };

    double radius() const { return std::min(width(), height()) / 2.0 - 4; }
    QPointF fromCentre(QPointF pixel) const { return pixel - QPointF(width() / 2.0, height() / 2.0); }
    void letGo();

    Grip grip_ = Grip::None;
    QPointF knob_;       // -1 to 1, right and down
    double turn_ = 0;    // -1 to 1, counter-clockwise
    double grabbed_ = 0; // angle at which the ring was taken
};

} // namespace hermes::desktop
