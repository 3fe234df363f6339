#pragma once

#include "gui/desktop/drive/DriveControl.h"
#include "gui/desktop/widgets/Sounds.h"

#include <vector>

class QMainWindow;
class QToolBar;

namespace hermes::desktop {

class Banner;

/// A tool bar of the window that stays where it is, and holds one widget.
QToolBar *addFixedBar(QMainWindow &window, Qt::ToolBarArea area, const QString &title, const char *name,
                      QWidget *content);

/// What lies across the window: STOP, a replay, and notes that go by themselves. At the foot: the robots, the
/// map and the stick do not move under the mouse when one comes.
class Banners : public QObject {
    Q_OBJECT
public:
    Banners(QMainWindow &window, DriveControl &drive, Sounds &sounds);

    /// For 20 s, and on the standard error output.
    void notify(const QString &problem);
    /// Those that say something are seen, whatever a layout has kept.
    void show();

private:
    void add(Banner *banner, const char *name);

    QMainWindow &window_;
    std::vector<std::pair<Banner *, QToolBar *>> all_;
    Banner *note_;
    QTimer noticed_;
};

} // namespace hermes::desktop
