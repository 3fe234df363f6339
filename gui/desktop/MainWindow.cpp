#include "gui/desktop/MainWindow.h"

#include "gui/desktop/TopBar.h"
#include "gui/desktop/drive/DriveGamepad.h"
#include "gui/desktop/drive/DriveKeys.h"
#include "gui/desktop/panels/CommandsPanel.h"
#include "gui/desktop/panels/DaemonsPanel.h"
#include "gui/desktop/panels/DrivePanel.h"
#include "gui/desktop/panels/LogPanel.h"
#include "gui/desktop/panels/MapPanel.h"
#include "gui/desktop/panels/PlotsPanel.h"
#include "gui/desktop/panels/RecordPanel.h"
#include "gui/desktop/panels/SettingsPanel.h"
#include "gui/desktop/widgets/EnterKey.h"

#include <QAction>
#include <QCloseEvent>
#include <QDir>
#include <QDockWidget>
#include <QFileInfo>
#include <QSettings>
#include <QToolBar>

namespace hermes {

MainWindow::MainWindow(Fleet &fleet, DriveControl &drive, const QString &layoutFile, QWidget *parent)
    : QMainWindow(parent)
    , drive_(drive)
    , layoutFile_(layoutFile) {
    setWindowTitle(tr("Hermes"));
    setDockNestingEnabled(true);
    setCorner(Qt::BottomLeftCorner, Qt::BottomDockWidgetArea);
    setCorner(Qt::BottomRightCorner, Qt::BottomDockWidgetArea);

    auto *const bar = addToolBar(tr("Robot"));
    bar->setObjectName("topBar");
    bar->setMovable(false);
    bar->setContextMenuPolicy(Qt::PreventContextMenu);
    bar->addWidget(new TopBar(fleet, drive_));

    setCentralWidget(new MapPanel(fleet));
    addPanel(Qt::LeftDockWidgetArea, new DaemonsPanel(fleet), tr("Daemons"), "daemons");
    addPanel(Qt::BottomDockWidgetArea, new SettingsPanel(fleet), tr("Settings"), "settings");
    addPanel(Qt::BottomDockWidgetArea, new CommandsPanel(fleet), tr("Commands"), "commands", lastDock());
    addPanel(Qt::BottomDockWidgetArea, new LogPanel(fleet), tr("Log"), "log", lastDock());
    addPanel(Qt::BottomDockWidgetArea, new PlotsPanel(fleet), tr("Plots"), "plots", lastDock());
    addPanel(Qt::RightDockWidgetArea, new DrivePanel(drive_), tr("Drive"), "drive");
    addPanel(Qt::LeftDockWidgetArea, new RecordPanel(fleet), tr("Recordings"), "recordings", docks_.front());
    new DriveKeys(drive_, *this);
    new DriveGamepad(drive_, this);
    new EnterKey(*this);
    restoreLayout();
    centralWidget()->setFocus(); // so that the keys drive
}

MainWindow::~MainWindow() = default;

void MainWindow::addPanel(Qt::DockWidgetArea area, QWidget *panel, const QString &title, const QString &name,
                          QDockWidget *tabbedWith) {
    auto *const dock = new QDockWidget(title, this);
    dock->setObjectName(name);
    dock->setWidget(panel);
    addDockWidget(area, dock);
    if (tabbedWith)
        tabifyDockWidget(tabbedWith, dock);
    docks_.push_back(dock);

    auto *const show = new QAction(title, this);
    show->setShortcut(QKeySequence(Qt::CTRL + Qt::Key_0 + int(docks_.size())));
    connect(show, &QAction::triggered, dock, [dock] {
        dock->show();
        dock->raise();
        dock->widget()->setFocus();
    });
    addAction(show);
    dock->toggleViewAction()->setToolTip(tr("%1 (%2)").arg(title, show->shortcut().toString()));
}

void MainWindow::restoreLayout() {
    resize(1280, 720);
    resizeDocks({docks_.front(), findChild<QDockWidget *>("drive")}, {300, 240}, Qt::Horizontal);
    resizeDocks({docks_[1]}, {220}, Qt::Vertical);
    docks_[0]->raise();
    docks_[1]->raise();
    if (layoutFile_.isEmpty())
        return;
    const QSettings layout(layoutFile_, QSettings::IniFormat);
    restoreGeometry(layout.value("window/geometry").toByteArray());
    restoreState(layout.value("window/state").toByteArray());
}

void MainWindow::saveLayout() const {
    if (layoutFile_.isEmpty())
        return;
    QDir().mkpath(QFileInfo(layoutFile_).path());
    QSettings layout(layoutFile_, QSettings::IniFormat);
    layout.setValue("window/geometry", saveGeometry());
    layout.setValue("window/state", saveState());
}

void MainWindow::closeEvent(QCloseEvent *event) {
    drive_.halt();
    saveLayout();
    event->accept();
}

} // namespace hermes
