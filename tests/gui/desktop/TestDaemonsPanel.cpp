#include "gui/desktop/panels/CommandsPanel.h"
#include "gui/desktop/panels/DaemonsPanel.h"
#include "gui/desktop/panels/LogPanel.h"
#include "gui/desktop/panels/PlotsPanel.h"
#include "gui/desktop/panels/SettingsPanel.h"
#include "tests/gui/desktop/OpenWindow.h"

using namespace hermes;

/// A supervisor with two daemons, one of them in Python, which the window has never heard of.
class TestDaemonsPanel : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void init() {
        robot_ = std::make_unique<RobotProcesses>();
        ports_ = {{"fan", reservePort()}, {"scanmatcher", reservePort()}};
        const QString url = QString("tcp://127.0.0.1:%1?protocol=json").arg(ports_["scanmatcher"]);
        const QJsonArray processes{
            QJsonObject{
                {"name", "fan"},
                {"program", qEnvironmentVariable("HERMES_SOURCE") + "/docs/examples/daemon.py"},
                // It warns of 60 °C after two seconds.
                {"arguments", QJsonArray{"--port", QString::number(ports_["fan"]), "--set", "alarm_c=120"}},
                {"port", ports_["fan"]},
                {"autostart", true}},
            QJsonObject{{"name", "scanmatcher"},
                        {"arguments", QJsonArray{"--listen", url}},
                        {"port", ports_["scanmatcher"]},
                        {"autostart", true}}};
        ports_["supervisor"] = robot_->start(
            "supervisor",
            {"robot=rover", "processes=" + QJsonDocument(processes).toJson(QJsonDocument::Compact)});
        window_ = std::make_unique<OpenWindow>(*robot_);
        QVERIFY(window_->show());
        QTRY_VERIFY_WITH_TIMEOUT(daemon("fan") && daemon("fan")->hasTopic("air"), 20000);
        QTRY_VERIFY_WITH_TIMEOUT(daemon("scanmatcher") && pid("fan") > 0, 20000);
        QCOMPARE(window_->fleet.robot()->name(), QString("rover"));
    }

    void cleanup() {
        window_.reset();
        robot_.reset();
    }

    void daemonOfAnotherLanguageShowsAllItHas() {
        QTRY_COMPARE(stateOf("fan"), QString("running"));
        QVERIFY(window_->choose(daemon("fan")));
        QTRY_COMPARE(window_->row(daemon("fan"))->childCount(), 1);
        QCOMPARE(window_->row(daemon("fan"))->child(0)->text(0), QString("air"));
        QCOMPARE(window_->row(daemon("fan"))->child(0)->text(1), QString("ok"));

        auto *const settings = window_->panel<SettingsPanel>("settings");
        QTRY_VERIFY(settings->findChild<QWidget *>("alarm_c"));
        QCOMPARE(settings->findChild<QLabel *>("alarm_c/note")->text(), QString("-20 to 120"));
        OpenWindow::type(settings->findChild<QWidget *>("alarm_c")->findChild<QLineEdit *>(), "20");
        OpenWindow::click(settings, "apply");
        QTRY_COMPARE(window_->row(daemon("fan"))->child(0)->text(1), QString("warn"));
        QTRY_COMPARE(stateOf("fan"), QString("warning"));

        auto *const commands = window_->panel<CommandsPanel>("commands");
        auto *const methods = commands->findChild<QListWidget *>("methods");
        methods->setCurrentItem(methods->findItems("fan.boost", Qt::MatchExactly).value(0));
        QVERIFY(!commands->findChild<QPushButton *>("call")->isEnabled()); // the duration is missing
        OpenWindow::type(commands->findChild<QWidget *>("duration_s")->findChild<QLineEdit *>(), "7");
        OpenWindow::click(commands, "call");
        QTRY_VERIFY(commands->findChild<QPlainTextEdit *>("answer")->toPlainText().contains("\"speed\": 1"));
        auto *const records = window_->panel<LogPanel>("log")->findChild<QPlainTextEdit *>("records");
        QTRY_VERIFY(records->toPlainText().contains("full speed for 7 s"));

        auto *const topics = window_->panel<PlotsPanel>("plots")->findChild<QTreeWidget *>("topics");
        QTreeWidgetItem *const air = topics->findItems("air", Qt::MatchExactly | Qt::MatchRecursive).value(0);
        QVERIFY(air);
        air->setExpanded(true);
        QTRY_COMPARE(air->childCount(), 2);
        QCOMPARE(air->child(1)->text(0), QString("temperature_c"));
    }

    void stopStartRestart() {
        QVERIFY(window_->choose(daemon("fan")));
        const int first = pid("fan");
        OpenWindow::click(panel(), "process.stop");
        QTRY_COMPARE(stateOf("fan"), QString("stopped"));
        QTRY_VERIFY(!panel()->findChild<QPushButton *>("process.stop")->isEnabled());
        OpenWindow::click(panel(), "process.start");
        QTRY_COMPARE_WITH_TIMEOUT(stateOf("fan"), QString("running"), 10000);
        QTRY_VERIFY(pid("fan") > 0 && pid("fan") != first);
        const int second = pid("fan");
        OpenWindow::click(panel(), "process.restart");
        QTRY_VERIFY_WITH_TIMEOUT(pid("fan") > 0 && pid("fan") != second, 10000);
        QTRY_COMPARE_WITH_TIMEOUT(stateOf("fan"), QString("running"), 10000);
        QVERIFY(!message()->isVisible());
    }

    void killedDaemonComesBack() {
        QVERIFY(window_->choose(daemon("scanmatcher")));
        QTRY_VERIFY_WITH_TIMEOUT(pid("scanmatcher") > 0 && daemon("scanmatcher")->isConnected(), 10000);
        DaemonLink *const before = daemon("scanmatcher");
        bool wasUnreachable = false; // for half a second, until it is started again
        QObject context;
        connect(before, &DaemonLink::changed, &context,
                [&] { wasUnreachable = wasUnreachable || before->condition() == Condition::Unreachable; });
        QCOMPARE(::kill(pid("scanmatcher"), SIGKILL), 0);
        QTRY_VERIFY(wasUnreachable);
        QTRY_VERIFY_WITH_TIMEOUT(before->isConnected(), 10000);
        QCOMPARE(daemon("scanmatcher"), before); // the same row, still chosen
        QVERIFY(window_->fleet.daemon() == before);
        QTRY_COMPARE(process("scanmatcher").restarts, 1);
    }

    void whatNobodyManagesHasNoButtons() {
        QVERIFY(window_->choose(daemon("supervisor")));
        for (const char *const name : {"process.start", "process.stop", "process.restart"}) {
            auto *const button = panel()->findChild<QPushButton *>(name);
            QVERIFY(!button->isEnabled());
            QVERIFY(button->toolTip().contains("supervisor"));
        }
    }

    void addedByAddress() {
        const quint16 port = robot_->start("velodynelogger");
        auto *const field = panel()->findChild<QLineEdit *>("address");
        OpenWindow::type(field, QString(" localhost:%1").arg(port));
        QTest::keyClick(field, Qt::Key_Return);
        QVERIFY(field->text().isEmpty());
        QCOMPARE(window_->fleet.robots().size(), size_t(2)); // until it has said that it knows none
        const Robot &robot = *window_->fleet.robots().front();
        QTRY_VERIFY_WITH_TIMEOUT(robot.withName("velodynelogger"), 10000);
        QVERIFY(window_->choose(robot.withName("velodynelogger")));
        QCOMPARE(window_->fleet.robot(), &robot);
        QCOMPARE(window_->fleet.robots().size(), size_t(1));
    }

    void badAddressIsToldBesideIt() {
        auto *const field = panel()->findChild<QLineEdit *>("address");
        for (const char *const address :
             {"", ":", "robot:", "robot:0", "robot:65536", "robot:x", "http://robot:80", "robot:80/path",
              "a b:7400", "[::1", "1.2.3.4:7400:7410"}) {
            OpenWindow::type(field, address);
            OpenWindow::click(panel(), "add");
            QVERIFY2(message()->isVisible(), address);
            VERIFY_CONTAINS(message()->text(), address);
            QCOMPARE(field->text(), QString(address)); // to be mended
            QCOMPARE(window_->fleet.robots().size(), size_t(1));
        }
    }

    // A program of that name which tells of one daemon, then fails.
    void foundOnTheNetwork() {
        const QString tool = robot_->path("hermesctl");
        const auto write = [&tool](const QByteArray &script) {
            QFile file(tool);
            return file.open(QIODevice::WriteOnly) && file.write("#!/bin/sh\n" + script) > 0 &&
                   file.setPermissions(QFile::ReadOwner | QFile::WriteOwner | QFile::ExeOwner);
        };
        const QByteArray before = qgetenv("PATH");
        qputenv("PATH", QFileInfo(tool).path().toUtf8() + ':' + before);
        QVERIFY(
            write(R"(echo '[{"name":"x","address":"127.0.0.9","port":7499,"framing":"json","tls":"no"}]')"));
        const auto robots = window_->fleet.robots().size();
        OpenWindow::click(panel(), "find");
        QTRY_VERIFY(message()->text().startsWith("1 daemons announce"));
        QCOMPARE(window_->fleet.robots().size(), robots + 1);
        QVERIFY(write("echo '{\"message\":\"no bus\"}' >&2; exit 1"));
        OpenWindow::click(panel(), "find");
        QTRY_COMPARE(
            message()->text(),
            QString("This computer cannot look for robots on the network. Type the address of the robot "
                    "into the field above, as 192.168.1.20, and press Add."));
        qputenv("PATH", before);
    }

private:
    /// By its port: others may run daemons of these names on this machine.
    DaemonLink *daemon(const QString &name) const {
        for (DaemonLink *found : window_->fleet.robot()->daemons())
            if (found->isKnown() && found->address().endsWith(QString(":%1").arg(ports_.at(name))))
                return found;
        return nullptr;
    }
    ProcessStatus process(const QString &name) const {
        const ProcessStatus *const told = window_->fleet.robot()->process(*daemon(name));
        return told ? *told : ProcessStatus();
    }
    int pid(const QString &name) const { return int(process(name).pid); }
    QString stateOf(const QString &name) const { return window_->row(daemon(name))->text(1); }
    DaemonsPanel *panel() const { return window_->panel<DaemonsPanel>("daemons"); }
    QLabel *message() const { return panel()->findChild<QLabel *>("message"); }

    std::map<QString, quint16> ports_;
    std::unique_ptr<RobotProcesses> robot_;
    std::unique_ptr<OpenWindow> window_;
};
