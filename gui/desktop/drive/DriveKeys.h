#pragma once

#include "gui/desktop/drive/DriveControl.h"
#include "gui/desktop/drive/HeldKeys.h"
#include "gui/desktop/widgets/TypingWatch.h"

#include <QElapsedTimer>
#include <QHash>
#include <QKeyEvent>
#include <QSet>

namespace hermes::desktop {

/// The keyboard as an input, wherever in the window the focus is: arrows or WASD drive, Q and E turn, Shift
/// is slow. Keys that somebody types into a field or uses in a menu do not drive. A held key is the key
/// itself (its scan code), not its letter. The drive ends when the window loses the focus, when the layout
/// changes, and when the display does not say for 0.3 s that the key is held (HeldKeys).
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
    void hold(const QKeyEvent &key);
    void ask();
    void steer(Qt::KeyboardModifiers modifiers);
    void letGo(const QString &reason = {});

    struct Held {
        int key; ///< as it was pressed
        QElapsedTimer seen;
    };

    DriveControl &drive_;
    QWidget &window_;
    const TypingWatch &typing_;
    HeldKeys held_;
    QTimer asking_;
    QHash<qint64, Held> down_; ///< by the key itself
    QSet<qint64> stale_;       ///< held since a drive that has ended
    struct Release {
        ulong stamp; ///< of the display; 0: not known
        QElapsedTimer age;
    };
    QHash<qint64, Release> released_; ///< the last of keys that drove nobody
};

} // namespace hermes::desktop
