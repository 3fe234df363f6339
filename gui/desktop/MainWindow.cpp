#include "gui/desktop/MainWindow.h"

#include "gui/desktop/EventBar.h"
#include "gui/desktop/HelpWindow.h"
#include "gui/desktop/MenuBar.h"
#include "gui/desktop/TopBar.h"
#include "gui/desktop/drive/DriveGamepad.h"
#include "gui/desktop/drive/DriveKeys.h"
#include "gui/desktop/drive/StopBanner.h"
#include "gui/desktop/drive/StopKeys.h"
#include "gui/desktop/panels/MapPanel.h"
#include "gui/desktop/panels/PlotSets.h"
#include "gui/desktop/panels/PlotsPanel.h"
#include "gui/desktop/widgets/EnterKey.h"
#include "gui/desktop/widgets/ScrolledPanel.h"
#include "gui/desktop/widgets/WheelGuard.h"

#include <QAction>
#include <QApplication>
#include <QCloseEvent>
#include <QDir>
#include <QDockWidget>
#include <QFileInfo>
#include <QJsonDocument>
#include <QSettings>
#include <QToolBar>

namespace hermes::desktop {
namespace {

QString textOf(const QJsonObject &object) {
    return QString::fromUtf8(QJsonDocument(object).toJson(QJsonDocument::Compact));
}

QJsonObject objectFrom(const QVariant &text) {
    return QJsonDocument::fromJson(text.toString().toUtf8()).object();
}

} // namespace

MainWindow::MainWindow(Fleet &fleet, DriveControl &drive, const QString &layoutFile, QWidget *parent)
    : QMainWindow(parent)
    , fleet_(fleet)
    , drive_(drive)
    , log_(fleet)
    , eventWatch_(fleet, log_, events_)
    , layoutFile_(layoutFile) {
    if (!layoutFile_.isEmpty())
        sounds_.switchTo(QSettings(layoutFile_, QSettings::IniFormat).value("sounds/on", true).toBool());
    setWindowTitle(tr("Hermes"));
    setDockNestingEnabled(true);
    setCorner(Qt::BottomLeftCorner, Qt::BottomDockWidgetArea);
    setCorner(Qt::BottomRightCorner, Qt::BottomDockWidgetArea);

    auto *const bar = addToolBar(tr("Robot"));
    bar->setObjectName("topBar");
    bar->setMovable(false);
    bar->setContextMenuPolicy(Qt::PreventContextMenu);
    auto *const topBar = new TopBar(fleet, drive_);
    bar->addWidget(topBar);

    addBanner(new StopBanner(drive_, sounds_), "stopBar");
    auto *const replay = new Banner;
    replay->setObjectName("replayBanner");
    addBanner(replay, "replayBar");
    connect(&drive_.replay(), &ReplayWatch::changed, replay, [this, replay] {
        const QString text = drive_.replay().text();
        replay->tell(text.isEmpty() ? QString() : tr("REPLAY, not the robot of now: %1").arg(text),
                     "background: #6a2fb0; color: white;");
    });

    setCentralWidget(map_ = new MapPanel(fleet));
    auto *const gamepad = new DriveGamepad(drive_, layoutFile_, this);
    for (const PanelKind &kind : panelKinds())
        addPanel(kind, kind.make({fleet, drive_, *gamepad, log_, events_, sounds_}));
    addEventBar();
    new DriveKeys(drive_, *this);
    new EnterKey(*this);
    new WheelGuard(*this);
    auto *const stopKeys = new StopKeys(drive_, topBar->stopButton()); // sees keys before the others
    addMenus(*stopKeys);
    restoreLayout();
    connect(&findChild<PlotsPanel *>()->sets(), &PlotSets::changed, this, &MainWindow::saveLayout);
    centralWidget()->setFocus(); // so that the keys drive
}

MainWindow::~MainWindow() = default;

QStringList MainWindow::keptAddresses(const QString &layoutFile) {
    return QSettings(layoutFile, QSettings::IniFormat).value("robots/addresses").toStringList();
}

void MainWindow::addBanner(Banner *banner, const char *name) {
    addToolBarBreak();
    auto *const bar = addToolBar(tr("Notice"));
    bar->setObjectName(name);
    bar->setMovable(false);
    bar->setContextMenuPolicy(Qt::PreventContextMenu);
    bar->addWidget(banner);
    bar->hide();
    banners_.push_back(bar);
    connect(banner, &Banner::shown, bar, &QToolBar::setVisible);
}

void MainWindow::addPanel(const PanelKind &kind, QWidget *panel) {
    const QString title = tr(kind.title);
    auto *const dock = new QDockWidget(title, this);
    dock->setObjectName(kind.name);
    dock->setWidget(new ScrolledPanel(panel));
    addDockWidget(kind.area, dock);
    if (auto *const other = kind.tabbedWith ? findChild<QDockWidget *>(kind.tabbedWith) : nullptr)
        tabifyDockWidget(other, dock);
    docks_.push_back(dock);
    addActions(panel->actions()); // their keys act while the panel is out of sight, too
    panelActions_ += panel->actions();

    auto *const show = new QAction(title, this);
    if (docks_.size() <= 10)
        show->setShortcut(QKeySequence(Qt::CTRL + Qt::Key_0 + int(docks_.size() % 10)));
    connect(show, &QAction::triggered, this, [this, name = kind.name] { showPanel(name); });
    addAction(show);
    showPanels_.append(show);
    dock->toggleViewAction()->setToolTip(tr("%1 (%2)").arg(title, show->shortcut().toString()));
}

void MainWindow::addMenus(StopKeys &keys) {
    auto *const menus = new MenuBar(this);
    menus->addRobot(drive_, keys);
    menus->addMap(*map_);
    menus->addRecording(panelActions_);
    menus->addPanels(showPanels_);
    menus->addEvents(events_);
    menus->addHelp();
    connect(menus, &MenuBar::closeWanted, this, &QWidget::close);
    connect(menus, &MenuBar::helpWanted, this, &MainWindow::showHelp);
    connect(menus, &MenuBar::keysWanted, this, [this] { help().showAt(tr("Keys")); });
    setMenuBar(menus);
}

HelpWindow &MainWindow::help() {
    if (!help_)
        help_ = new HelpWindow(this);
    return *help_;
}

/// At what the manual says of the panel that has the focus.
void MainWindow::showHelp() {
    const QWidget *const focus = QApplication::focusWidget();
    for (std::size_t i = 0; i < docks_.size(); ++i)
        if (focus && docks_[i]->isAncestorOf(focus)) {
            const QString key = showPanels_[int(i)]->shortcut().toString();
            return help().showAt(docks_[i]->windowTitle() + (key.isEmpty() ? key : " (" + key + ')'));
        }
    help().showAt(focus && map_->isAncestorOf(focus) ? tr("The map") : QString());
}

void MainWindow::addEventBar() {
    auto *const events = new EventBar(events_, sounds_);
    auto *const bar = new QToolBar(tr("Last event"));
    bar->setObjectName("eventBar");
    bar->setMovable(false);
    bar->setContextMenuPolicy(Qt::PreventContextMenu);
    bar->addWidget(events);
    addToolBar(Qt::BottomToolBarArea, bar);
    connect(events, &EventBar::listWanted, this, [this] { showPanel("events"); });
}

void MainWindow::showPanel(const QString &name) {
    auto *const dock = findChild<QDockWidget *>(name);
    dock->show();
    dock->raise();
    static_cast<ScrolledPanel *>(dock->widget())->widget()->setFocus();
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
    auto *const plots = findChild<PlotsPanel *>();
    plots->sets().setSets(objectFrom(layout.value("plots/sets")));
    plots->setState(objectFrom(layout.value("plots/shown")));
    map_->setLayers(layout.value("map/layers").toMap());
    for (QToolBar *banner : banners_)
        banner->hide(); // whatever it said when the layout was kept
}

void MainWindow::saveLayout() const {
    if (layoutFile_.isEmpty())
        return;
    QDir().mkpath(QFileInfo(layoutFile_).path());
    QSettings layout(layoutFile_, QSettings::IniFormat);
    layout.setValue("window/geometry", saveGeometry());
    layout.setValue("window/state", saveState());
    auto *const plots = findChild<PlotsPanel *>();
    layout.setValue("plots/sets", textOf(plots->sets().sets()));
    layout.setValue("plots/shown", textOf(plots->state()));
    layout.setValue("map/layers", map_->layers());
    layout.setValue("sounds/on", sounds_.areOn());
    layout.setValue("robots/addresses", fleet_.addresses());
}

void MainWindow::closeEvent(QCloseEvent *event) {
    drive_.halt();
    saveLayout();
    event->accept();
}

} // namespace hermes::desktop
