#pragma once

#include "gui/desktop/drive/DriveControl.h"

class QGamepad;

namespace hermes::desktop {

/// The first gamepad that is plugged in: the left stick drives, the right one turns, as long as the left
/// shoulder button (the dead-man key) is held; the red button (B) is STOP.
class DriveGamepad : public QObject {
    Q_OBJECT
public:
    DriveGamepad(DriveControl &drive, QObject *parent);

private:
    void plug(int device);

    DriveControl &drive_;
    QGamepad *pad_ = nullptr;
};

} // namespace hermes::desktop
