#pragma once

#include "gui/desktop/MainWindow.h"
#include "gui/desktop/Theme.h"
#include "gui/desktop/panels/MapPanel.h"
#include "tests/gui/desktop/RobotProcesses.h"

namespace hermes {

/// The operator's window on the daemons of a robot, and hands that click and type in it.
class OpenWindow {
public:
    OpenWindow() = default; // on nobody
    explicit OpenWindow(RobotProcesses &robot) { robot.connectTo(fleet); }
    /// On a motor control alone, at this address.
    explicit OpenWindow(const QString &motors) {
        [&] {
            QVERIFY(fleet.add(motors).ok());
            QTRY_VERIFY_WITH_TIMEOUT(drive.stateAge().isFresh(), 10000);
        }();
    }

    /// To be verified first: what one does in a window that is not active goes nowhere.
    bool show() {
        window.show();
        window.activateWindow();
        return QTest::qWaitForWindowActive(&window);
    }
    /// Brings a dock to the front and gives its panel.
    template <typename Panel>
    Panel *panel(const QString &dock) {
        auto *const found = window.findChild<QDockWidget *>(dock);
        found->show();
        found->raise();
        return window.findChild<Panel *>();
    }
    /// Clicks at the row of a daemon in the tree of daemons.
    bool choose(DaemonLink *daemon) {
        auto *const tree = window.findChild<QTreeWidget *>("tree");
        QTreeWidgetItem *const item = row(daemon);
        if (!item)
            return false;
        tree->scrollToItem(item);
        QTest::mouseClick(tree->viewport(), Qt::LeftButton, {}, tree->visualItemRect(item).center());
        return fleet.daemon() == daemon;
    }
    /// The row of a daemon in the tree; null: none.
    QTreeWidgetItem *row(const DaemonLink *daemon) const {
        for (QTreeWidgetItemIterator i(window.findChild<QTreeWidget *>("tree")); *i; ++i)
            if (daemon && (*i)->data(0, Qt::UserRole).value<QObject *>() == daemon)
                return *i;
        return nullptr;
    }
    /// Whether the map shows something in the colour of what is well.
    bool isGreenSeen() {
        const QImage picture = window.map().view().grab().toImage().convertToFormat(QImage::Format_RGB32);
        const QRgb green = theme::colour(Condition::Ready).rgb();
        for (int y = 0; y < picture.height(); ++y)
            for (int x = 0; x < picture.width(); ++x)
                if (picture.pixel(x, y) == green)
                    return true;
        return false;
    }
    /// Clicks as soon as the button can be clicked.
    static void click(QWidget *panel, const QString &button) {
        auto *const found = panel->findChild<QAbstractButton *>(button);
        QTRY_VERIFY2(found && found->isEnabled() && found->isVisible(), qPrintable(button));
        QTest::mouseClick(found, Qt::LeftButton);
    }
    /// Replaces the text of a field by typing.
    static void type(QLineEdit *field, const QString &text) {
        QTRY_VERIFY(field && field->isVisible()); // a new one is shown with the next event
        field->setFocus();
        field->selectAll();
        QTest::keyClick(field, Qt::Key_Delete);
        QTest::keyClicks(field, text);
    }

    Fleet fleet;
    DriveControl drive{fleet};
    MainWindow window{fleet, drive, QString()};
};

} // namespace hermes
