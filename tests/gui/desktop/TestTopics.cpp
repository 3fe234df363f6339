#include "gui/desktop/panels/PlotsPanel.h"
#include "gui/desktop/panels/TopicTree.h"
#include "gui/desktop/view/PlotPane.h"
#include "tests/gui/desktop/FakeDaemon.h"
#include "tests/gui/desktop/HostileRows.h"
#include "tests/gui/desktop/OpenWindow.h"
#include "tests/support/FakeRobot.h"

using namespace hermes;

/// Topics of a robot: their rate and age, their newest message, and what is plotted of them.
class TestTopics : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void init() {
        robot_ = std::make_unique<FakeRobot>();
        window_ = std::make_unique<OpenWindow>(robot_->address());
        QVERIFY(window_->show());
        panel_ = window_->panel<PlotsPanel>("plots");
    }

    void cleanup() {
        window_.reset();
        robot_.reset();
    }

    void rateAndAge() {
        QTreeWidgetItem *const odometry = row("odometry");
        QVERIFY(odometry);
        const auto rate_hz = [odometry] { return odometry->text(1).section(" Hz, ", 0, 0).toDouble(); };
        QTRY_VERIFY_WITH_TIMEOUT(rate_hz() > 30 && rate_hz() < 60, 20000); // 50 Hz on a machine with time
        QVERIFY2(odometry->text(1).endsWith(" s"), qPrintable(odometry->text(1)));
        QCOMPARE(odometry->foreground(1), QBrush());
        robot_->setSilent(true);
        QTRY_VERIFY_WITH_TIMEOUT(odometry->foreground(1) != QBrush(), 5000); // grey
        QTRY_VERIFY2_WITH_TIMEOUT(odometry->text(1).startsWith("no data for "), qPrintable(odometry->text(1)),
                                  8000);
        robot_->setSilent(false);
        QTRY_VERIFY_WITH_TIMEOUT(odometry->text(1).contains(" Hz, "), 8000);
        // What nobody sees is not asked for.
        window_->panel<QWidget>("log");
        QTRY_COMPARE(odometry->text(1), QString());
        window_->panel<PlotsPanel>("plots");
        QTRY_VERIFY_WITH_TIMEOUT(odometry->text(1).contains(" Hz, "), 8000);
    }

    void newestMessageAsATree() {
        chooseMessage("odometry");
        QTRY_COMPARE(at({"twist", "vx"}).value(1), QString("m/s"));
        QCOMPARE(at({"twist", "omega"}).value(1), QString("rad/s"));
        QCOMPARE(at({"covariance"}).value(0), QString("9 in a list"));
        QTRY_VERIFY2(head().startsWith("odometry of motorcontrol: ") && head().contains(" Hz, "),
                     qPrintable(head()));
        const QString mono = at({"mono"}).value(0);
        QTRY_VERIFY(at({"mono"}).value(0) != mono); // it goes on
        const DaemonLink *const motors = window_->fleet.robot()->withTopic("power");
        const auto schema = [motors](const QString &topic) {
            return topicDescription(motors->description(), topic)["schema"].toObject();
        };
        QVERIFY(!isHeavy(schema("power")) && !isHeavy(schema("odometry"))); // so it comes ten times a second
        QVERIFY(isHeavy({{"type", "array"}, {"items", QJsonObject{{"type", "number"}}}}));
        chooseMessage("power");
        QTRY_COMPARE(at({"controllers", "0", "battery_v"}).value(1), QString("V"));
        QCOMPARE(at({"controllers", "0", "temperature_c"}).value(1), QString("°C"));
        QCOMPARE(at({"controllers", "0", "current_a", "1"}).value(1), QString("A"));
        QCOMPARE(at({"controllers", "0", "ready"}).value(0), QString("yes"));
        chooseMessage("odometry");
        QTRY_VERIFY2(head().startsWith("odometry of ") && head().contains(" Hz, "), qPrintable(head()));
        robot_->setSilent(true);
        QTRY_VERIFY_WITH_TIMEOUT(head().contains("no data for "), 10000);
    }

    // As large as messages may be, as fast as they come.
    void largeMessagesAreCut() {
        Mischief mischief = ofTopic("free",
                                    "{\"count\":%1,\"long\":" + listOf("0.123456", 15000) + ",\"deep\":" +
                                        inBrackets("1", 50) + ",\"wide\":" + objectOf("{\"a\":[1,2]}", 3000) +
                                        ",\"text\":\"" + QByteArray(50000, 'W') + "\"}",
                                    -1);
        const FakeDaemon daemon(mischief);
        QVERIFY(window_->fleet.add(daemon.address()).ok());
        QTRY_VERIFY(row("free"));
        chooseMessage("free");
        QTRY_VERIFY2_WITH_TIMEOUT(at({"long"}).value(0) == "15000 in a list", qPrintable(head()), 20000);
        QCOMPARE(at({"long", "39"}).value(0), QString("0.123456"));
        QVERIFY(!at({"long", "and 14960 more"}).isEmpty());
        QVERIFY(at({"text"}).value(0).size() < 200);
        int rows = 0;
        for (QTreeWidgetItemIterator i(message()); *i; ++i)
            ++rows;
        QVERIFY2(rows < 600, saying(rows));
        LoopWatch watch;
        const QString count = at({"count"}).value(0);
        QTest::qWait(1500);
        QVERIFY(at({"count"}).value(0) != count);
        qInfo("busy %.1f ms", watch.longestCpu_ms());
        QVERIFY2(watch.longestCpu_ms() < 100 * slowness, saying(watch.longestCpu_ms()));
    }

private:
    QTreeWidgetItem *row(const QString &name) const {
        return panel_->findChild<TopicTree *>()
            ->findItems(name, Qt::MatchExactly | Qt::MatchRecursive)
            .value(0);
    }
    void chooseMessage(const QString &topic) {
        panel_->findChild<TopicTree *>()->setCurrentItem(row(topic));
        if (!panel_->findChild<QPushButton *>("showMessage")->isChecked())
            OpenWindow::click(panel_, "showMessage");
    }
    QTreeWidget *message() const { return panel_->findChild<QTreeWidget *>("newestMessage"); }
    /// The value and the unit at a path of names.
    QStringList at(const QStringList &path) const {
        QTreeWidgetItem *item = message()->topLevelItem(0);
        for (const QString &name : path) {
            QTreeWidgetItem *next = nullptr;
            for (int i = 0; item && i < item->childCount(); ++i)
                if (item->child(i)->text(0) == name)
                    next = item->child(i);
            item = next;
        }
        return item ? QStringList{item->text(1), item->text(2)} : QStringList();
    }
    QString head() const { return panel_->findChild<QLabel *>("messageHead")->text(); }

    std::unique_ptr<FakeRobot> robot_;
    std::unique_ptr<OpenWindow> window_;
    PlotsPanel *panel_ = nullptr;
};
