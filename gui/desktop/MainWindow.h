#pragma once

#include "gui/desktop/LayoutKeeper.h"
#include "gui/desktop/model/EventWatch.h"
#include "gui/desktop/model/MacroRunner.h"
#include "gui/desktop/panels/Panels.h"

#include <QMainWindow>

class QToolBar;

namespace hermes::desktop {

class Banners;
class CloseGuard;
class FloatingDock;
class HelpWindow;
class MapPanel;
class StopKeys;
class TopBar;

/// The operator's window: the map in the middle, docks around it, the bar with STOP above. Ctrl+1 to Ctrl+9
/// and Ctrl+0 bring the docks to the front.
class MainWindow : public QMainWindow {
    Q_OBJECT
public:
    /// layoutFile: where layouts and robots are kept between runs (Layouts); empty: nowhere.
    MainWindow(Fleet &fleet, DriveControl &drive, const QString &layoutFile, QWidget *parent = nullptr);
    ~MainWindow() override;
    /// The addresses of robots that are kept there.
    static QStringList keptAddresses(const QString &layoutFile);
    const Layouts &layouts() const { return layouts_; }
    MapPanel &map() { return *map_; }
    /// Closes the window without a question.
    void leave();

protected:
    void showEvent(QShowEvent *event) override;
    void closeEvent(QCloseEvent *event) override;
    bool focusNextPrevChild(bool isNext) override;

private:
    void addKeys(TopBar &topBar);
    void restoreAll();
    void addPanel(const PanelKind &kind, QWidget *panel);
    void addMenus();
    void showHelp();
    HelpWindow &help();
    void addBars();
    void showPanel(const QString &name);
    void arrange();
    QMenu *makeLayoutMenu();
    /// Shows what is kept of the current layout; what is not is as at the first start.
    void showLayout();
    bool restorePanels(const QByteArray &state);
    void showBars();
    void resetLayout();
    /// Takes down what the operator has set.
    void keepAll();
    /// The same, and has it saved when it has changed.
    void keep();

    Fleet &fleet_;
    DriveControl &drive_;
    Sounds sounds_;
    LogFeed log_;
    Events events_;
    EventWatch eventWatch_;
    Buttons buttons_;
    MacroRunner runner_;
    MapPanel *map_;
    Layouts layouts_;
    LayoutKeeper keeper_;
    QByteArray usual_; ///< how the panels are arranged at the first start
    std::vector<FloatingDock *> docks_;
    QList<QAction *> showPanels_;
    QList<QAction *> panelActions_; ///< with keys of their own
    HelpWindow *help_ = nullptr;
    StopKeys *stopKeys_;
    Banners *banners_ = nullptr;
    QTimer keeping_;
    CloseGuard *closeGuard_ = nullptr;
    QToolBar *buttonBar_ = nullptr;
};

} // namespace hermes::desktop
