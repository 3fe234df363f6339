#include "gui/desktop/MenuBar.h"

#include "common/Project.h"
#include "gui/desktop/drive/StopKeys.h"
#include "gui/desktop/panels/MapPanel.h"

#include "gui/desktop/widgets/Arrangement.h"
#include <QMessageBox>

namespace hermes::desktop {
namespace {

/// Not a shortcut of Qt's, for somebody else sees to the key: only its name beside the text.
QString withKey(const QString &text, const QString &key) {
    return text + '\t' + key;
}

} // namespace

MenuBar::MenuBar(QWidget *parent)
    : QMenuBar(parent) {}

QMenu *MenuBar::addNamed(const QString &title, const char *name) {
    QMenu *const menu = named(addMenu(title), name);
    menu->setToolTipsVisible(true);
    return menu;
}

void MenuBar::addRobot(DriveControl &drive, StopKeys &keys) {
    QMenu *const menu = addNamed(tr("Robot"), "robotMenu");
    menu->addAction(withKey(tr("STOP"), tr("F12, Space")), &drive, &DriveControl::stop);
    QAction *const release = menu->addAction(tr("Release"), &drive, &DriveControl::release);
    QAction *const takeOver = menu->addAction(tr("Take over the control"), &drive, &DriveControl::takeOver);
    menu->addSeparator();
    QAction *const escape = menu->addAction(tr("Esc is STOP, too"));
    escape->setObjectName("escapeStops");
    escape->setCheckable(true);
    escape->setChecked(keys.doesEscapeStop());
    escape->setToolTip(
        tr("Else Esc closes and cancels, and is STOP only while the robot is driven from this window"));
    connect(escape, &QAction::toggled, &keys, &StopKeys::letEscapeStop);
    menu->addSeparator();
    menu->addAction(tr("Close the window"), this, &MenuBar::closeWanted, QKeySequence(Qt::CTRL + Qt::Key_Q));
    connect(menu, &QMenu::aboutToShow, this, [&drive, release, takeOver] {
        release->setEnabled(drive.isStopped());
        takeOver->setEnabled(drive.isHeldByOther());
    });
}

void MenuBar::addMap(MapPanel &map) {
    addMenu(&map.mapMenu());
    QMenu *const view = addNamed(tr("View"), "viewMenu");
    view->addActions(map.tools());
    view->addMenu(&map.layersMenu());
    view->addSeparator();
    view->addAction(withKey(tr("Closer"), "+"), &map.view(), [&map] { map.view().zoom(MapView::step); });
    view->addAction(withKey(tr("Farther"), "-"), &map.view(), [&map] { map.view().zoom(1 / MapView::step); });
}

void MenuBar::addEvents(Events &events) {
    QMenu *const menu = addNamed(tr("Events"), "eventsMenu");
    menu->addAction(tr("Acknowledge the one that is shown"), &events, [&events] {
        if (const Event *const loudest = events.loudest())
            events.acknowledge(loudest->id);
    });
    menu->addAction(tr("Acknowledge all"), &events, &Events::acknowledgeAll);
}

void MenuBar::addHelp() {
    QMenu *const menu = addNamed(tr("Help"), "helpMenu");
    menu->addAction(tr("Help for this place"), this, &MenuBar::helpWanted, QKeySequence(Qt::Key_F1))
        ->setObjectName("helpHere");
    menu->addAction(tr("Keys"), this, &MenuBar::keysWanted);
    menu->addSeparator();
    menu->addAction(tr("About Hermes"), this,
                    [this] {
                        auto *const box = new QMessageBox(
                            QMessageBox::NoIcon, tr("About Hermes"),
                            tr("Hermes %1\n\nSees, drives and manages robots.").arg(projectVersion()),
                            QMessageBox::Ok, this);
                        about_.show(box);
                    })
        ->setObjectName("about");
}

} // namespace hermes::desktop
