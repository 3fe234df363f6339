#include "gui/desktop/panels/CommandsPanel.h"
#include "gui/desktop/panels/LogPanel.h"
#include "gui/desktop/panels/PlotsPanel.h"
#include "gui/desktop/view/PlotPane.h"
#include "tests/gui/desktop/OpenWindow.h"

using namespace hermes;

/// The console, the log and the plots of a robot in the simulator.
class TestConsolePanels : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void initTestCase() {
        robot_ = std::make_unique<RobotProcesses>();
        robot_->startMotors();
        window_ = std::make_unique<OpenWindow>(*robot_);
        QVERIFY(window_->show());
        QVERIFY(window_->choose(daemon("simulator")));
    }

    void commandWithParameters() {
        chooseMethod("sim.place");
        QVERIFY(!commands()->findChild<QPushButton *>("call")->isEnabled()); // x and y are missing
        OpenWindow::type(parameter("x"), "0.5");
        OpenWindow::type(parameter("y"), "-0.25");
        OpenWindow::type(parameter("theta"), "1");
        OpenWindow::click(commands(), "call");
        QTRY_VERIFY(answer().startsWith("sim.place: "));
        QVERIFY2(answer().contains(" ms") && !answer().contains("Error"), qPrintable(answer()));
    }

    void wrongParametersAreToldAtTheirRows() {
        chooseMethod("sim.place");
        OpenWindow::type(parameter("x"), "here");
        QVERIFY(commands()->findChild<QLabel *>("x/note")->text().startsWith("expected"));
        QVERIFY(!commands()->findChild<QPushButton *>("call")->isEnabled());
    }

    void refusedCommandShowsItsError() {
        QVERIFY(window_->choose(daemon("motorcontrol")));
        chooseMethod("motor.drive"); // without the control
        OpenWindow::click(commands(), "call");
        TRY_CONTAINS(answer(), "Error -3200");
        QVERIFY(window_->choose(daemon("simulator")));
    }

    void commandsAreFound() {
        auto *const methods = commands()->findChild<QListWidget *>("methods");
        auto *const filter = commands()->findChild<QLineEdit *>("filter");
        const int all = methods->count();
        OpenWindow::type(filter, "settings.");
        QVERIFY(methods->count() >= 4 && methods->count() < all);
        OpenWindow::type(filter, "no such command");
        QCOMPARE(methods->count(), 0);
        QVERIFY(!commands()->findChild<QPushButton *>("call")->isEnabled());
        OpenWindow::type(filter, "");
        QCOMPARE(methods->count(), all);
    }

    void whatForgetsAsksFirst() {
        QVERIFY(window_->choose(daemon("motorcontrol")));
        auto *const run = commands()->findChild<QPushButton *>("call");
        QVERIFY(!commands()->findChild<QListWidget *>("methods")->currentItem()); // none is chosen by itself
        QVERIFY(!run->isEnabled());
        chooseMethod("settings.reset");
        QCOMPARE(run->text(), QString("Ru&n"));
        const QString before = answer();
        OpenWindow::click(commands(), "call");
        QVERIFY2(run->text().contains("settings.reset now") && run->text().contains("the settings"),
                 qPrintable(run->text()));
        QCOMPARE(answer(), before);
        chooseMethod("daemon.info"); // thought better of it
        QCOMPARE(run->text(), QString("Ru&n"));
        chooseMethod("settings.reset");
        OpenWindow::click(commands(), "call");
        QCOMPARE(answer(), before);
        OpenWindow::click(commands(), "call"); // a double click
        QTest::qWait(600);
        QCOMPARE(answer(), before);
        OpenWindow::click(commands(), "call");
        TRY_STARTS(answer(), "settings.reset: ");
        QCOMPARE(run->text(), QString("Ru&n"));
        QVERIFY(window_->choose(daemon("simulator")));
    }

    void plotsAndRobotsAreKept() {
        QTemporaryDir folder;
        const QString file = folder.filePath("gui.json"), address = daemon("motorcontrol")->address();
        const std::vector<FieldId> plotted{{address, "odometry", "twist.vx"},
                                           {"127.0.0.1:1", "none", "x"}}; // who is away is kept too
        for (int start = 0; start < 2; ++start) {
            Fleet fleet;
            for (const QString &kept : start == 0 ? QStringList(address) : MainWindow::keptAddresses(file))
                QVERIFY(fleet.add(kept).ok());
            DriveControl drive(fleet);
            MainWindow window(fleet, drive, file);
            window.show();
            auto *const topics = window.findChild<QTreeWidget *>("topics");
            if (start == 0)
                for (const FieldId &field : plotted)
                    QVERIFY(window.findChild<PlotsPanel *>()->board().add(field));
            QTRY_COMPARE(topics->findItems("twist.vx", Qt::MatchExactly | Qt::MatchRecursive).size(), 1);
            QCOMPARE(topics->findItems("twist.vx", Qt::MatchExactly | Qt::MatchRecursive)[0]->checkState(0),
                     Qt::Checked);
            for (const FieldId &field : plotted)
                QVERIFY(window.findChild<PlotsPanel *>()->board().has(field));
            window.close();
            QCOMPARE(MainWindow::keptAddresses(file), QStringList(address));
        }
        QVERIFY(window_->show()); // has the focus again
    }

    void logOfAllDaemonsFiltered() {
        auto *const panel = window_->panel<LogPanel>("log");
        auto *const records = panel->findChild<QPlainTextEdit *>("records");
        auto *const level = panel->findChild<QComboBox *>("level");
        auto *const filter = panel->findChild<QLineEdit *>("filter");
        QTRY_VERIFY(records->toPlainText().contains("simulator ") &&
                    records->toPlainText().contains("motorcontrol "));
        OpenWindow::type(filter, "listening");
        QTRY_COMPARE(records->toPlainText().split('\n').size(), 2);
        const QStringList lines = records->toPlainText().split('\n');
        for (const QString &line : lines)
            QVERIFY(line.contains("listening") && line.contains("info"));
        QTest::keyClick(level, Qt::Key_Down); // warnings and errors
        QCOMPARE(records->toPlainText(), QString());
        level->setCurrentIndex(1);
        OpenWindow::type(filter, "shutdown asked");
        QCOMPARE(records->toPlainText(), QString());
        daemon("motorcontrol")->call("daemon.shutdown", {}, this, [](const auto &) {});
        QTRY_VERIFY(records->toPlainText().contains("shutdown asked")); // a new record passes the filter too
        OpenWindow::type(filter, "");
        QTRY_COMPARE(daemon("motorcontrol")->condition(), Condition::Unreachable);
        robot_->startMotorControl();
        QTRY_COMPARE_WITH_TIMEOUT(daemon("motorcontrol")->isConnected(), true, 10000);
    }

    void plotTickedPausedAndWritten() {
        auto *const panel = window_->panel<PlotsPanel>("plots");
        auto *const topics = panel->findChild<QTreeWidget *>("topics");
        QTreeWidgetItem *const odometry =
            topics->findItems("odometry", Qt::MatchExactly | Qt::MatchRecursive).value(0);
        QVERIFY(odometry);
        odometry->setExpanded(true);
        QTRY_VERIFY(odometry->childCount() > 3);
        QTreeWidgetItem *vx = nullptr;
        for (int i = 0; i < odometry->childCount(); ++i)
            if (odometry->child(i)->text(0) == "twist.vx")
                vx = odometry->child(i);
        QVERIFY(vx);
        vx->setCheckState(0, Qt::Checked);
        const PlotPane *const pane = panel->board().panes().front();
        QCOMPARE(int(pane->scene().lines.size()), 1);
        const Samples &samples = *pane->scene().lines.front().samples;
        QTRY_VERIFY(samples.size() > 10);

        window_->drive.steer("test", {1, 0, 0}, true);
        QTRY_VERIFY(pane->scene().left.most() > 0.1); // m/s
        OpenWindow::click(panel, "pause");
        const double held = pane->scene().lines.front().now;
        const std::size_t paused = samples.size();
        QTest::qWait(400); // nothing may happen
        QCOMPARE(pane->scene().lines.front().now, held);
        OpenWindow::click(panel, "pause");
        QTRY_VERIFY(pane->scene().lines.front().now > held + 0.3);
        QVERIFY(samples.size() > paused + 4); // what was sampled meanwhile is there
        window_->drive.halt();
        window_->drive.steer("test", {}, false);

        const QString file = robot_->path("curves.csv");
        QVERIFY(panel->exportTo(file).ok());
        QFile table(file);
        QVERIFY(table.open(QIODevice::ReadOnly));
        QCOMPARE(table.readLine().trimmed(), QByteArray("stamp,daemon,topic,field,value,unit"));
        std::size_t rows = 0;
        double last = 0;
        while (!table.atEnd()) {
            const QList<QByteArray> cells = table.readLine().trimmed().split(',');
            QCOMPARE(cells.size(), 6);
            QVERIFY(cells[0].toDouble() > last);
            last = cells[0].toDouble();
            QCOMPARE(cells[3], QByteArray("twist.vx"));
            QCOMPARE(cells[5], QByteArray("m/s"));
            ++rows;
        }
        QVERIFY(rows >= paused);
        vx->setCheckState(0, Qt::Unchecked);
        QVERIFY(pane->scene().lines.empty());
    }

    void plotThatCannotBeWritten() {
        const auto done = window_->panel<PlotsPanel>("plots")->exportTo(robot_->path("nowhere/curves.csv"));
        QVERIFY(!done.ok());
        QVERIFY(done.error().message.contains("nowhere"));
    }

    void goneDaemonIsTold() {
        QVERIFY(window_->choose(daemon("motorcontrol")));
        chooseMethod("motor.state");
        robot_->kill("motorcontrol");
        QTRY_VERIFY(!commands()->findChild<QPushButton *>("call")->isEnabled());
    }

private:
    DaemonLink *daemon(const QString &name) const { return window_->fleet.robot()->withName(name); }
    CommandsPanel *commands() const { return window_->panel<CommandsPanel>("commands"); }
    void chooseMethod(const QString &name) const {
        auto *const methods = commands()->findChild<QListWidget *>("methods");
        const auto found = methods->findItems(name, Qt::MatchExactly);
        QVERIFY2(!found.isEmpty(), qPrintable(name));
        methods->scrollToItem(found[0]);
        QTest::mouseClick(methods->viewport(), Qt::LeftButton, {},
                          methods->visualItemRect(found[0]).center());
        QCOMPARE(methods->currentItem(), found[0]);
    }
    QLineEdit *parameter(const QString &name) const {
        return commands()->findChild<QWidget *>(name)->findChild<QLineEdit *>();
    }
    QString answer() const { return commands()->findChild<QPlainTextEdit *>("answer")->toPlainText(); }

    std::unique_ptr<RobotProcesses> robot_;
    std::unique_ptr<OpenWindow> window_;
};
