#include "common/client/DaemonAddress.h"
#include "gui/desktop/panels/SettingsPanel.h"
#include "tests/gui/desktop/OpenWindow.h"

#include <QScrollBar>
#include <QSlider>

using namespace hermes;

/// Changes the settings of a motor control without motors, as an operator does.
class TestSettingsPanel : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void init() {
        robot_ = std::make_unique<RobotProcesses>();
        put(robot_->path("motors.json"), "{}");
        const quint16 port = robot_->start("motorcontrol", {}, {"--config", robot_->path("motors.json")});
        robot_->start("scanmatcher");
        window_ = std::make_unique<OpenWindow>(*robot_);
        QVERIFY(window_->show());
        panel_ = window_->panel<SettingsPanel>("settings");
        QVERIFY(window_->choose(window_->fleet.robot()->withName("motorcontrol")));
        QTRY_VERIFY(panel_->findChild<QWidget *>("motion.vx"));
        client_ = std::make_unique<ConnectedClient>(asOwner(QString("127.0.0.1:%1").arg(port)));
    }

    void cleanup() {
        client_.reset();
        window_.reset();
        robot_.reset();
    }

    void validChangeIsApplied() {
        QVERIFY(!isEnabled("apply"));
        OpenWindow::type(field("safety.command_timeout_s"), "0.6");
        QCOMPARE(note("safety.command_timeout_s"), QString("changed"));
        QCOMPARE(setting("safety.command_timeout_s"), QJsonValue(0.25)); // not before Apply
        OpenWindow::click(panel_, "apply");
        QTRY_COMPARE(message(), QString("Applied."));
        QCOMPARE(setting("safety.command_timeout_s"), QJsonValue(0.6));
        QTRY_VERIFY(!isEnabled("apply"));
        QVERIFY(note("safety.command_timeout_s") != "changed");
    }

    void wrongValueIsToldAsOneTypes() {
        const QString limits = note("motion.vx");
        for (const char *const wrong : {"-1", "1e9", "fast", "1e999", "NaN", "[1]", "", "0.5 m/s"}) {
            OpenWindow::type(field("motion.vx"), wrong);
            QVERIFY2(note("motion.vx").startsWith("expected"), wrong);
            QVERIFY2(!isEnabled("apply"), wrong);
            QVERIFY2(isEnabled("revert"), wrong);
            VERIFY_CONTAINS(message(), "motion.vx"); // which may be out of sight
        }
        OpenWindow::click(panel_, "revert");
        QCOMPARE(note("motion.vx"), limits);
        QVERIFY(!isEnabled("revert"));
    }

    void refusedByARuleIsToldAtItsRow() {
        const double before = setting("faults.battery_v").toDouble();
        const double warning = setting("faults.battery_warning_v").toDouble();
        OpenWindow::type(field("faults.battery_v"), QString::number(warning + 1));
        OpenWindow::type(field("motion.vx"), "0.3");
        OpenWindow::click(panel_, "apply");
        QTRY_VERIFY(note("faults.battery_v").contains("faults.battery_warning_v"));
        QVERIFY(message().contains("faults.battery_v"));
        QCOMPARE(setting("faults.battery_v").toDouble(), before); // all or nothing
        QVERIFY(setting("motion.vx").toDouble() != 0.3);
        QCOMPARE(field("motion.vx")->text(), QString("0.3")); // what one typed stays
        OpenWindow::type(field("faults.battery_v"), QString::number(before));
        OpenWindow::click(panel_, "apply");
        QTRY_COMPARE(setting("motion.vx").toDouble(), 0.3);
    }

    void revertAndDefaults() {
        OpenWindow::type(field("motion.vx"), "0.31");
        OpenWindow::type(field("pid.p"), "2");
        OpenWindow::click(panel_, "apply");
        QTRY_COMPARE(setting("pid.p"), QJsonValue(2));
        QTRY_VERIFY(!isEnabled("apply"));
        OpenWindow::click(panel_, "defaults");
        QCOMPARE(note("pid.p"), QString("changed"));
        QCOMPARE(field("pid.p")->text(), QString("1"));
        OpenWindow::click(panel_, "revert");
        QCOMPARE(field("pid.p")->text(), QString("2"));
        OpenWindow::click(panel_, "defaults");
        OpenWindow::click(panel_, "apply");
        QTRY_COMPARE(setting("pid.p"), QJsonValue(1));
    }

    void restartIsSaid() {
        OpenWindow::type(field("controllers.2.address"), "130");
        QVERIFY(note("controllers.2.address").contains("needs a restart"));
        OpenWindow::click(panel_, "apply");
        QTRY_VERIFY(message().contains("Needs a restart") && message().contains("controllers.2.address"));
    }

    void saved() {
        OpenWindow::type(field("motion.vx"), "0.31");
        OpenWindow::click(panel_, "apply");
        QTRY_COMPARE(message(), QString("Applied."));
        OpenWindow::click(panel_, "save");
        QTRY_VERIFY(message().startsWith("Saved"));
        QCOMPARE(QJsonDocument::fromJson(contentOf(robot_->path("motors.json")))["motion"]["vx"],
                 QJsonValue(0.31));
    }

    void changeOfAnotherClientArrives() {
        OpenWindow::type(field("pid.i"), "0.7"); // not yet applied
        const QJsonObject others{{"motion", QJsonObject{{"vx", 0.32}}}};
        QVERIFY(client_->callAndWait("settings.set", QJsonObject{{"values", others}}).ok());
        QTRY_COMPARE(field("motion.vx")->text(), QString("0.32"));
        QVERIFY(note("motion.vx") != "changed");
        QCOMPARE(field("pid.i")->text(), QString("0.7")); // stays
        QCOMPARE(note("pid.i"), QString("changed"));
        OpenWindow::click(panel_, "apply");
        QTRY_COMPARE(setting("pid.i"), QJsonValue(0.7));
        QCOMPARE(setting("motion.vx"), QJsonValue(0.32));
    }

    void otherDaemonMeanwhile() {
        OpenWindow::type(field("pid.i"), "0.7");
        QVERIFY(window_->choose(window_->fleet.robot()->withName("scanmatcher")));
        QTRY_VERIFY(panel_->findChild<QWidget *>("map.folder"));
        QVERIFY(!panel_->findChild<QWidget *>("pid.i"));
        QVERIFY(!isEnabled("apply"));
        robot_->kill("scanmatcher");
        QTRY_VERIFY(!isEnabled("save"));
        QVERIFY(!isEnabled("defaults"));
    }

    void everyRowFitsItsSetting() {
        const auto schema = client_->callAndWait("settings.schema");
        QVERIFY(schema.ok());
        QVERIFY(panel_->findChild<QWidget *>("frame.layout")->findChild<QComboBox *>());
        QVERIFY(field("controllers.1.url"));
        auto *const filter = panel_->findChild<QLineEdit *>("filter");
        OpenWindow::type(filter, "wheel radius");
        QVERIFY(field("frame.wheel_radius_m")->isVisible());
        QVERIFY(!field("motion.vx")->isVisible());
        auto *const number = field("frame.wheel_radius_m");
        QTest::keyClick(number, Qt::Key_PageUp); // ten steps
        QCOMPARE(number->text(), QString("0.2"));
        for (int i = 0; i < 20; ++i)
            QTest::keyClick(number, Qt::Key_PageUp);
        QCOMPARE(number->text(), QString("1")); // its limit
    }

    void editsAreKeptForEachDaemon() {
        DaemonLink *const motors = window_->fleet.robot()->withName("motorcontrol");
        DaemonLink *const matcher = window_->fleet.robot()->withName("scanmatcher");
        OpenWindow::type(field("motion.vx"), "0.31");
        QVERIFY(window_->choose(matcher));
        QTRY_VERIFY(panel_->findChild<QWidget *>("source.queue"));
        VERIFY_CONTAINS(message(), "motorcontrol keeps 1 change");
        OpenWindow::type(field("source.queue"), "7");
        QVERIFY(window_->choose(motors));
        QTRY_VERIFY(panel_->findChild<QWidget *>("motion.vx"));
        QTRY_COMPARE(field("motion.vx")->text(), QString("0.31"));
        QCOMPARE(note("motion.vx"), QString("changed"));
        QVERIFY(isEnabled("apply"));
        QVERIFY(setting("motion.vx").toDouble() != 0.31);
        QVERIFY(window_->choose(matcher));
        QTRY_VERIFY(panel_->findChild<QWidget *>("source.queue"));
        QTRY_COMPARE(field("source.queue")->text(), QString("7"));
        OpenWindow::click(panel_, "revert");
        QVERIFY(window_->choose(motors));
        QTRY_VERIFY(panel_->findChild<QWidget *>("motion.vx"));
        OpenWindow::click(panel_, "apply");
        QTRY_COMPARE(setting("motion.vx"), QJsonValue(0.31));
        QVERIFY(window_->choose(matcher));
        QTRY_VERIFY(panel_->findChild<QWidget *>("source.queue"));
        QVERIFY(!isEnabled("apply"));
    }

    void editsOutliveARestart() {
        OpenWindow::type(field("motion.vx"), "0.31");
        robot_->kill("motorcontrol");
        QTRY_VERIFY(!isEnabled("apply"));
        robot_->start("motorcontrol", {}, {"--config", robot_->path("motors.json")});
        QTRY_VERIFY_WITH_TIMEOUT(isEnabled("apply"), 10000);
        QTRY_COMPARE(field("motion.vx")->text(), QString("0.31"));
        QVERIFY(client_->waitConnected().ok());
        OpenWindow::click(panel_, "apply");
        QTRY_COMPARE(setting("motion.vx"), QJsonValue(0.31));
    }

    void closingAsksForWhatIsNotApplied() {
        OpenWindow::type(field("motion.vx"), "0.4");
        QVERIFY(window_->choose(window_->fleet.robot()->withName("scanmatcher"))); // out of sight
        window_->window.close();
        QVERIFY(window_->window.isVisible());
        const QString notice = window_->window.findChild<QLabel *>("noticeBanner")->text();
        VERIFY_CONTAINS(notice, "Settings were changed and are not applied: motorcontrol (1).");
        window_->window.close();
        QVERIFY(!window_->window.isVisible());
    }

    void saveAppliesFirst() {
        OpenWindow::type(field("motion.vx"), "fast");
        QVERIFY(!isEnabled("save"));
        OpenWindow::type(field("motion.vx"), "0.31");
        OpenWindow::click(panel_, "save");
        TRY_STARTS(message(), "Applied. Saved");
        QCOMPARE(setting("motion.vx"), QJsonValue(0.31));
        QCOMPARE(QJsonDocument::fromJson(contentOf(robot_->path("motors.json")))
                     .object()["motion"]
                     .toObject()["vx"],
                 QJsonValue(0.31));
        const double warning = setting("faults.battery_warning_v").toDouble();
        OpenWindow::type(field("faults.battery_v"), QString::number(warning + 1));
        OpenWindow::click(panel_, "save");
        TRY_CONTAINS(message(), "faults.battery_v"); // refused, and not saved
    }

    void theWheelChangesNothing() {
        const auto wheel = [](QWidget *over) {
            const QPointF at(over->rect().center());
            QWheelEvent event(at, over->mapToGlobal(at.toPoint()), {}, {0, -240}, {}, {}, {}, false);
            QApplication::sendEvent(over, &event);
        };
        int lists = 0;
        for (auto *list : window_->window.findChildren<QComboBox *>()) {
            if (list->count() < 2)
                continue;
            const int before = list->currentIndex();
            wheel(list);
            QCOMPARE(list->currentIndex(), before);
            ++lists;
        }
        QVERIFY(lists > 0);
        for (auto *slider : window_->window.findChildren<QSlider *>()) {
            const int before = slider->value();
            wheel(slider);
            QCOMPARE(slider->value(), before);
        }
        auto *const scroll =
            panel_->findChild<QScrollArea *>()->verticalScrollBar(); // which goes on scrolling
        QTRY_VERIFY(scroll->maximum() > 0);                          // as soon as it is laid out
        wheel(panel_->findChild<QScrollArea *>()->viewport());
        QVERIFY(scroll->value() > 0);
    }

    // Before the daemon has answered.
    void typedWhileApplying() {
        OpenWindow::type(field("motion.vx"), "0.31");
        OpenWindow::type(field("pid.p"), "2");
        OpenWindow::click(panel_, "apply");
        OpenWindow::type(field("pid.i"), "0.7");
        OpenWindow::type(field("pid.p"), "3"); // once more
        QTRY_COMPARE(setting("motion.vx"), QJsonValue(0.31));
        QTRY_VERIFY(note("motion.vx") != "changed");
        QCOMPARE(field("pid.i")->text(), QString("0.7"));
        QCOMPARE(note("pid.i"), QString("changed"));
        QCOMPARE(field("pid.p")->text(), QString("3"));
        QCOMPARE(note("pid.p"), QString("changed"));
        OpenWindow::click(panel_, "apply");
        QTRY_COMPARE(setting("pid.i"), QJsonValue(0.7));
        QCOMPARE(setting("pid.p"), QJsonValue(3));
        QTRY_VERIFY(!isEnabled("apply"));
    }

    void listIsEditedAndApplied() {
        OpenWindow::type(panel_->findChild<QLineEdit *>("filter"), "listen");
        auto *const list = panel_->findChild<QWidget *>("listen");
        const QString first = list->findChild<QLineEdit *>()->text();
        OpenWindow::click(list, "add");
        QVERIFY(!isEnabled("apply")); // nothing is typed into the new row
        const QString second = QString("tcp://127.0.0.1:%1?protocol=json").arg(reservePort());
        QTest::keyClicks(QApplication::focusWidget(), second);
        QCOMPARE(note("listen"), QString("changed, needs a restart"));
        OpenWindow::click(panel_, "apply");
        TRY_STARTS(message(), "Applied.");
        QCOMPARE(setting("listen"), QJsonValue(QJsonArray{first, second}));
    }

    // A click is meant for what was there when the hand set out.
    void nothingMovesUnderTheMouse() {
        const auto places = [this] {
            QList<QRect> all;
            for (const char *const button : {"apply", "revert", "defaults", "save"}) {
                auto *const found = panel_->findChild<QPushButton *>(button);
                all.append({found->mapTo(panel_, QPoint()), found->size()});
            }
            for (const char *const row : {"motion.vx", "pid.p"}) {
                auto *const found = panel_->findChild<QWidget *>(row);
                all.append({found->mapTo(panel_, QPoint()), found->size()});
            }
            return all;
        };
        QTest::qWait(100); // laid out
        const QList<QRect> before = places();
        OpenWindow::type(field("motion.vx"), "0.31");
        QCOMPARE(panel_->findChild<QLabel *>("changed")->text(), QString("1 change"));
        QTest::qWait(100);
        QCOMPARE(places(), before);
        OpenWindow::click(panel_, "apply");
        QTRY_COMPARE(message(), QString("Applied."));
        QTRY_VERIFY(panel_->findChild<QLabel *>("message")->isVisible());
        QTest::qWait(100);
        QCOMPARE(places(), before);
    }

    void defaultsAreOfWhatIsInSight() {
        OpenWindow::type(field("motion.vx"), "0.31");
        OpenWindow::type(field("pid.p"), "2");
        OpenWindow::click(panel_, "apply");
        QTRY_COMPARE(setting("pid.p"), QJsonValue(2));
        QTRY_VERIFY(!isEnabled("apply"));
        OpenWindow::type(panel_->findChild<QLineEdit *>("filter"), "motion");
        QVERIFY(panel_->findChild<QPushButton *>("defaults")->toolTip().contains("in sight"));
        OpenWindow::click(panel_, "defaults");
        QVERIFY(field("motion.vx")->text() != "0.31");
        QCOMPARE(field("pid.p")->text(), QString("2"));
        QVERIFY(!note("listen").startsWith("changed"));
        OpenWindow::click(panel_, "revert");
        OpenWindow::type(field("motion.vx"), "0.33");
        OpenWindow::type(panel_->findChild<QLineEdit *>("filter"), "pid");
        QCOMPARE(panel_->findChild<QLabel *>("changed")->text(), QString("1 change, 1 not in sight"));
        const auto headings = panel_->findChildren<QLabel *>("heading");
        const auto shown = std::count_if(headings.begin(), headings.end(),
                                         [](const QLabel *heading) { return heading->isVisible(); });
        QVERIFY2(shown > 0 && shown < headings.size(), saying(shown));
    }

private:
    QLineEdit *field(const QString &path) const {
        return panel_->findChild<QWidget *>(path)->findChild<QLineEdit *>();
    }
    QString note(const QString &path) const { return panel_->findChild<QLabel *>(path + "/note")->text(); }
    QString message() const { return panel_->findChild<QLabel *>("message")->text(); }
    bool isEnabled(const QString &button) const {
        return panel_->findChild<QPushButton *>(button)->isEnabled();
    }
    QJsonValue setting(const QString &path) {
        const auto value = client_->callAndWait("settings.get", QJsonObject{{"path", path}});
        return value ? *value : QJsonValue();
    }

    std::unique_ptr<RobotProcesses> robot_;
    std::unique_ptr<OpenWindow> window_;
    std::unique_ptr<Client> client_; // an independent eye
    SettingsPanel *panel_ = nullptr;
};
