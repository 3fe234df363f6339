#pragma once

#include "gui/desktop/model/Sessions.h"
#include "gui/desktop/widgets/Timeline.h"

class QAbstractButton;
class QCheckBox;
class QComboBox;
class QPushButton;

namespace hermes::desktop {

class PlainLabel;

/// How far the replay of a session is, and hands on it: place, pause, speed, loop and marks. Hidden while
/// nothing is played.
class ReplayBar : public QWidget {
    Q_OBJECT
public:
    explicit ReplayBar(Sessions &sessions, QWidget *parent = nullptr);

protected:
    void showEvent(QShowEvent *event) override;
    bool eventFilter(QObject *viewport, QEvent *event) override;

private:
    void comeInSight();
    void update();
    void showSpeed(double speed);
    void showPosition();
    void hold(bool isHeld);
    /// The mark before or after this time; null: none.
    const Timeline::Mark *markBefore() const;
    const Timeline::Mark *markAfter() const;
    void goTo(const Timeline::Mark *mark);

    Sessions &sessions_;
    bool isPaused_ = false;
    bool wasPaused_ = false; ///< when the mouse took the line
    PlainLabel *position_;
    Timeline *line_;
    QPushButton *pause_;
    QAbstractButton *before_, *after_;
    QComboBox *speed_;
    QCheckBox *loop_;
};

} // namespace hermes::desktop
