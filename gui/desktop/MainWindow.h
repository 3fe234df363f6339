#pragma once

#include "gui/desktop/model/EventWatch.h"
#include "gui/desktop/panels/Panels.h"

#include <QMainWindow>

class QDockWidget;
class QToolBar;

namespace hermes::desktop {

class Banner;
class HelpWindow;
class MapPanel;
class StopKeys;

/// The operator's window: the map in the middle, docks around it, the bar with STOP above. Ctrl+1 to Ctrl+9
/// and Ctrl+0 bring the docks to the front.
class MainWindow : public QMainWindow {
    Q_OBJECT
public:
    /// layoutFile: where the layout, what is plotted and the addresses of robots are kept between runs;
    /// empty: nowhere.
    MainWindow(Fleet &fleet, DriveControl &drive, const QString &layoutFile, QWidget *parent = nullptr);
    ~MainWindow() override;
    /// The addresses that the last window with this layout had.
    static QStringList keptAddresses(const QString &layoutFile);
    MapPanel &map() { return *map_; }

protected:
    void closeEvent(QCloseEvent *event) override;

private:
    void addBanner(Banner *banner, const char *name);
    void addPanel(const PanelKind &kind, QWidget *panel);
    void addEventBar();
    void addMenus(StopKeys &keys);
    void showHelp();
    HelpWindow &help();
    void showPanel(const QString &name);
    void restoreLayout();
    void saveLayout() const;

    Fleet &fleet_;
    DriveControl &drive_;
    Sounds sounds_;
    LogFeed log_;
    Events events_;
    EventWatch eventWatch_;
    MapPanel *map_;
    const QString layoutFile_;
    std::vector<QDockWidget *> docks_;
    QList<QAction *> showPanels_;
    QList<QAction *> panelActions_; ///< with keys of their own
    HelpWindow *help_ = nullptr;
    std::vector<QToolBar *> banners_;
};

} // namespace hermes::desktop
