#pragma once

#include "gui/desktop/drive/DriveGamepad.h"

#include <QWidget>

class QPushButton;

namespace hermes::desktop {

class MessageLabel;
class PlainLabel;

/// The gamepad that is plugged in: its name, its sticks as they drive, whether the dead-man button is held,
/// and its calibration; hidden while there is none.
class GamepadRow : public QWidget {
    Q_OBJECT
public:
    explicit GamepadRow(DriveGamepad &gamepad, QWidget *parent = nullptr);

private:
    void update();
    void go();
    QString hint() const;

    DriveGamepad &gamepad_;
    QWidget *sticks_;
    PlainLabel *name_;
    QPushButton *calibrate_, *other_;
    MessageLabel *message_;
};

} // namespace hermes::desktop
