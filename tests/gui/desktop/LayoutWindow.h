#pragma once

#include "gui/desktop/LayoutMenu.h"
#include "gui/desktop/MainWindow.h"
#include "gui/desktop/panels/PlotsPanel.h"

#include <QInputDialog>

namespace hermes {

using namespace desktop;

/// A window that keeps what is set in a file, and begins with what is kept there.
struct LayoutWindow {
    explicit LayoutWindow(const QString &file, const QStringList &addresses = {}) {
        for (const QString &address : addresses.isEmpty() ? MainWindow::keptAddresses(file) : addresses)
            fleet.add(address);
        drive = std::make_unique<DriveControl>(fleet);
        window = std::make_unique<MainWindow>(fleet, *drive, file);
        window->show();
    }
    QWidget *dock(const char *name) const { return window->findChild<QDockWidget *>(name); }
    LayoutMenu &menu() const { return *window->findChild<LayoutMenu *>(); }
    /// Opens the menu and presses one of what is in it.
    void pick(const QString &name) const {
        Q_EMIT menu().aboutToShow();
        auto *const action = menu().findChild<QAction *>(name);
        QVERIFY2(action && action->isEnabled(), qPrintable(name));
        action->trigger();
    }
    void saveAs(const QString &name) const {
        pick("saveLayoutAs");
        auto *const dialog = window->findChildren<QInputDialog *>("layoutName").back();
        QVERIFY(dialog->isVisible() && !dialog->isModal());
        dialog->setTextValue(name);
        dialog->accept();
    }
    QJsonArray plots() const {
        return window->findChild<PlotsPanel *>()->state()["panes"].toArray()[0].toArray();
    }
    QString notice() const { return window->findChild<QLabel *>("noticeBanner")->text(); }
    bool isWhole() const {
        auto *const stop = window->findChild<QPushButton *>("stop");
        return stop->isVisible() && window->findChild<QToolBar *>("topBar")->isVisible();
    }

    Fleet fleet;
    std::unique_ptr<DriveControl> drive;
    std::unique_ptr<MainWindow> window;
};

} // namespace hermes
