#include "gui/desktop/MainWindow.h"

#include "gui/desktop/Banners.h"
#include "gui/desktop/ButtonBar.h"
#include "gui/desktop/CloseGuard.h"
#include "gui/desktop/EventBar.h"
#include "gui/desktop/HelpWindow.h"
#include "gui/desktop/LayoutMenu.h"
#include "gui/desktop/MenuBar.h"
#include "gui/desktop/TopBar.h"
#include "gui/desktop/drive/DriveGamepad.h"
#include "gui/desktop/drive/DriveKeys.h"
#include "gui/desktop/drive/StopKeys.h"
#include "gui/desktop/panels/CommandsPanel.h"
#include "gui/desktop/panels/DaemonTree.h"
#include "gui/desktop/panels/MapPanel.h"
#include "gui/desktop/panels/PlotSets.h"
#include "gui/desktop/panels/PlotsPanel.h"
#include "gui/desktop/panels/SettingsPanel.h"
#include "gui/desktop/widgets/EnterKey.h"
#include "gui/desktop/widgets/FloatingDock.h"
#include "gui/desktop/widgets/FocusInSight.h"
#include "gui/desktop/widgets/ScrolledPanel.h"
#include "gui/desktop/widgets/WheelGuard.h"

#include <QAbstractItemView>
#include <QAction>
#include <QApplication>
#include <QCloseEvent>
#include <QJsonDocument>
#include <QPlainTextEdit>
#include <QScreen>
#include <QToolBar>
#include <QToolTip>

