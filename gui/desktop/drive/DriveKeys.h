#pragma once

#include "gui/desktop/drive/DriveControl.h"
#include "gui/desktop/widgets/TypingWatch.h"

#include <QSet>

namespace hermes::desktop {

/// The keyboard as an input, wherever in the window the focus is: arrows or WASD drive, Q and E turn, Shift
/// is slow. Keys that somebody types into a field or uses in a menu do not drive. When the window loses the
/// focus the drive ends.
class DriveKeys : public QObject {
    Q_OBJECT
public:
    DriveKeys(DriveControl &drive, const TypingWatch &typing, QWidget &window);

protected:
    bool eventFilter(QObject *watched, QEvent *event) override;

private:
    bool press(int key, Qt::KeyboardModifiers modifiers);
    void steer(Qt::KeyboardModifiers modifiers);
    void letGo();

    DriveControl &drive_;
    QWidget &window_;
    const TypingWatch &typing_;
    QSet<int> down_;
    QSet<int> stale_; ///< held since a drive that has ended
};

} // namespace hermes::desktop
