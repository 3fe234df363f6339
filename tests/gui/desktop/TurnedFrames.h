#pragma once

#include <QMouseEvent>

namespace hermes {

/// Counts what a widget paints from the first move of the mouse with its left button to the last.
class TurnedFrames : public QObject {
public:
    explicit TurnedFrames(QWidget *watched) { watched->installEventFilter(this); }

    void restart() {
        clock_.invalidate();
        lastMove_s_ = 0;
    }
    double time_s() const { return lastMove_s_; }
    double perSecond() const { return frames_ / lastMove_s_; }

private:
    bool eventFilter(QObject *, QEvent *event) override {
        painted_ += event->type() == QEvent::Paint;
        if (event->type() != QEvent::MouseMove ||
            static_cast<QMouseEvent *>(event)->buttons() != Qt::LeftButton)
            return false;
        if (!clock_.isValid()) {
            clock_.start();
            painted_ = 0;
        }
        lastMove_s_ = double(clock_.nsecsElapsed()) * 1e-9;
        frames_ = painted_;
        return false;
    }

    QElapsedTimer clock_;
    double lastMove_s_ = 0;
    int painted_ = 0, frames_ = 0; // since the first move; until the last one
};

} // namespace hermes
