#pragma once

#include "gui/desktop/drive/DriveControl.h"
#include "gui/desktop/model/Events.h"

namespace hermes::desktop {

/// Makes a note of each other client that takes the control of the chosen robot.
class ControlWatch : public QObject {
    Q_OBJECT
public:
    ControlWatch(const Fleet &fleet, const DriveControl &drive, Events &events, QObject *parent = nullptr);

private:
    void look();

    const Fleet &fleet_;
    const DriveControl &drive_;
    Events &events_;
    const Robot *robot_ = nullptr; // whose holder that is
    QString holder_;
};

} // namespace hermes::desktop
