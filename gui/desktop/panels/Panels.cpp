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

using Context = const PanelContext &;

std::vector<PanelKind> &known() {
    // A new panel is one line here.
    static std::vector<PanelKind> all = {
        {Qt::LeftDockWidgetArea, "Daemons", "daemons", makePanel<DaemonsPanel>},
        {Qt::BottomDockWidgetArea, "Settings", "settings", makePanel<SettingsPanel>},
        {Qt::BottomDockWidgetArea, "Commands", "commands",
         [](Context with) -> QWidget * { return new CommandsPanel(with.fleet, with.buttons); }, "settings"},
        {Qt::BottomDockWidgetArea, "Log", "log",
         [](Context with) -> QWidget * { return new LogPanel(with.log); }, "settings"},
        {Qt::BottomDockWidgetArea, "Plots", "plots", makePanel<PlotsPanel>, "settings"},
        {Qt::RightDockWidgetArea, "Drive", "drive",
         [](Context with) -> QWidget * { return new DrivePanel(with.drive, with.gamepad); }},
        {Qt::LeftDockWidgetArea, "Recordings", "recordings",
         [](Context with) -> QWidget * { return new RecordPanel(with.fleet, with.drive.sessions()); },
         "daemons"},
        {Qt::BottomDockWidgetArea, "Setup", "setup", makePanel<SetupPanel>, "settings"},
        {Qt::BottomDockWidgetArea, "Events", "events",
         [](Context with) -> QWidget * { return new EventsPanel(with.events, with.sounds); }, "settings"},
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
