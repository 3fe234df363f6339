#include "gui/desktop/panels/RecordPanel.h"
#include "tests/gui/desktop/RobotProcesses.h"

#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QTreeWidget>

using namespace hermes;

/// Records what the simulated lidar sends, with a serial logger beside it, and replays it.
class TestRecordPanel : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void recordsAsOneAndReplays();

private:
    template <typename T>
    T *find(const QString &name) const {
        return panel_->findChild<T *>(name);
    }
    void click(const QString &button) { QTest::mouseClick(find<QPushButton>(button), Qt::LeftButton); }
    QString message() const { return find<QLabel>("message")->text(); }

    std::unique_ptr<RecordPanel> panel_;
};

void TestRecordPanel::recordsAsOneAndReplays() {
    RobotProcesses robot;
    robot.startAll();
    robot.start("seriallogger", {"record.folder=" + robot.path("recordings")});
    Fleet fleet;
    robot.connectTo(fleet);
    panel_ = std::make_unique<RecordPanel>(fleet);
    panel_->show();
    QTRY_VERIFY(find<QLabel>("amount")->text().contains("velodynelogger") &&
                find<QLabel>("amount")->text().contains("seriallogger"));

    find<QLineEdit>("name")->setText("first");
    click("record");
    QTRY_COMPARE(message(), QString("Recording first."));
    QTRY_COMPARE(find<QPushButton>("record")->text(), QString("S&top"));
    QTRY_VERIFY_WITH_TIMEOUT(find<QLabel>("amount")->text().contains("the disk will do for"), 15000);
    click("record");
    QTRY_COMPARE(find<QPushButton>("record")->text(), QString("Re&cord"));
    QTRY_VERIFY2(message().contains("nothing missing"), qPrintable(message()));

    auto *const sessions = find<QTreeWidget>("sessions");
    QTRY_COMPARE(sessions->topLevelItemCount(), 1); // both loggers, one session
    QCOMPARE(sessions->topLevelItem(0)->text(0), QString("first"));
    QTRY_VERIFY(sessions->topLevelItem(0)->toolTip(0).contains("seriallogger, velodynelogger") ||
                sessions->topLevelItem(0)->toolTip(0).contains("velodynelogger, seriallogger"));

    click("record"); // the same name once more
    QTRY_VERIFY(message().startsWith("Nothing is recorded."));
    QTRY_COMPARE(find<QPushButton>("record")->text(), QString("Re&cord"));

    sessions->setCurrentItem(sessions->topLevelItem(0));
    QTRY_VERIFY(find<QPushButton>("replay")->isEnabled());
    DaemonLink *const lidar = fleet.robot()->withName("velodynelogger");
    const auto state = [lidar] {
        return lidar->client()
            .callAndWait("source.status")
            ->toObject()["source"]
            .toObject()["state"]
            .toString();
    };
    click("replay");
    QTRY_COMPARE(state(), QString("replay"));
    QTRY_VERIFY(find<QPushButton>("live")->isEnabled());
    click("live");
    QTRY_COMPARE(state(), QString("live"));
    click("replay");
    QTRY_COMPARE(state(), QString("replay"));
    QTRY_COMPARE_WITH_TIMEOUT(state(), QString("live"), 15000); // played to its end
    QTRY_VERIFY(!find<QPushButton>("live")->isEnabled());
    panel_.reset();
}

QTEST_MAIN(TestRecordPanel)
#include "TestRecordPanel.moc"
