#include "gui/desktop/panels/MapPanel.h"
#include "gui/desktop/panels/RecordPanel.h"
#include "tests/gui/desktop/FakeDaemon.h"
#include "tests/gui/desktop/OpenWindow.h"

using namespace hermes;

/// What is shown of a robot goes with it: no panel shows it of another one.
class TestChosenRobot : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void mapOfOneIsNotOfTheOther() {
        FakeDaemon red(withMap());
        const FakeDaemon blue(robot("blue"));
        OpenWindow open;
        QVERIFY(open.show());
        QVERIFY(open.fleet.add(red.address()));
        QVERIFY(open.fleet.add(blue.address()));
        QTRY_VERIFY(open.fleet.robotAt(red.address()) && open.fleet.robotAt(blue.address()));
        const MapModel &model = open.window.findChild<MapPanel *>()->model();
        QTRY_COMPARE(model.edges().size(), 1);
        QTRY_COMPARE(model.scan().size(), 2);
        QTRY_COMPARE(model.segments().size(), 1);
        red.say("scan", withMap().topics["scan"]); // when the map is known
        QTRY_COMPARE(model.correspondences().size(), 1);
        for (const char *const x : {"1", "2", "3"}) // once the pose is known
            red.say("odometry", withMap().topics["odometry"].replace("%1", x));
        QTRY_VERIFY(!model.odometryPath().isEmpty());
        QTRY_COMPARE(open.window.findChild<QLabel *>("measured0")->text(), QString("0.25"));

        open.fleet.choose(open.fleet.robotAt(blue.address()));
        QVERIFY(model.edges().isEmpty() && model.scan().isEmpty() && model.segments().isEmpty());
        QVERIFY(model.correspondences().isEmpty() && model.odometryPath().isEmpty() && !model.pose());
        QCOMPARE(model.reliability(), 0.0);
        QTRY_VERIFY(open.window.findChild<QLabel *>("measured0")->text() != "0.25");

        open.fleet.choose(open.fleet.robotAt(red.address()));
        QTRY_COMPARE(model.edges().size(), 1);
    }

    /// However reliable the match is.
    void onlyATrustedPoseIsGreen() {
        Mischief robot = withMap();
        robot.topics["graph"] = "{}"; // without one there is no trust
        FakeDaemon daemon(robot);
        OpenWindow open;
        QVERIFY(open.show());
        QVERIFY(open.fleet.add(daemon.address()));
        const MapModel &model = open.window.map().model();
        QTRY_COMPARE(model.reliability(), 0.5);
        for (const bool isTrusted : {true, false}) {
            const QByteArray pose = R"({"x":0,"y":0,"theta":0,"outcome":"matched","scan":1,"trust":)" +
                                    QByteArray(isTrusted ? "0.9}" : "0.3}");
            QTRY_VERIFY(
                (daemon.say("pose", pose), model.poseAge().isFresh() && open.isGreenSeen() == isTrusted));
        }
    }

    /// Its points lie where the matcher took them.
    void scanOfAnUpsideDownScannerIsMirrored() {
        FakeDaemon daemon(withMap());
        OpenWindow open;
        QVERIFY(open.show());
        QVERIFY(open.fleet.add(daemon.address()));
        const MapModel &model = open.window.map().model();
        QTRY_COMPARE(model.scan().size(), 2);
        const double y = model.scan().last().y();
        QVERIFY(y != 0);
        daemon.say("pose", R"({"x":0,"y":0,"theta":0,"outcome":"matched","scan":0,"upside_down":true})");
        QTRY_COMPARE(model.scan().last().y(), -y);
    }

    void recordingsOfOneAreNotOfTheOther() {
        Mischief recorded = robot("red");
        recorded.results["session.list"] =
            R"([{"name":"corridor","session":"x","start":1700000000,"bytes":5,"daemons":[],"problems":[]}])";
        Mischief slow = robot("blue"); // has recordings, too, but does not tell of them
        slow.results["session.list"] = "[]},\"x\":{";
        const FakeDaemon red(recorded), blue(slow);
        OpenWindow open;
        QVERIFY(open.fleet.add(red.address()));
        QVERIFY(open.fleet.add(blue.address()));
        auto *const list = open.window.findChild<RecordPanel *>()->findChild<QTreeWidget *>("sessions");
        QTRY_VERIFY(open.fleet.robotAt(red.address()) && open.fleet.robotAt(blue.address()));
        QTRY_COMPARE(list->topLevelItemCount(), 1);
        QCOMPARE(list->topLevelItem(0)->text(0), QString("corridor"));
        open.fleet.choose(open.fleet.robotAt(blue.address()));
        QCOMPARE(list->topLevelItemCount(), 0); // at once
    }

    // Two daemons of one robot have the same topics.
    void topicsStayWithTheirDaemon() {
        auto first = std::make_unique<FakeDaemon>(Mischief());
        Fleet fleet;
        QVERIFY(fleet.add(first->address()));
        QTRY_VERIFY(fleet.robot()->withTopic("pose"));
        DaemonLink *const source = fleet.robot()->withTopic("pose");
        TopicFeed feed(
            fleet, "pose", {}, [](const TopicUpdate &) {}, nullptr);
        QCOMPARE(feed.source(), source);
        const FakeDaemon second{Mischief()};
        QVERIFY(fleet.add(second.address()));
        QTRY_COMPARE(int(fleet.robot()->allWithMethod("fake.call").size()), 2);
        QCOMPARE(feed.source(), source);
        first.reset();
        QTRY_COMPARE(int(fleet.robot()->allWithMethod("fake.call").size()), 1);
        QCOMPARE(feed.source(), source); // it is waited for
    }

private:
    /// A robot of a single daemon.
    static Mischief robot(const QByteArray &name) {
        Mischief all;
        all.topics["processes"] = "{\"robot\":\"" + name + "\",\"processes\":[]}";
        return all;
    }
    static Mischief withMap() {
        Mischief all = robot("red");
        all.topics["map"] =
            R"({"revision":1,"cleared":true,"size":1,"removed":[],
                "edges":[{"id":1,"x1":0,"y1":0,"x2":1,"y2":0}]})";
        all.topics["pose"] = R"({"x":0,"y":0,"theta":0,"outcome":"matched","scan":0})";
        all.topics["scan2d"] =
            R"({"turn":0,"stamp":1,"duration_s":0.1,"x":[1,2],"y":[0,1],"t":[0,0],"laser":1,"frame":"lidar"})";
        all.topics["scan"] = R"({"stamp":1,"pose":{"x":0,"y":0,"theta":0,"outcome":"matched"},
            "match":{"reliability":0.5,"ambiguity":0.1,"pairs":[[1,0]]},"segments":[[0,0,1,1]]})";
        all.topics["odometry"] =
            R"({"pose":{"x":%1,"y":0,"theta":0},"twist":{"vx":0.25,"vy":0,"omega":0},"covariance":[0,0,0,0,0,0,0,0,0],"mono":1})";
        for (QByteArray &message : all.topics)
            message.replace('\n', ' ');
        all.messages = 3;
        return all;
    }
};
