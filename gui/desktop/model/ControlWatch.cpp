#include "gui/desktop/model/ControlWatch.h"

#include "gui/desktop/drive/OwnName.h"
#include "gui/desktop/widgets/ForeignText.h"

#include <utility>

namespace hermes::desktop {

ControlWatch::ControlWatch(const Fleet &fleet, const DriveControl &drive, Events &events, QObject *parent)
    : QObject(parent)
    , fleet_(fleet)
    , drive_(drive)
    , events_(events) {
    connect(&drive, &DriveControl::changed, this, &ControlWatch::look);
}

void ControlWatch::look() {
    const QString holder = drive_.holder();
    const bool isSame = std::exchange(robot_, fleet_.robot()) == fleet_.robot();
    if (std::exchange(holder_, holder) == holder && isSame)
        return;
    if (robot_ && !holder.isEmpty() && holder != tr("you") && holder != ownName())
        events_.happened(Event::Level::Info, fleet_.titleOf(*robot_),
                         tr("%1 has taken the control").arg(shortLine(holder, 80)));
}

} // namespace hermes::desktop
