#pragma once

#include "gui/desktop/drive/DriveControl.h"

class QAbstractButton;

namespace hermes::desktop {

/// STOP by hand, whatever of this program has the focus or lies open: menus, lists and dialogs see neither
/// these keys nor a press on the STOP button first. F12 is STOP always; Space unless somebody types while
/// nobody drives here; Esc while the robot is driven
/// from here, and, when it is told to, where it has nothing to close.
class StopKeys : public QObject {
    Q_OBJECT
public:
    StopKeys(DriveControl &drive, QAbstractButton &button);

    bool doesEscapeStop() const { return doesEscapeStop_; }
    void letEscapeStop(bool stops) { doesEscapeStop_ = stops; }

protected:
    bool eventFilter(QObject *watched, QEvent *event) override;

private:
    bool isStop(int key) const;
    bool isOnButton(const QPoint &global) const;
    void stop();

    DriveControl &drive_;
    QAbstractButton &button_;
    bool doesEscapeStop_ = false;
};

} // namespace hermes::desktop
