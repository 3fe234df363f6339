#include "gui/desktop/panels/RecordPanel.h"
#include "gui/desktop/widgets/Timeline.h"
#include "tests/gui/FakeLogger.h"
#include "tests/gui/desktop/OpenWindow.h"

using namespace hermes;

/// A session of the simulated lidar and satellites with marks, and its replay in the hands of a person.
class TestReplay : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void initTestCase() {
        robot_ = std::make_unique<RobotProcesses>();
        robot_->startAllWithGps();
        open_ = std::make_unique<OpenWindow>(*robot_);
        QVERIFY(open_->show());
        panel_ = open_->window.findChild<RecordPanel *>();
    }

    void cleanup() {
        if (find("live")->isEnabled())
            find("live")->click();
        QTRY_VERIFY_WITH_TIMEOUT(!find("live")->isEnabled(), 15000);
    }

    /// From any focus, while the panel is out of sight, too; without a text it is numbered.
    void aKeyMarks() {
        auto *const recordings = open_->window.findChild<QDockWidget *>("recordings");
        QVERIFY(recordings->visibleRegion().isEmpty()); // behind another
        QTest::keyClick(&open_->window, Qt::Key_M, Qt::ControlModifier);
        TRY_CONTAINS(message(), "records nothing");
        find<QLineEdit>("name")->setText("run1");
        QTRY_VERIFY(find("record")->isEnabled());
        find("record")->click();
        QTRY_COMPARE(message(), QString("Recording run1."));
        QTRY_VERIFY(!find("mark")->isHidden());
        auto recorded = runningTimer();
        QTest::qWait(1000);
        open_->window.centralWidget()->setFocus();
        QTest::keyClick(QApplication::focusWidget(), Qt::Key_M, Qt::ControlModifier);
        QTRY_COMPARE(message(), QString("Marked: mark 1"));
        open_->window.findChild<QTreeWidget *>("tree")->setFocus();
        QTest::keyClick(QApplication::focusWidget(), Qt::Key_M, Qt::ControlModifier);
        QTRY_COMPARE(message(), QString("Marked: mark 2"));
        open_->panel<RecordPanel>("recordings");
        QTest::qWait(1500);
        OpenWindow::type(find<QLineEdit>("markText"), "at the door");
        QTest::keyClick(find<QLineEdit>("markText"), Qt::Key_M, Qt::ControlModifier);
        QTRY_COMPARE(message(), QString("Marked: at the door"));
        QVERIFY(find<QLineEdit>("markText")->text().isEmpty());
        QTest::qWait(int(1000 * length_s - recorded.elapsed()));
        OpenWindow::click(panel_, "record");
        QTRY_COMPARE(message(), QString("Stopped, nothing missing."));
        QTRY_COMPARE(find<QLineEdit>("name")->text(), QString("run2"));
        waitForLoggers();
        const QTreeWidgetItem *const row = find<QTreeWidget>("sessions")->topLevelItem(0);
        QCOMPARE(row->text(0), QString("run1"));
        QVERIFY2(row->text(2) == "6 s" || row->text(2) == "7 s", qPrintable(row->text(2)));
        QVERIFY2(row->text(3).endsWith("MiB"), qPrintable(row->text(3)));
    }

    void aDragSeeksInAllLoggers() {
        play();
        QTRY_VERIFY(areBoth("state", "replay"));
        QVERIFY(QRegularExpression("^\\d s of [67] s$").match(find<QLabel>("position")->text()).hasMatch());
        press(1);
        QTRY_VERIFY(areBoth("paused", true)); // while it is held
        for (double t_s = 1; t_s < 4; t_s += 0.1)
            moveTo(t_s);
        moveTo(4);
        const auto areAt = [this](double t_s) {
            return std::abs(position_s("velodynelogger") - t_s) < 0.1 &&
                   std::abs(position_s("seriallogger") - t_s) < 0.1;
        };
        QTRY_VERIFY(areAt(4));
        QVERIFY(std::abs(line()->position_s() - 4) < 0.1);
        moveTo(2);
        QTRY_VERIFY(areAt(2));
        release(2);
        QTRY_VERIFY(areBoth("paused", false));
        QTRY_VERIFY(position_s("velodynelogger") > 2.3 && line()->position_s() > 2.3); // it goes on
        // The end, where the lines of the satellites are over, and back.
        find("pauseReplay")->click();
        QTRY_VERIFY(areBoth("paused", true));
        press(length_s + 9);
        release(length_s + 9);
        QTRY_VERIFY(position_s("velodynelogger") > length_s - 1);
        press(0.5);
        release(0.5);
        QTRY_VERIFY(areBoth("state", "replay") && areAt(0.5));
        QVERIFY(areBoth("paused", true)); // as it was before
    }

    void marksAreReached() {
        play();
        find("pauseReplay")->click();
        QTRY_VERIFY(areBoth("paused", true));
        press(0.1);
        release(0.1);
        const auto &marks = line()->marks();
        QCOMPARE(marks[0].text, QString("mark 1"));
        QCOMPARE(marks[1].text, QString("mark 2"));
        QCOMPARE(marks[2].text, QString("at the door"));
        QVERIFY2(marks[0].t_s > 0.9 && marks[2].t_s > marks[1].t_s + 1.3 && marks[2].t_s < length_s,
                 saying(marks[2].t_s));
        auto *const after = find<QAbstractButton>("markAfter"), *const before =
                                                                    find<QAbstractButton>("markBefore");
        QVERIFY(!before->isEnabled());
        TRY_CONTAINS(after->toolTip(), "mark 1");
        after->click();
        QTRY_VERIFY(std::abs(position_s("velodynelogger") - marks[0].t_s) < 0.1);
        after->click();
        after->click();
        QTRY_VERIFY(std::abs(position_s("velodynelogger") - marks[2].t_s) < 0.1 &&
                    std::abs(position_s("seriallogger") - marks[2].t_s) < 0.1);
        QVERIFY(!after->isEnabled() && before->toolTip().contains("mark 2"));
        before->click();
        QTRY_VERIFY(std::abs(position_s("velodynelogger") - marks[1].t_s) < 0.1);
        // Named where they stand.
        QHelpEvent ask(QEvent::ToolTip, line()->pointOf(marks[2].t_s), line()->mapToGlobal({}));
        QApplication::sendEvent(line(), &ask);
        QTRY_VERIFY(QToolTip::text().contains("at the door"));
        QToolTip::hideText();
    }

    void pauseSpeedAndLoop() {
        play();
        auto *const speed = find<QComboBox>("replaySpeed");
        const auto choose = [speed](const QString &text) {
            speed->setCurrentIndex(speed->findText(text));
            Q_EMIT speed->activated(speed->currentIndex());
        };
        QCOMPARE(speed->currentText(), QString("1 x"));
        choose("0.25 x");
        QTRY_VERIFY(areBoth("speed", 0.25));
        find<QCheckBox>("loopReplay")->setChecked(true);
        choose("10 x");
        QTRY_VERIFY(areBoth("speed", 10.0));
        double last_s = 0;
        int loops = 0;
        auto timer = runningTimer();
        while (loops < 2 && timer.elapsed() < 20000) {
            QTest::qWait(20);
            loops += line()->position_s() < last_s;
            last_s = line()->position_s();
        }
        QVERIFY(loops >= 2);
        QVERIFY(areBoth("speed", 10.0) && find("live")->isEnabled());
        find("pauseReplay")->click();
        QCOMPARE(find("pauseReplay")->text(), QString("Go on"));
        QTRY_VERIFY(areBoth("paused", true) || areBoth("state", "ended"));
        find<QCheckBox>("loopReplay")->setChecked(false);
        find("pauseReplay")->click();
        choose("fastest");
        QTRY_VERIFY_WITH_TIMEOUT(!find("live")->isEnabled(), 15000); // at its end all is live
        QVERIFY(areBoth("state", "live"));
        QVERIFY(!line()->isVisible());
    }

    /// Not those that drive.
    void keysSeek() {
        play();
        find("pauseReplay")->click();
        line()->setFocus();
        QTest::keyClick(line(), Qt::Key_PageDown); // ten seconds: beyond the end
        QTRY_VERIFY(position_s("velodynelogger") > length_s - 1);
        QTest::keyClick(line(), Qt::Key_Home);
        QTRY_VERIFY(position_s("velodynelogger") < 0.1 && line()->position_s() == 0);
        for (const int key : {Qt::Key_Left, Qt::Key_Right, Qt::Key_Up, Qt::Key_W, Qt::Key_Plus}) {
            QKeyEvent event(QEvent::KeyPress, key, {});
            static_cast<QObject *>(line())->event(&event); // not what the window does with it
            QVERIFY(!event.isAccepted());
        }
        open_->window.centralWidget()->setFocus();
    }

    void enterReplaysOnALowScreen() {
        const QSize before = open_->window.size();
        open_->window.resize(1024, 600);
        open_->panel<RecordPanel>("recordings");
        waitForLoggers();
        QTRY_VERIFY(find("replay")->isEnabled());
        auto *const sessions = find<QTreeWidget>("sessions");
        sessions->setFocus();
        QTest::keyClick(sessions, Qt::Key_Return);
        QTRY_VERIFY(areBoth("state", "replay"));
        for (const bool isLowAgain : {false, true}) {
            if (isLowAgain) {
                const QWidget *const map = open_->window.centralWidget();
                const int low = map->height();
                open_->window.resize(before);
                QTRY_VERIFY(map->height() > low); // it is laid out
                open_->window.resize(1024, 600);
            }
            for (QWidget *const part : std::initializer_list<QWidget *>{line(), find("pauseReplay"),
                                                                        find<QComboBox>("replaySpeed")})
                QTRY_VERIFY2(part->visibleRegion().boundingRect() == part->rect(),
                             qPrintable(part->objectName()));
        }
        open_->window.resize(before);
    }

    /// Also when that has come to its end.
    void liveEndsTheReplayOfAnother() {
        open_->panel<RecordPanel>("recordings");
        waitForLoggers();
        QVERIFY(!find("live")->isEnabled());
        ConnectedClient other(QString("127.0.0.1:%1").arg(robot_->port("velodynelogger")));
        for (const double speed : {1.0, 0.0}) {
            const auto opened =
                other.callAndWait("source.open", QJsonObject{{"recording", "run1"}, {"speed", speed}});
            QVERIFY2(opened, opened ? "" : qPrintable(opened.error().message));
            QTRY_COMPARE_WITH_TIMEOUT(source("velodynelogger")["state"].toString(),
                                      QString(speed > 0 ? "replay" : "ended"), 20000);
            QTRY_VERIFY(find("live")->isEnabled());
            QVERIFY(open_->window.findChild<QLabel *>("replayBanner")->isVisible());
            OpenWindow::click(panel_, "live");
            QTRY_COMPARE(source("velodynelogger")["state"].toString(), QString("live"));
            QTRY_VERIFY(!find("live")->isEnabled());
            QTRY_VERIFY(!open_->window.findChild<QLabel *>("replayBanner")->isVisible());
        }
    }

    void closingAsksAndEndsTheReplay() {
        play();
        find("pauseReplay")->click();
        QTRY_VERIFY(open_->drive.replay().isReplaying());
        open_->window.close();
        QVERIFY(open_->window.isVisible());
        const QString notice = open_->window.findChild<QLabel *>("noticeBanner")->text();
        VERIFY_STARTS(notice, "127.0.0.1 still shows a recording; closing ends that replay.");
        robot_->signal("motorcontrol", SIGSTOP);
        open_->drive.stop();
        open_->window.close(); // something else is to be said now
        QVERIFY(open_->window.isVisible());
        robot_->signal("motorcontrol", SIGCONT);
        QTRY_COMPARE_WITH_TIMEOUT(open_->drive.stopping().phase(), StopPhase::Confirmed, 10000);
        open_->drive.release();
        QTRY_VERIFY(!open_->drive.isStopped());
        open_->window.close();
        if (open_->window.isVisible())
            open_->window.close();
        QVERIFY(!open_->window.isVisible());
        QTRY_VERIFY(areBoth("state", "live"));
        QVERIFY(open_->show());
    }

    void aLoggerThatFreezesWhileOneDrags() {
        play();
        QTRY_VERIFY(areBoth("state", "replay"));
        press(1);
        robot_->signal("velodynelogger", SIGSTOP);
        QElapsedTimer turn;
        qint64 longest_ms = 0;
        for (int i = 0; i < 100; ++i) {
            turn.start();
            moveTo(1 + 0.04 * i);
            QApplication::processEvents();
            longest_ms = std::max(longest_ms, turn.elapsed());
            QTest::qWait(5);
        }
        QVERIFY2(longest_ms < 200, saying(longest_ms)); // a loaded machine; nothing waits
        QTRY_VERIFY_WITH_TIMEOUT(!line()->isVisible(), 20000);
        QVERIFY2(message().contains("velodynelogger") && message().contains("no reply"),
                 qPrintable(message()));
        QVERIFY(!line()->isVisible() && !line()->isHeld());
        QCOMPARE(source("seriallogger")["state"].toString(), QString("live"));
        robot_->signal("velodynelogger", SIGCONT);
        QTRY_COMPARE_WITH_TIMEOUT(source("velodynelogger")["state"].toString(), QString("live"), 15000);
        QTest::mouseRelease(line(), Qt::LeftButton);
    }

    void aLoggerThatDiesWhileOneDrags() {
        play();
        QTRY_VERIFY(areBoth("state", "replay"));
        press(1);
        moveTo(2);
        robot_->kill("seriallogger");
        moveTo(3);
        QTRY_VERIFY_WITH_TIMEOUT(!find("live")->isEnabled(), 10000);
        VERIFY_CONTAINS(message(), "seriallogger");
        QVERIFY(!line()->isVisible());
        moveTo(4);
        QTest::mouseRelease(line(), Qt::LeftButton);
        QCOMPARE(source("velodynelogger")["state"].toString(), QString("live"));
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
        line.setDuration(10);
        line.setPosition(1e300); // beyond its end
        QCOMPARE(line.position_s(), 10.0);
        line.setPosition(std::nan(""));
        line.setPosition(-1);
        QCOMPARE(line.position_s(), 10.0);
        QVERIFY(!line.grab().isNull());
        line.setDuration(5); // it became shorter
        QCOMPARE(line.position_s(), 5.0);
    }

    void twoOfOneNameReplay() {
        FakeLoggers robot;
        Fleet fleet;
        for (int i = 0; i < 2; ++i) {
            const FakeLogger::Options options{false, true};
            QVERIFY(fleet.add(robot.add("twin", options).address().section("//", -1)).ok());
        }
        ReplayWatch watch(fleet);
        for (int i = 0; i < 2; ++i) {
            robot.loggers[std::size_t(i)]->positionsToEnd = 1000;
            robot.loggers[std::size_t(i)]->told = {{"name", QString("/data/run%1").arg(i)},
                                                   {"position_s", 65}};
            QVERIFY(robot.clients[std::size_t(i)]
                        ->callAndWait("source.open", QJsonObject{{"recording", "x"}})
                        .ok());
        }
        QTRY_VERIFY2(watch.text().contains("run0") && watch.text().contains("run1") &&
                         watch.text().contains("at 1 min 5 s"),
                     qPrintable(watch.text()));
        robot.loggers[0]->source = "live";
        QTRY_VERIFY(!watch.text().contains("run0"));
        QVERIFY(watch.text().contains("run1"));
    }

