#include "gui/desktop/panels/RecordPanel.h"
#include "gui/desktop/panels/SessionTable.h"
#include "gui/desktop/widgets/Timeline.h"
#include "tests/gui/desktop/FakeDaemon.h"
#include "tests/gui/desktop/FakeRecorder.h"
#include "tests/gui/desktop/OpenWindow.h"

#include <QMessageBox>

using namespace hermes;

/// The window shows what the recorder of the chosen robot tells, and asks it for what somebody wants.
class TestRecordPanel : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void init() {
        recorder_ = std::make_unique<FakeRecorder>();
        recorder_->sessions = {{"second", "b", 1.7e9 + 100, 1.7e9 + 120, 4096, {"recorder", "lidar"}, {}},
                               {"first", "a", 1.7e9, 1.7e9 + 60, 9e9, {"lidar"}, {"lidar: cut off"}}};
        open_ = std::make_unique<OpenWindow>();
        QVERIFY(open_->show());
        panel_ = open_->panel<RecordPanel>("recordings");
        QVERIFY(open_->fleet.add(recorder_->address()).ok());
        QTRY_COMPARE(find<QTreeWidget>("sessions")->topLevelItemCount(), 2);
    }

    void cleanup() {
        open_.reset();
        recorder_.reset();
    }

    void recordsAndGoesOnWithoutTheWindow() {
        OpenWindow::type(find<QLineEdit>("name"), "hall");
        OpenWindow::click(panel_, "record");
        QTRY_COMPARE(message(), QString("Recording hall."));
        QTRY_COMPARE(find("record")->text(), QString("S&top"));
        QCOMPARE(recorder_->asked, QStringList{R"(session.start {"name":"hall"})"});
        QVERIFY(isTabMarked());
        recorder_->state.duration_s = 83;
        recorder_->state.bytes = 2048;
        recorder_->state.left_s = 7200;
        recorder_->state.parts = {{"lidar",
                                   "recording",
                                   0,
                                   {},
                                   {{"missing", 3}, {"kernel", 3}, {"too_long", 0}, {"disk_bytes", 7}},
                                   {}}};
        recorder_->state.problems = QStringList{"serial: cut off"};
        recorder_->state.silent = QStringList{"scanmatcher"};
        recorder_->tell();
        QTRY_COMPARE(text("amount"), QString("hall: 1 min 23 s, 2.0 KiB, the disk will do for 2 h 0 min; "
                                             "lidar lost: disk bytes 7, kernel 3, missing 3"));
        QCOMPARE(text("wrong"), QString("serial: cut off\nscanmatcher does not answer."));
        QVERIFY(open_->window.close()); // without a question
        open_ = std::make_unique<OpenWindow>();
        QVERIFY(open_->show());
        panel_ = open_->panel<RecordPanel>("recordings");
        QVERIFY(open_->fleet.add(recorder_->address()).ok());
        QTRY_COMPARE(find("record")->text(), QString("S&top"));
        OpenWindow::click(panel_, "record");
        QTRY_COMPARE(message(), QString("hall has ended."));
        QCOMPARE(text("wrong"), QString("serial: cut off"));
        QTRY_COMPARE(names(), QStringList({"hall", "second", "first"}));
        QVERIFY(!isTabMarked());
        OpenWindow::click(panel_, "record"); // without a name
        QTRY_COMPARE(message(), QString("Recording 2026-10-07_09-30-00."));
        QCOMPARE(recorder_->asked.last(), QString("session.start {}"));
        QTRY_COMPARE(find("record")->text(), QString("S&top"));
        recorder_->state.state = "idle"; // whoever ended it
        recorder_->tell();
        QTRY_COMPARE(message(), QString("2026-10-07_09-30-00 has ended, nothing missing."));
    }

    /// From any focus, while the panel is out of sight, too; without a text they are numbered.
    void keysMark() {
        recorder_->refusal = "nothing is recorded";
        QTest::keyClick(&open_->window, Qt::Key_M, Qt::ControlModifier);
        TRY_CONTAINS(message(), "nothing is recorded");
        recorder_->refusal.clear();
        OpenWindow::click(panel_, "record");
        QTRY_VERIFY(find("mark")->isVisible());
        open_->panel<QWidget>("daemons");
        open_->window.centralWidget()->setFocus();
        for (const char *const expected : {"mark 1", "mark 2"}) {
            QTest::keyClick(QApplication::focusWidget(), Qt::Key_M, Qt::ControlModifier);
            QTRY_COMPARE(message(), "Marked: " + QString(expected));
        }
        open_->panel<RecordPanel>("recordings");
        OpenWindow::type(find<QLineEdit>("markText"), "at the door");
        OpenWindow::click(panel_, "mark");
        QTRY_COMPARE(message(), QString("Marked: at the door"));
        QVERIFY(find<QLineEdit>("markText")->text().isEmpty());
        QCOMPARE(recorder_->state.marks.size(), 3U);
    }

    void aReplayIsSteered() {
        recorder_->state.marks = {{5, "<b>door"}, {10, "ramp"}};
        QVERIFY(!find<Timeline>("timeline")->isVisible());
        Q_EMIT find<SessionTable>("sessions")->itemActivated(row(1), 0);
        QTRY_COMPARE(recorder_->asked.value(0), QString(R"(session.replay {"name":"second"})"));
        find<SessionTable>("sessions")->setCurrentItem(row(1));
        OpenWindow::click(panel_, "replay");
        QTRY_COMPARE(recorder_->asked.last(), QString(R"(session.replay {"name":"first"})"));
        QTRY_COMPARE(text("position"), QString("0 s of 20 s"));
        const auto *const banner = open_->window.findChild<QLabel *>("replayBanner");
        QTRY_COMPARE(banner->text(), QString("REPLAY, not the robot of now: first at 0 s of 20 s"));
        QVERIFY(open_->drive.refusesForReplay());
        const auto is = [this](const char *last) { return recorder_->asked.last() == last; };
        OpenWindow::click(panel_, "markAfter");
        QTRY_VERIFY(is(R"(session.seek {"t_s":5})"));
        OpenWindow::click(panel_, "pauseReplay");
        QTRY_VERIFY(is(R"(session.pause {"paused":true})"));
        QTRY_COMPARE(find("pauseReplay")->text(), QString("Go on"));
        TRY_CONTAINS(banner->text(), "first at 5 s of 20 s, paused");
        OpenWindow::click(panel_, "loopReplay");
        QTRY_VERIFY(is(R"(session.loop {"loop":true})"));
        auto *const speed = find<QComboBox>("replaySpeed");
        speed->setCurrentIndex(speed->findText("5 x"));
        Q_EMIT speed->activated(speed->currentIndex());
        QTRY_VERIFY(is(R"(session.speed {"speed":5})"));
        for (const double other : {3.0, 7.0}) { // set by others
            recorder_->state.replay->speed = other;
            recorder_->tell();
            QTRY_COMPARE(speed->currentText(), QString("%1.00 x").arg(other));
        }
        QVERIFY(open_->window.close()); // it goes on
        QCOMPARE(recorder_->state.state, QString("replaying"));
        open_->window.show();
        OpenWindow::click(panel_, "live");
        QTRY_VERIFY(!banner->isVisible() && !find<Timeline>("timeline")->isVisible());
        QVERIFY(!open_->drive.refusesForReplay());
    }

    /// What a hand changes faster than it is answered waits, and only the newest is sent.
    void aDragSendsTheNewest() {
        recorder_->state.state = "replaying";
        recorder_->state.replay = SessionReplay{0, 20, 1, false, false};
        recorder_->tell();
        auto *const line = find<Timeline>("timeline");
        QTRY_VERIFY(line->isVisible());
        recorder_->holds = true;
        QTest::mousePress(line, Qt::LeftButton, {}, line->pointOf(1));
        for (double t_s = 2; t_s <= 10; t_s += 0.5) {
            QMouseEvent move(QEvent::MouseMove, line->pointOf(t_s), Qt::NoButton, Qt::LeftButton, {});
            QApplication::sendEvent(line, &move);
        }
        QTRY_COMPARE(recorder_->asked.size(), 2); // it waits, and was sought once
        recorder_->letGo();
        QTRY_COMPARE(recorder_->asked.size(), 3);
        QTRY_VERIFY(std::abs(recorder_->state.replay->position_s - 10) < 0.5 &&
                    recorder_->state.replay->paused);
        recorder_->refusal = "that time is not recorded";
        QTest::mouseRelease(line, Qt::LeftButton, {}, line->pointOf(10));
        TRY_CONTAINS(message(), "that time is not recorded");
    }

    void renamesRemovesAndExplains() {
        OpenWindow::click(panel_, "explain");
        QTRY_VERIFY(panel_->findChild<QDialog *>("explanation"));
        auto *const dialog = panel_->findChild<QDialog *>("explanation");
        QCOMPARE(dialog->findChild<QPlainTextEdit *>()->toPlainText(),
                 QString("12.34 s: motor.estop by anna\n<b>and no more</b>"));
        QVERIFY(dialog->close());
        auto *const table = find<SessionTable>("sessions");
        const auto typeName = [&](const QString &name) {
            action("renameSession")->trigger();
            auto *const editor = table->findChild<QLineEdit *>();
            open_->window.activateWindow(); // which a dialog without a window manager does not give back
            QTRY_COMPARE(QApplication::focusWidget(), editor);
            OpenWindow::type(editor, name);
            QTest::keyClick(editor, Qt::Key_Return);
        };
        typeName("third");
        QTRY_COMPARE(recorder_->sessions.front().name, QString("third"));
        QTRY_COMPARE(names(), QStringList({"third", "first"}));
        recorder_->refusal = "first: there is one of that name";
        typeName("first");
        TRY_CONTAINS(message(), "there is one of that name");
        QTRY_COMPARE(names(), QStringList({"third", "first"}));
        recorder_->refusal.clear();
        for (const char *const answer : {"Cancel", "&Remove"}) {
            action("removeSession")->trigger();
            auto *const box = panel_->findChild<QMessageBox *>("removal");
            QVERIFY(box);
            QCOMPARE(box->text(),
                     QString("Remove third, 4.0 KiB of recorder, lidar? Nothing brings it back."));
            for (QAbstractButton *const button : box->buttons())
                if (button->text() == answer)
                    button->click();
            QTRY_VERIFY(!panel_->findChild<QMessageBox *>("removal"));
        }
        QTRY_COMPARE(names(), QStringList("first"));
        QCOMPARE(recorder_->asked.last(), QString(R"(session.remove {"confirm":true,"name":"third"})"));
    }

    void aRobotWithoutARecorder() {
        Mischief supervisor;
        supervisor.hasTopics = false;
        supervisor.isEverywhere = true;
        supervisor.topics["processes"] = R"({"robot":"blue","processes":[]})";
        const FakeDaemon blue(supervisor);
        const QString address = blue.address("127.0.0.2");
        QVERIFY(open_->fleet.add(address).ok());
        QTRY_VERIFY(open_->fleet.robotAt(address));
        QVERIFY(!find("startRecorder")->isVisible());
        open_->fleet.choose(open_->fleet.robotAt(address));
        QCOMPARE(find<QTreeWidget>("sessions")->topLevelItemCount(), 0); // at once
        QCOMPARE(text("amount"), QString("The robot has no recorder: nothing is recorded."));
        QVERIFY(!find("record")->isEnabled());
        OpenWindow::click(panel_, "startRecorder");
        QTRY_COMPARE(blue.calls("process.start"), 1);
    }

    /// It goes on by itself; the window says that it does not know.
    void aRecorderThatIsGone() {
        OpenWindow::click(panel_, "record");
        QTRY_COMPARE(find("record")->text(), QString("S&top"));
        recorder_.reset();
        TRY_STARTS(text("amount"), "The recorder does not answer, and goes on by itself; last known: 2026");
        QVERIFY(!find<QLabel>("amount")->isEnabled() && !find("record")->isEnabled());
        QCOMPARE(find<QTreeWidget>("sessions")->topLevelItemCount(), 0);
    }

    /// By what they are, not by their text; whatever a recorder says.
    void sessionsAreSortedByTheHeader() {
        const double today = QDateTime::currentMSecsSinceEpoch() * 1e-3;
        std::vector<SessionSummary> list{
            {"run10", "a", today, today + 100, 900, {}, {}, 100},
            {"run2", "b", today - 90000, today - 89000, 6.3 * 1024 * 1024 * 1024, {}, {}, 1000},
            {"run1", "c", 1e300, -1e300, std::nan(""), {}, {}, -1e300},
            {"run3", "d", std::nan(""), std::nan(""), 2048, {}, {}, std::nan("")}};
        SessionTable table;
        table.tell(list);
        table.resize(500, 200);
        table.show();
        QCOMPARE(table.chosen()->name, QString("run10")); // the first of the list is the latest
        QCOMPARE(namesOf(table).mid(0, 3), QStringList({"run1", "run10", "run2"}));
        const auto clickHeader = [&table](int column) {
            QHeaderView *const header = table.header();
            QTest::mouseClick(header->viewport(), Qt::LeftButton, {},
                              {header->sectionViewportPosition(column) + 20, header->height() / 2});
        };
        clickHeader(0);
        if (namesOf(table).first() != "run1")
            clickHeader(0);
        QCOMPARE(namesOf(table), QStringList({"run1", "run2", "run3", "run10"}));
        clickHeader(3);
        if (namesOf(table).first() != "run2")
            clickHeader(3);
        const QTreeWidgetItem *const largest = table.topLevelItem(0);
        QCOMPARE(largest->text(0), QString("run2"));
        QCOMPARE(largest->text(2), QString("16 min 40 s"));
        QCOMPARE(largest->text(3), QString("6.3 GiB"));
        QCOMPARE(table.chosen()->name, QString("run10"));
        list.erase(list.begin());
        table.tell(list);
        QCOMPARE(table.chosen()->name, QString("run2"));
    }

    void impossibleTimes() {
        Timeline line;
        line.resize(300, 30);
        int sought = 0;
        connect(&line, &Timeline::sought, [&] { ++sought; });
        for (const double duration_s : {std::nan(""), -1.0, 1e300, double(INFINITY), 0.0}) {
            line.setDuration(duration_s);
            for (const double position_s : {std::nan(""), -1.0, 1e300, double(INFINITY)})
                line.setPosition(position_s);
            line.setMarks({{std::nan(""), "nan"}, {1e300, "far"}, {-1, QString(10000, 'x')}});
            QVERIFY(!line.grab().isNull());
            QTest::mouseClick(&line, Qt::LeftButton);
            QTest::keyClick(&line, Qt::Key_PageDown);
            QHelpEvent ask(QEvent::ToolTip, {150, 15}, {150, 15});
            QApplication::sendEvent(&line, &ask);
            QCOMPARE(line.duration_s(), 0.0);
            QCOMPARE(line.position_s(), 0.0);
        }
        QCOMPARE(sought, 0);
        line.setDuration(100);
        line.setPosition(1e300); // beyond its end
        QCOMPARE(line.position_s(), 100.0);
        line.setPosition(std::nan(""));
        QCOMPARE(line.position_s(), 100.0);
        line.setDuration(50); // it became shorter
        QCOMPARE(line.position_s(), 50.0);
        QTest::keyClick(&line, Qt::Key_PageUp);
        QCOMPARE(line.position_s(), 40.0);
        QTest::keyClick(&line, Qt::Key_Home);
        QCOMPARE(line.position_s(), 0.0);
    }

private:
    template <typename T = QPushButton>
    T *find(const QString &name) const {
        return panel_->findChild<T *>(name);
    }
    QString text(const QString &label) const { return find<QLabel>(label)->text(); }
    QString message() const { return text("message"); }
    QAction *action(const char *name) const { return panel_->findChild<QAction *>(name); }
    QTreeWidgetItem *row(int number) const { return find<QTreeWidget>("sessions")->topLevelItem(number); }
    QStringList names() const { return namesOf(*find<QTreeWidget>("sessions")); }
    static QStringList namesOf(const QTreeWidget &table) {
        QStringList shown;
        for (int i = 0; i < table.topLevelItemCount(); ++i)
            shown.append(table.topLevelItem(i)->text(0));
        return shown;
    }
    bool isTabMarked() const {
        return open_->window.findChild<QDockWidget *>("recordings")->windowTitle().contains(QChar(0x25cf));
    }

    std::unique_ptr<FakeRecorder> recorder_;
    std::unique_ptr<OpenWindow> open_;
    RecordPanel *panel_ = nullptr;
};
