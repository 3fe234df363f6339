#pragma once

#include "gui/desktop/drive/DriveControl.h"

#include <QWidget>

class QPushButton;
class QSlider;

namespace hermes::desktop {

class DriveGamepad;

class AgedLabel;
class MessageLabel;
class PlainLabel;
class Stick;

/// Drives by hand: stick, speed limit, the velocity that is commanded and the one that is measured, who has
/// the control.
class DrivePanel : public QWidget {
    Q_OBJECT
public:
    DrivePanel(DriveControl &drive, DriveGamepad &gamepad, QWidget *parent = nullptr);

private:
    void update();
    QWidget *makeNumbers();

    DriveControl &drive_;
    Stick *stick_;
    QSlider *limit_;
    PlainLabel *limitText_;
    AgedLabel *control_;
    MessageLabel *problem_;
    PlainLabel *commanded_[3];
    AgedLabel *measured_[3];
    QPushButton *takeOver_, *blind_;
};

} // namespace hermes::desktop