private:
    template <typename T = QPushButton>
    T *find(const QString &name) const {
        return panel_->findChild<T *>(name);
    }
    Timeline *line() const { return find<Timeline>("timeline"); }
    QString message() const { return find<QLabel>("message")->text(); }
    QJsonValue source(const QString &logger) const {
        return open_->fleet.robot()->withName(logger)->client().callAndWait("source.status").take()["source"];
    }
    double position_s(const QString &logger) const { return source(logger)["position_s"].toDouble(); }
    bool areBoth(const char *member, const QJsonValue &value) const {
        return source("velodynelogger")[QLatin1String(member)] == value &&
               source("seriallogger")[QLatin1String(member)] == value;
    }
    void press(double t_s) const { QTest::mousePress(line(), Qt::LeftButton, {}, line()->pointOf(t_s)); }
    void moveTo(double t_s) const {
        QMouseEvent move(QEvent::MouseMove, line()->pointOf(t_s), Qt::NoButton, Qt::LeftButton, {});
        QApplication::sendEvent(line(), &move);
    }
    void release(double t_s) const { QTest::mouseRelease(line(), Qt::LeftButton, {}, line()->pointOf(t_s)); }

    void play() {
        open_->panel<RecordPanel>("recordings");
        waitForLoggers();
        QTRY_VERIFY(find("replay")->isEnabled());
        OpenWindow::click(panel_, "replay");
        QTRY_VERIFY2(line()->isVisible() && line()->duration_s() >= length_s - 1, qPrintable(message()));
        QTRY_VERIFY_WITH_TIMEOUT(line()->marks().size() == 3, 5000);
    }

    /// Both are here, and what they recorded is known.
    void waitForLoggers() {
        auto *const sessions = find<QTreeWidget>("sessions");
        QTRY_VERIFY_WITH_TIMEOUT(sessions->topLevelItemCount() == 1 &&
                                     sessions->topLevelItem(0)->toolTip(0).contains("seriallogger: ") &&
                                     sessions->topLevelItem(0)->toolTip(0).contains("velodynelogger: "),
                                 20000);
    }

    static constexpr double length_s = 6; // of the session, at least
    std::unique_ptr<RobotProcesses> robot_;
    std::unique_ptr<OpenWindow> open_;
    RecordPanel *panel_ = nullptr;
};
