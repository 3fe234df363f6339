#include "common/Time.h"
#include "gui/desktop/panels/PlotSets.h"
#include "gui/desktop/view/PlotPane.h"
#include "tests/gui/desktop/PlotWindow.h"

#include <QFileDialog>
#include <QImageReader>
#include <QInputDialog>
#include <QTabBar>

using namespace hermes;
using namespace hermes::desktop;

/// The plots of the window: panes, axes, sets, files and Pause.
class TestPlots : public QObject, protected PlotWindow {
    Q_OBJECT
private Q_SLOTS:
    void init() { open(drive()); }
    void cleanup() { close(); }

    void twoClicksToAPlot() {
        for (QTabBar *bar : window_->window.findChildren<QTabBar *>())
            for (int i = 0; i < bar->count(); ++i)
                if (bar->tabText(i) == "Plots")
                    QTest::mouseClick(bar, Qt::LeftButton, {}, bar->tabRect(i).center());
        QTRY_VERIFY(panel_->isVisible());
        QTRY_VERIFY(panel_->findChild<QPushButton *>("suggestion"));
        QStringList texts;
        for (const auto *button : panel_->findChildren<QPushButton *>("suggestion"))
            texts.append(button->text());
        QCOMPARE(texts, (QStringList{"drive: vx, vy (m/s)", "drive: battery (V)"}));
        OpenWindow::click(panel_, "suggestion");
        QCOMPARE(panel_->board().curves(), 2);
        QCOMPARE(QApplication::focusWidget(), panel_->board().panes()[0]); // whose keys drive
        subscribed("drive");
        sayVx(stampNow(), 0.4);
        QTRY_VERIFY(!panel_->board().panes()[0]->visibleRegion().isEmpty());
        QTRY_COMPARE(panel_->board().panes()[0]->valueText(0), QString("0.400 m/s"));
        QCOMPARE(row("vx")->checkState(0), Qt::Checked); // and can be taken away there
        QTest::keyClick(&window_->window, Qt::Key_1, Qt::ControlModifier);
        QTest::keyClick(&window_->window, Qt::Key_5, Qt::ControlModifier);
        QCOMPARE(QApplication::focusWidget(), panel_->board().panes()[0]);
    }

    void panesAndAxes() {
        raise();
        openTopic("drive");
        QCOMPARE(row("drive")->childCount(), 3); // before any message
        QCOMPARE(row("vx")->text(1), QString("m/s"));
        QRect box = tree_->visualItemRect(row("vx"));
        QTest::mouseClick(tree_->viewport(), Qt::LeftButton, {}, box.topLeft() + QPoint(8, box.height() / 2));
        QVERIFY(panel_->board().has(field("vx")));
        box = tree_->visualItemRect(row("battery"));
        QTest::mouseClick(tree_->viewport(), Qt::LeftButton, {},
                          QPoint(tree_->viewport()->width() - 5, box.center().y()));
        QTest::keyClick(tree_, Qt::Key_Return);
        QVERIFY(panel_->board().has(field("battery")));
        const auto lines = [this](int pane) {
            return panel_->board().panes()[std::size_t(pane)]->scene().lines;
        };
        QCOMPARE(int(lines(0).size()), 2);
        QVERIFY(!lines(0)[0].isRight);
        QVERIFY(lines(0)[1].isRight); // volts are no speed
        QVERIFY(lines(0)[0].pen.color() != lines(0)[1].pen.color());

        panel_->findChild<QAction *>("addPane")->trigger();
        QCOMPARE(int(panel_->board().panes().size()), 2);
        row("vy")->setCheckState(0, Qt::Checked);
        QCOMPARE(int(lines(1).size()), 1);
        QTRY_VERIFY(panel_->board().panes()[1]->isVisible());
        QTest::mouseClick(panel_->board().panes()[0], Qt::LeftButton);
        QCOMPARE(panel_->board().chosenPane(), 0);
        panel_->board().panes()[1]->setFocus(Qt::TabFocusReason); // by keyboard
        QCOMPARE(panel_->board().chosenPane(), 1);
        panel_->board().panes()[0]->setFocus(Qt::TabFocusReason);
        QCOMPARE(panel_->board().chosenPane(), 0);
        row("vy")->setCheckState(0, Qt::Unchecked);
        row("vy")->setCheckState(0, Qt::Checked);
        QCOMPARE(int(lines(0).size()), 3);
        QVERIFY(lines(1).empty());
        panel_->findChild<QAction *>("removePane")->trigger();
        QCOMPARE(int(panel_->board().panes().size()), 1);
        QCOMPARE(panel_->board().curves(), 0);
        QCOMPARE(row("vx")->checkState(0), Qt::Unchecked);
        panel_->findChild<QAction *>("removePane")->trigger(); // there is always one
        QCOMPARE(int(panel_->board().panes().size()), 1);
        for (int i = 0; i < 20; ++i)
            panel_->findChild<QAction *>("addPane")->trigger();
        QCOMPARE(int(panel_->board().panes().size()), PlotBoard::maxPanes);
        QVERIFY(window_->window.height() <= 720); // no higher for it
    }