namespace hermes::desktop {
namespace {

constexpr QSize usualSize{1280, 720};
constexpr int titleRoom = 40;                      // of a window's title, pixels
constexpr std::chrono::milliseconds keepEach{500}; // who is killed a second later has lost nothing

/// A list or a tree, else a text, else what Tab leads to first.
QWidget *mainWidgetOf(QWidget *panel) {
    if (QWidget *const own = panel->focusProxy())
        return own;
    const auto isWanted = [panel](const QWidget *widget) {
        return widget->isVisibleTo(panel) && widget->isEnabled() && (widget->focusPolicy() & Qt::TabFocus);
    };
    for (auto *const view : panel->findChildren<QAbstractItemView *>())
        if (isWanted(view) && !view->inherits("QComboBoxListView"))
            return view;
    for (auto *const text : panel->findChildren<QPlainTextEdit *>())
        if (isWanted(text))
            return text;
    for (auto *const any : panel->findChildren<QWidget *>())
        if (isWanted(any))
            return any;
    return panel;
}

} // namespace

MainWindow::MainWindow(Fleet &fleet, DriveControl &drive, const QString &layoutFile, QWidget *parent)
    : QMainWindow(parent)
    , fleet_(fleet)
    , drive_(drive)
    , log_(fleet)
    , eventWatch_(fleet, log_, drive, events_)
    , runner_(fleet, drive)
    , layouts_(layoutFile)
    , keeper_(layouts_) {
    sounds_.switchTo(layouts_.value("sounds") != "off");
    setWindowTitle(tr("Hermes"));
    setDockNestingEnabled(true);
    setCorner(Qt::BottomLeftCorner, Qt::BottomDockWidgetArea);
    setCorner(Qt::BottomRightCorner, Qt::BottomDockWidgetArea);

    auto *const topBar = new TopBar(fleet, drive_);
    addFixedBar(*this, Qt::TopToolBarArea, tr("Robot"), "topBar", topBar);
    setCentralWidget(map_ = new MapPanel(fleet));
    auto *const gamepad = new DriveGamepad(drive_, layouts_, this);
    for (const PanelKind &kind : panelKinds())
        addPanel(kind, kind.make({fleet, drive_, *gamepad, log_, events_, sounds_, buttons_}));
    connect(&drive_.sessions(), &Sessions::changed, this, [this] {
        findChild<QDockWidget *>("recordings") // seen when its tab is behind others, too
            ->setWindowTitle(drive_.sessions().isRecording() ? tr("Recordings \u25cf") : tr("Recordings"));
    });
    addBars();
    banners_ = new Banners(*this, drive_, sounds_); // the last of them is the highest
    addKeys(*topBar);
    addMenus();
    arrange();
    restoreAll();
    connect(&keeping_, &QTimer::timeout, this, &MainWindow::keep);
    connect(&keeper_, &LayoutKeeper::failed, banners_, &Banners::notify);
    closeGuard_ = new CloseGuard(drive_, keeper_, *findChild<SettingsPanel *>(), this);
    connect(closeGuard_, &CloseGuard::ready, this, &MainWindow::close);
}

// What shows the models of this window goes before them.
MainWindow::~MainWindow() {
    delete closeGuard_; // what is written now closes nothing any more
    delete buttonBar_;
    for (FloatingDock *const dock : docks_)
        delete dock;
}

QStringList MainWindow::keptAddresses(const QString &layoutFile) {
    return Layouts(layoutFile).robots().addresses;
}

void MainWindow::addKeys(TopBar &topBar) {
    auto *const typing = new TypingWatch(this);
    auto *const keys = new DriveKeys(drive_, *typing, *this);
    connect(keys, &DriveKeys::drivesNothing, this, [] { // no banner: nothing is to move under the mouse
        if (const QWidget *const focus = QApplication::focusWidget())
            QToolTip::showText(
                focus->mapToGlobal(focus->rect().center()),
                tr("Keys go to what has the focus. After a click on the map, or Ctrl+6, they drive."));
    });
    const auto giveKeysToDrive = [this] { centralWidget()->setFocus(); };
    connect(&topBar, &TopBar::robotTaken, this, giveKeysToDrive, Qt::QueuedConnection);
    connect(findChild<DaemonTree *>(), &DaemonTree::takenByMouse, this, giveKeysToDrive);
    new EnterKey(*typing, *this);
    new FocusInSight(*centralWidget());
    new WheelGuard(*this);
    stopKeys_ = new StopKeys(drive_, topBar.stopButton()); // sees keys before the others
    stopKeys_->letEscapeStop(layouts_.value("escape") == "on");
}

/// What is kept between runs.
void MainWindow::restoreAll() {
    auto &plotSets = findChild<PlotsPanel *>()->sets();
    plotSets.setSets(objectOf(layouts_.value("plotSets")));
    connect(&plotSets, &PlotSets::changed, this,
            [this, &plotSets] { layouts_.setValue("plotSets", compactText(plotSets.sets())); });
    buttons_.setState(QJsonDocument::fromJson(layouts_.value("buttons").toUtf8()).array());
    connect(&buttons_, &Buttons::changed, this,
            [this] { layouts_.setValue("buttons", compactText(buttons_.state())); });
    drive_.setLimits(objectOf(layouts_.value("limits")));
    map_->setLayers(objectOf(layouts_.value("layers")).toVariantMap());
    showLayout();
    banners_->notify(
        QStringList{layouts_.problem(), layouts_.damage(), keeper_.problem()}.join(' ').trimmed());
    fleet_.setNames(layouts_.robots().names);
    fleet_.prefer(layouts_.robots().chosen);
}

void MainWindow::addPanel(const PanelKind &kind, QWidget *panel) {
    const QString title = tr(kind.title);
    auto *const dock = new FloatingDock(title, this);
    dock->setObjectName(kind.name);
    dock->setWidget(new ScrolledPanel(panel));
    addDockWidget(kind.area, dock);
    if (auto *const other = kind.tabbedWith ? findChild<QDockWidget *>(kind.tabbedWith) : nullptr)
        tabifyDockWidget(other, dock);
    docks_.push_back(dock);
    connect(dock, &QDockWidget::visibilityChanged, this, [this, dock](bool isSeen) {
        if (!isSeen && isVisible() && focusWidget() && dock->isAncestorOf(focusWidget()))
            centralWidget()->setFocus(); // what is typed on is not for what lies behind now
    });
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

void MainWindow::addMenus() {
    auto *const menus = new MenuBar(this);
    menus->addRobot(drive_, *stopKeys_);
    menus->addMap(*map_);
    menus->addRecording(panelActions_);
    menus->addPanels(showPanels_);
    menus->addMenu(makeLayoutMenu());
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

void MainWindow::addBars() {
    auto *const events = new EventBar(events_, sounds_);
    addFixedBar(*this, Qt::BottomToolBarArea, tr("Last event"), "eventBar", events);
    connect(events, &EventBar::listWanted, this, [this] { showPanel("events"); });
    auto *const buttons = new ButtonBar(fleet_, buttons_, runner_);
    addToolBarBreak(Qt::BottomToolBarArea); // a line of their own, above that of events
    buttonBar_ = addFixedBar(*this, Qt::BottomToolBarArea, tr("Buttons"), "buttonBar", buttons);
    connect(buttons, &ButtonBar::editWanted, this, [this] {
        showPanel("commands");
        findChild<CommandsPanel *>()->editButtons();
    });
    connect(&buttons_, &Buttons::changed, this, [this] { buttonBar_->setVisible(!buttons_.all().empty()); });
}

void MainWindow::showPanel(const QString &name) {
    auto *const dock = findChild<QDockWidget *>(name);
    dock->show();
    dock->raise();
    QWidget *const panel = static_cast<ScrolledPanel *>(dock->widget())->widget();
    (name == "drive" ? centralWidget() : mainWidgetOf(panel))->setFocus(Qt::ShortcutFocusReason);
}

void MainWindow::arrange() {
    const bool hasScreen = QGuiApplication::platformName() != "offscreen"; // whose screen nobody has
    resize(hasScreen ? usualSize.boundedTo(screen()->availableSize() - QSize(0, titleRoom)) : usualSize);
    resizeDocks({docks_.front(), findChild<QDockWidget *>("drive")}, {300, 240}, Qt::Horizontal);
    resizeDocks({docks_[1]}, {220}, Qt::Vertical);
    docks_[0]->raise();
    docks_[1]->raise();
    usual_ = saveState();
}

QMenu *MainWindow::makeLayoutMenu() {
    auto *const menu = new LayoutMenu(layouts_, keeper_, this);
    const auto change = [this](const Result<void> &changed) {
        if (!changed)
            return banners_->notify(changed.error().message);
        showLayout();
        keep();
    };
    connect(menu, &LayoutMenu::chosen, this, [this, change](const QString &name) {
        keepAll();
        change(layouts_.choose(name));
    });
    connect(menu, &LayoutMenu::savedAs, this, [this, change](const QString &name) {
        keepAll();
        change(layouts_.saveAs(name));
    });
    connect(menu, &LayoutMenu::removalWanted, this, [this, change] { change(layouts_.remove()); });
    connect(menu, &LayoutMenu::resetWanted, this, &MainWindow::resetLayout);
    return menu;
}

void MainWindow::showLayout() {
    const Layouts::Layout layout = layouts_.layout();
    if (!layout.geometry.isEmpty())
        restoreGeometry(layout.geometry);
    if (!restorePanels(layout.state))
        restorePanels(usual_);
    showBars();
    findChild<PlotsPanel *>()->setState(layout.plots);
    centralWidget()->setFocus(); // so that the keys drive
}

/// Whatever was in sight when the layout was kept, STOP is always, and a banner while it has something to
/// say.
void MainWindow::showBars() {
    for (const char *const always : {"topBar", "eventBar"})
        findChild<QToolBar *>(always)->show();
    banners_->show();
    buttonBar_->setVisible(!buttons_.all().empty());
}

bool MainWindow::restorePanels(const QByteArray &state) {
    for (FloatingDock *const dock : docks_)
        dock->setRestoring(true);
    const bool isRestored = restoreState(state);
    for (FloatingDock *const dock : docks_)
        dock->setRestoring(false);
    return isRestored;
}

void MainWindow::resetLayout() {
    restorePanels(usual_);
    showBars();
    centralWidget()->setFocus();
}

void MainWindow::keepAll() {
    layouts_.setLayout({saveGeometry(), saveState(), findChild<PlotsPanel *>()->state()});
    layouts_.setValue("sounds", sounds_.areOn() ? "on" : "off");
    layouts_.setValue("escape", stopKeys_->doesEscapeStop() ? "on" : "off");
    layouts_.setValue("limits", compactText(drive_.limits()));
    layouts_.setValue("layers", compactText(QJsonObject::fromVariantMap(map_->layers())));
    layouts_.setRobots({fleet_.addresses(), fleet_.names(), fleet_.preferred()});
}

// Now and then, whatever was set, for the window may not be closed in order.
void MainWindow::keep() {
    keepAll();
    keeper_.keep();
}

void MainWindow::showEvent(QShowEvent *event) {
    keeping_.start(keepEach);
    QMainWindow::showEvent(event);
    QTimer::singleShot(0, this, [this] { // when the window itself is there
        for (FloatingDock *const dock : docks_)
            dock->comeForward();
    });
}

bool MainWindow::focusNextPrevChild(bool isNext) {
    return FocusInSight::move(*this, isNext);
}

void MainWindow::leave() {
    closeGuard_->closeAnyway();
    close();
}

void MainWindow::closeEvent(QCloseEvent *event) {
    drive_.halt();
    keepAll();
    const QString objection = closeGuard_->objection();
    banners_->notify(objection);
    if (!objection.isEmpty())
        return event->ignore();
    keeping_.stop();
    event->accept();
}

} // namespace hermes::desktop
