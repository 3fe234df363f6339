#pragma once

#include "gui/desktop/drive/DriveControl.h"
#include "gui/desktop/model/Events.h"
#include "gui/desktop/model/LogFeed.h"
#include "gui/desktop/model/Macro.h"
#include "gui/desktop/widgets/Sounds.h"

#include <QWidget>
#include <vector>

namespace hermes::desktop {

class DriveGamepad;

/// What panels can be made of.
struct PanelContext {
    Fleet &fleet;
    DriveControl &drive;
    DriveGamepad &gamepad;
    LogFeed &log;
    Events &events;
    Sounds &sounds;
    Buttons &buttons;
};

/// A panel of the operator's window: what is in a dock, and where that lies at first.
struct PanelKind {
    Qt::DockWidgetArea area;
    const char *title;
    const char *name; ///< by which layouts are kept
    QWidget *(*make)(const PanelContext &context);
    const char *tabbedWith = nullptr; ///< the name of one before it, with which it shares its place
};

/// All panels, in the order of Ctrl+1 to Ctrl+9 and Ctrl+0.
const std::vector<PanelKind> &panelKinds();
/// Adds one as the last, before main() begins: as the initializer of a global constant. Throws
/// std::invalid_argument when there is one of that name. Gives true.
bool addPanelKind(const PanelKind &kind);

/// Makes a panel that is made of a Fleet alone.
template <typename Panel>
QWidget *makePanel(const PanelContext &context) {
    return new Panel(context.fleet);
}

} // namespace hermes::desktop
