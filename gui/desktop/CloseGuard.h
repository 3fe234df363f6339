#pragma once

#include "gui/desktop/LayoutKeeper.h"
#include "gui/desktop/drive/DriveControl.h"

#include <QElapsedTimer>

namespace hermes::desktop {

class SettingsPanel;

/// What the operator is to know before the window closes. A window that is closed
/// once more within 20 s is meant to be, unless there is something else to be said by then.
class CloseGuard : public QObject {
    Q_OBJECT
public:
    CloseGuard(DriveControl &drive, LayoutKeeper &keeper, const SettingsPanel &settings,
               QObject *parent = nullptr);

    /// What speaks against closing now; empty: nothing.
    QString objection();
    /// From now on nothing does.
    void closeAnyway() { isForced_ = true; }

Q_SIGNALS:
    /// What was still to be written is: the window may close without another wish.
    void ready();

private:
    QString reasons() const;

    DriveControl &drive_;
    LayoutKeeper &keeper_;
    const SettingsPanel &settings_;
    bool isForced_ = false, waits_ = false;
    QElapsedTimer tried_; ///< since something was said
    QString said_;
};

} // namespace hermes::desktop
