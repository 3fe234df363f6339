#include "gui/desktop/panels/Panels.h"

#include "gui/desktop/panels/CloudPanel.h"
#include "gui/desktop/panels/CommandsPanel.h"
#include "gui/desktop/panels/DaemonsPanel.h"
#include "gui/desktop/panels/DrivePanel.h"
#include "gui/desktop/panels/EventsPanel.h"
#include "gui/desktop/panels/LogPanel.h"
#include "gui/desktop/panels/PlotsPanel.h"
#include "gui/desktop/panels/RecordPanel.h"
#include "gui/desktop/panels/SettingsPanel.h"
#include "gui/desktop/panels/SetupPanel.h"

#include <stdexcept>
#include <string>

namespace hermes::desktop {
namespace {

QWidget *makeDrivePanel(const PanelContext &context) {
    return new DrivePanel(context.drive, context.gamepad);
}

QWidget *makeCommandsPanel(const PanelContext &context) {
    return new CommandsPanel(context.fleet, context.buttons);
}

QWidget *makeLogPanel(const PanelContext &context) {
    return new LogPanel(context.log);
}

QWidget *makeEventsPanel(const PanelContext &context) {
    return new EventsPanel(context.events, context.sounds);
}

QWidget *makeRecordPanel(const PanelContext &context) {
    return new RecordPanel(context.fleet, context.drive.sessions());
}

std::vector<PanelKind> &known() {
    // A new panel is one line here.
    static std::vector<PanelKind> all = {
        {Qt::LeftDockWidgetArea, "Daemons", "daemons", makePanel<DaemonsPanel>},
        {Qt::BottomDockWidgetArea, "Settings", "settings", makePanel<SettingsPanel>},
        {Qt::BottomDockWidgetArea, "Commands", "commands", makeCommandsPanel, "settings"},
        {Qt::BottomDockWidgetArea, "Log", "log", makeLogPanel, "settings"},
        {Qt::BottomDockWidgetArea, "Plots", "plots", makePanel<PlotsPanel>, "settings"},
        {Qt::RightDockWidgetArea, "Drive", "drive", makeDrivePanel},
        {Qt::LeftDockWidgetArea, "Recordings", "recordings", makeRecordPanel, "daemons"},
        {Qt::BottomDockWidgetArea, "Setup", "setup", makePanel<SetupPanel>, "settings"},
        {Qt::BottomDockWidgetArea, "Events", "events", makeEventsPanel, "settings"},
        {Qt::BottomDockWidgetArea, "Cloud", "cloud", makePanel<CloudPanel>, "settings"},
    };
    return all;
}

} // namespace

const std::vector<PanelKind> &panelKinds() {
    return known();
}

bool addPanelKind(const PanelKind &kind) {
    for (const PanelKind &other : known())
        if (std::string(other.name) == kind.name)
            throw std::invalid_argument(std::string("panel ") + kind.name + ": there is one of that name");
    known().push_back(kind);
    return true;
}

} // namespace hermes::desktop
