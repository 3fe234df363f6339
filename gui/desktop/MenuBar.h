#pragma once

#include "gui/desktop/drive/DriveControl.h"
#include "gui/desktop/model/Events.h"
#include "gui/desktop/widgets/OneDialog.h"

#include <QMenuBar>

namespace hermes::desktop {

class MapPanel;
class StopKeys;

/// All that the window can do, by name and with its key: the robot, the map and what is seen of it, the
/// panels, which come back from here when they were closed, events and help.
class MenuBar : public QMenuBar {
    Q_OBJECT
public:
    explicit MenuBar(QWidget *parent);

    void addRobot(DriveControl &drive, StopKeys &keys);
    void addMap(MapPanel &map);
    void addRecording(const QList<QAction *> &actions) {
        addNamed(tr("Recording"), "recordingMenu")->addActions(actions);
    }
    /// show: each brings a dock to the front.
    void addPanels(const QList<QAction *> &show) { addNamed(tr("Panels"), "panelsMenu")->addActions(show); }
    void addEvents(Events &events);
    void addHelp();

Q_SIGNALS:
    void closeWanted();
    /// Of the panel that has the focus.
    void helpWanted();
    void keysWanted();

private:
    QMenu *addNamed(const QString &title, const char *name);

    OneDialog about_;
};

} // namespace hermes::desktop
