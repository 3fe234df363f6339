#include "gui/desktop/HelpWindow.h"
#include "gui/desktop/MenuBar.h"
#include "gui/desktop/drive/StopKeys.h"
#include "tests/gui/desktop/OpenWindow.h"

#include <QAccessible>
#include <QTextBlock>
#include <QTextBrowser>

using namespace hermes;

/// All actions of the menu bar, those of menus in menus too.
static QList<QAction *> actionsOf(const QList<QAction *> &actions) {
    QList<QAction *> all;
    for (QAction *action : actions)
        all += action->menu() ? actionsOf(action->menu()->actions()) : QList<QAction *>{action};
    return all;
}

static QString topLineOf(const QTextBrowser &text) {
    return text.textCursor().block().text();
}

/// All that the window can do is found by name, with its key and with help.
class TestMenus : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void everyKeyIsInAMenuAndInTheManual() {
        OpenWindow open;
        const QString manual =
            QString::fromUtf8(contentOf(qEnvironmentVariable("HERMES_SOURCE") + "/docs/desktop.md"));
        const QList<QAction *> inMenus = actionsOf(open.window.menuBar()->actions());
        QVERIFY(inMenus.size() > 30);
        int keys = 0;
        for (const QAction *action : open.window.findChildren<QAction *>()) {
            if (action->shortcut().isEmpty())
                continue;
            ++keys;
            const QString key = action->shortcut().toString();
            QVERIFY2(inMenus.contains(const_cast<QAction *>(action)), qPrintable(action->text() + ' ' + key));
            QVERIFY2(manual.contains(key), qPrintable(key));
        }
        QVERIFY(keys >= 11);
    }

    void closedPanelsComeBack() {
        OpenWindow open;
        QVERIFY(open.show());
        const auto panels = open.window.menuBar()->findChild<QMenu *>("panelsMenu")->actions();
        const auto docks = open.window.findChildren<QDockWidget *>(QString(), Qt::FindDirectChildrenOnly);
        QCOMPARE(panels.size(), docks.size());
        for (QDockWidget *dock : docks)
            dock->close();
        for (QAction *panel : panels)
            panel->trigger();
        for (const QDockWidget *dock : docks)
            QVERIFY2(!dock->isHidden(), qPrintable(dock->objectName()));
    }

    void helpIsOfThePanelWithTheFocus() {
        OpenWindow open;
        QVERIFY(open.show());
        QTest::keyClick(&open.window, Qt::Key_4, Qt::ControlModifier); // the log
        QTest::keyClick(QApplication::focusWidget(), Qt::Key_F1);
        auto *const help = open.window.findChild<HelpWindow *>();
        QVERIFY(help && help->isVisible() && !help->isModal());
        auto *const text = help->findChild<QTextBrowser *>("helpText");
        QCOMPARE(topLineOf(*text), QString("Log (Ctrl+4)"));
        open.window.activateWindow();
        open.window.centralWidget()->setFocus();
        QTest::keyClick(QApplication::focusWidget(), Qt::Key_F1);
        QCOMPARE(topLineOf(*text), QString("The map"));
        QVERIFY(!text->toPlainText().contains("desktop-"));
    }

    void helpHasEveryPanel() {
        OpenWindow open;
        HelpWindow help(&open.window);
        auto *const text = help.findChild<QTextBrowser *>("helpText");
        for (const QAction *panel : open.window.menuBar()->findChild<QMenu *>("panelsMenu")->actions()) {
            const QString key = panel->shortcut().toString();
            const QString title = panel->text() + (key.isEmpty() ? key : " (" + key + ')');
            help.showAt(title);
            QVERIFY2(topLineOf(*text).startsWith(panel->text()), qPrintable(title));
        }
        help.showAt("Keys");
        QCOMPARE(topLineOf(*text), QString("Keys"));
        help.showAt("no such place");
        QCOMPARE(topLineOf(*text), QString("The operator's window"));
    }

    void escapeStopsOnlyWhenToldTo() {
        OpenWindow open;
        QVERIFY(open.show());
        open.window.centralWidget()->setFocus();
        QTest::keyClick(open.window.centralWidget()->focusProxy(), Qt::Key_Escape);
        QVERIFY(!open.drive.isStopped());
        open.window.findChild<QAction *>("escapeStops")->trigger();
        QTest::keyClick(open.window.centralWidget()->focusProxy(), Qt::Key_Escape);
        QVERIFY(open.drive.isStopped());
    }

    void everyControlHasAName() {
        OpenWindow open;
        QVERIFY(open.show());
        int count = 0;
        QStringList nameless;
        for (QWidget *widget : open.window.findChildren<QWidget *>()) {
            const QString name = widget->objectName();
            const bool isControl = qobject_cast<QAbstractButton *>(widget) ||
                                   qobject_cast<QLineEdit *>(widget) || qobject_cast<QComboBox *>(widget) ||
                                   qobject_cast<QAbstractItemView *>(widget);
            if (!isControl || name.startsWith("qt_") || widget->inherits("QHeaderView") ||
                widget->inherits("QComboBoxListView") || widget->inherits("QLineEditIconButton") ||
                qobject_cast<QDockWidget *>(widget->parentWidget()) || widget->inherits("QTableCornerButton"))
                continue;
            const QAccessibleInterface *const told = QAccessible::queryAccessibleInterface(widget);
            QVERIFY(told);
            const auto *const field = qobject_cast<QLineEdit *>(widget);
            const QString said = told->text(QAccessible::Name) + told->text(QAccessible::Description) +
                                 (field ? field->placeholderText() : QString());
            if (said.isEmpty())
                nameless.append(QString("%1 \"%2\" in %3")
                                    .arg(widget->metaObject()->className(), name,
                                         widget->parentWidget()->metaObject()->className()));
            ++count;
        }
        QVERIFY(count > 30);
        QVERIFY2(nameless.isEmpty(), qPrintable(nameless.join("\n")));
    }

    void whatIsAskedTwiceIsOpenOnce() {
        OpenWindow open;
        QVERIFY(open.show());
        for (const char *const name : {"export", "csv", "saveSet", "saveLayoutAs", "about"}) {
            QDialog *first = nullptr;
            for (int i = 0; i < 2; ++i) {
                if (auto *const menu = open.window.findChild<QMenu *>("layoutMenu"))
                    Q_EMIT menu->aboutToShow(); // fills it
                if (auto *const action = open.window.findChild<QAction *>(name))
                    action->trigger();
                else
                    open.window.findChild<QAbstractButton *>(name)->click();
                QList<QDialog *> seen;
                for (auto *const dialog : open.window.findChildren<QDialog *>())
                    if (dialog->isVisible())
                        seen.append(dialog);
                QVERIFY2(seen.size() == 1, saying("%1: %2", name, seen.size()));
                QVERIFY(seen[0] != first);
                QVERIFY(!seen[0]->isModal());
                first = seen[0];
            }
            first->close();
        }
    }
};
