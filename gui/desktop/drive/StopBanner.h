#pragma once

#include "gui/desktop/drive/DriveControl.h"
#include "gui/desktop/widgets/Banner.h"
#include "gui/desktop/widgets/Sounds.h"

namespace hermes::desktop {

/// How far a STOP has come, or why the robot is stopped, across the window; hidden while it is not. While a
/// STOP is not confirmed it is red and sounds once a second.
class StopBanner : public Banner {
    Q_OBJECT
public:
    StopBanner(DriveControl &drive, const Sounds &sounds, QWidget *parent = nullptr);

    /// The short form, for the button.
    static QString wordOf(const DriveControl &drive);
    /// Of the background and the text.
    static QString styleOf(const DriveControl &drive);

private:
    void update();

    DriveControl &drive_;
    const Sounds &sounds_;
    QTimer sound_;
};

} // namespace hermes::desktop
