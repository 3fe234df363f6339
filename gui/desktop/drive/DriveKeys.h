#pragma once

#include "gui/desktop/drive/DriveControl.h"
#include "gui/desktop/widgets/TypingWatch.h"

#include <QElapsedTimer>
#include <QHash>
#include <QKeyEvent>
#include <QSet>

namespace hermes::desktop {

/// The keyboard as an input, wherever in the window the focus is: arrows or WASD drive, Q and E turn, Shift
/// is slow. Keys that somebody types into a field or uses in a menu do not drive. When the window loses the
/// focus the drive ends.
class DriveKeys : public QObject {
    Q_OBJECT
public:
    DriveKeys(DriveControl &drive, const TypingWatch &typing, QWidget &window);

Q_SIGNALS:
    /// A key that would drive was given to a list or the like, for that has the focus.
    void drivesNothing();

protected:
    bool eventFilter(QObject *watched, QEvent *event) override;

private:
    bool isRepeat(const QKeyEvent &key) const;
    void noteRelease(const QKeyEvent &key);
    bool press(const QKeyEvent &key);
    void steer(Qt::KeyboardModifiers modifiers);
    void letGo();

    DriveControl &drive_;
    QWidget &window_;
    const TypingWatch &typing_;
    QSet<int> down_;
    QSet<int> stale_; ///< held since a drive that has ended
    struct Release {
        ulong stamp; ///< of the display; 0: not known
        QElapsedTimer age;
    };
    QHash<int, Release> released_; ///< the last of keys that drove nobody
};

} // namespace hermes::desktop