    void setsAreKept() {
        QTemporaryDir folder;
        const QString file = folder.filePath("gui.json");
        for (int start = 0; start < 3; ++start) {
            MainWindow window(window_->fleet, window_->drive, file);
            window.show();
            window.findChild<QDockWidget *>("plots")->raise();
            auto *const panel = window.findChild<PlotsPanel *>();
            PlotBoard &board = panel->board();
            const auto choose = [panel](const QString &name) {
                panel->sets().popup({});
                for (QAction *action : panel->sets().actions())
                    if (action->text() == name)
                        action->trigger();
                panel->sets().close();
            };
            if (start == 0) {
                QVERIFY(board.add(field("vx")));
                board.addPane();
                QVERIFY(board.add(field("battery")));
                board.time().setSpan(60);
                panel->findChild<QAction *>("saveSet")->trigger();
                auto *const dialog = window.findChild<QInputDialog *>();
                QVERIFY(dialog && dialog->isVisible() && !dialog->isModal());
                auto *const name = dialog->findChild<QLineEdit *>();
                dialog->activateWindow();
                QTRY_VERIFY(name->hasFocus()); // else Space is STOP
                QTest::keyClicks(name, "Speed & battery");
                QTest::keyClick(name, Qt::Key_Return);
                QCOMPARE(panel->sets().sets().keys(), QStringList{"Speed & battery"});
                QTRY_VERIFY(Layouts(file).value("plotSets").contains("Speed & battery")); // while it is open
                panel->setState({});
                QVERIFY(board.add(field("vy")));
            } else if (start == 1) {
                QVERIFY(board.has(field("vy")) && board.curves() == 1); // as it was
                choose("Speed && battery");
                QVERIFY(board.has(field("vx")) && board.has(field("battery")) && board.curves() == 2);
                QCOMPARE(int(board.panes().size()), 2);
                QCOMPARE(board.time().span_s(), 60.0);
                panel->sets().findChild<QMenu *>()->actions().value(0)->trigger(); // deletes it
                QVERIFY(panel->sets().sets().isEmpty());
            } else {
                QCOMPARE(int(board.panes().size()), 2); // as it was
                QVERIFY(panel->sets().sets().isEmpty());
            }
            window.close();
        }
        PlotBoard &board = panel_->board(); // what nobody has written so
        board.setState(
            {{"span_s", "long"}, {"panes", QJsonArray{5, QJsonArray{QJsonObject{{"topic", 7}}, {}}}}});
        QCOMPARE(board.curves(), 0);
    }

    void filesHoldWhatIsShown() {
        raise();
        QVERIFY(panel_->board().add(field("vx")));
        QVERIFY(panel_->board().add({address_, "dri\"ve,", "x\ny"}));
        subscribed("drive");
        const double now = std::floor(stampNow());
        for (int i = 0; i < 4; ++i)
            sayVx(now - 4 + i, 0.25 * i);
        QTemporaryDir folder;
        const auto read = [&](const QString &name) {
            const QString file = folder.filePath(name);
            if (const auto done = panel_->exportTo(file); !done)
                return "failed: " + done.error().message.toUtf8();
            return contentOf(file);
        };
        const QString daemon = window_->fleet.robots().front()->daemons().front()->name();
        QVERIFY(!daemon.isEmpty() && daemon != address_);
        QByteArray expected = "stamp,daemon,topic,field,value,unit\n";
        for (int i = 0; i < 4; ++i)
            expected += QByteArray::number(now - 4 + i, 'f', 0) + ',' + daemon.toUtf8() + ",drive,vx," +
                        QByteArray::number(0.25 * i) + ",m/s\n";
        QCOMPARE(read("curves.csv"), expected);

        panel_->findChild<QAction *>("csv")->trigger(); // by hand, beside the event loop
        auto *const dialog = window_->window.findChild<QFileDialog *>();
        QVERIFY(dialog && !dialog->isModal());
        dialog->selectFile(folder.filePath("by-hand.csv"));
        QVERIFY(QMetaObject::invokeMethod(dialog, "accept"));
        auto *const told = panel_->findChild<QLabel *>("message");
        QTRY_VERIFY2(told->text().startsWith("Wrote ") && told->isVisible(), qPrintable(told->text()));
        QCOMPARE(contentOf(folder.filePath("by-hand.csv")), expected);

        const QByteArray svg = read("curves.svg");
        QVERIFY2(svg.contains("<svg") && svg.contains("drive vx") && svg.contains("0.750 m/s") &&
                     svg.contains("<polyline") && svg.contains("-10 s"),
                 svg);
        QVERIFY(read("curves.png").startsWith("\x89PNG"));
        QCOMPARE(QImageReader(folder.filePath("curves.png")).size(), panel_->board().size());
        for (const char *name : {"nowhere/curves.csv", "nowhere/curves.svg", "nowhere/curves.png"})
            QVERIFY2(read(name).contains("nowhere/curves"), name);
    }

    void pictureStandsWhilePaused() {
        raise();
        QVERIFY(panel_->board().add(field("vx")));
        subscribed("drive");
        sayVx(stampNow(), 1);
        PlotPane *const pane = panel_->board().panes()[0];
        QTRY_COMPARE(pane->valueText(0), QString("1 m/s"));
        OpenWindow::click(panel_, "pause");
        const double held = pane->scene().lines[0].now;
        QTest::qWait(300);
        sayVx(stampNow(), 2);
        QCOMPARE(pane->valueText(0), QString("1 m/s"));
        QCOMPARE(pane->scene().lines[0].now, held);
        QTest::keyClick(pane, Qt::Key_PageUp);
        QVERIFY(panel_->board().time().right_s() < 0);
        OpenWindow::click(panel_, "live");
        QVERIFY(!panel_->findChild<QPushButton *>("pause")->isChecked());
        QTRY_COMPARE(pane->valueText(0), QString("2 m/s"));
        QTRY_VERIFY(pane->scene().lines[0].isOld); // grey
        QTRY_VERIFY_WITH_TIMEOUT(pane->valueText(0).startsWith("no data for "), 10000);
    }
};

QTEST_MAIN(TestPlots)
#include "TestPlots.moc"
