#pragma once

#include "gui/desktop/widgets/Timeline.h"
#include "gui/session/SessionMarks.h"
#include "gui/session/SessionPlayer.h"

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
    explicit ReplayBar(SessionPlayer &player, QWidget *parent = nullptr);

    /// This one is played now; its marks come later.
    void begin(const RecordedSession &session);
    void setMarks(const std::vector<SessionMark> &marks);

protected:
    void showEvent(QShowEvent *event) override;
    bool eventFilter(QObject *viewport, QEvent *event) override;

private:
    void comeInSight();
    void layOut();
    void showProgress(double position_s, double duration_s);
    void showPosition();
    void showPaused();
    void hold(bool isHeld);
    /// The mark before or after this time; null: none.
    const Timeline::Mark *markBefore() const;
    const Timeline::Mark *markAfter() const;
    void goTo(const Timeline::Mark *mark);

    SessionPlayer &player_;
    double recorded_s_ = 0;  ///< how long was recorded
    bool wasPaused_ = false; ///< when the mouse took the line
    PlainLabel *position_;
    Timeline *line_;
    QPushButton *pause_;
    QAbstractButton *before_, *after_;
    QComboBox *speed_;
    QCheckBox *loop_;
};

} // namespace hermes::desktop
