#include "gui/desktop/model/Fleet.h"
#include "tests/gui/desktop/FakeDaemon.h"

using namespace hermes;
using namespace hermes::desktop;

/// Which daemon belongs to which robot, and which robot is the chosen one.
class TestFleet : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void whatASupervisorNamesIsItsRobot() {
        const FakeDaemon motors(plain()), stranger(plain());
        Fleet fleet;
        QVERIFY(fleet.add(addressOf(motors)));
        QVERIFY(fleet.add(addressOf(stranger)));
        QCOMPARE(namesOf(fleet), QStringList("127.0.0.1"));
        DaemonLink *const link = fleet.robots().front()->daemons().front();
        const FakeDaemon rover(supervisor("rover", {motors.port()}));
        QSignalSpy moved(&fleet, &Fleet::moved);
        QVERIFY(fleet.add(addressOf(rover))); // second
        QTRY_COMPARE(ownerOf(fleet, motors), QString("rover"));
        QCOMPARE(ownerOf(fleet, rover), QString("rover"));
        QCOMPARE(ownerOf(fleet, stranger), QString("127.0.0.1"));
        QCOMPARE(namesOf(fleet), QStringList({"127.0.0.1", "rover"}));
        QVERIFY(fleet.robotAt(addressOf(rover))->has(link) || link->address() == addressOf(stranger));
        QCOMPARE(moved.count(), 2); // the supervisor and the motors
    }

    void twoSupervisorsOfOneHostAreTwo() {
        const FakeDaemon first(plain()), second(plain());
        const FakeDaemon one(supervisor("one", {first.port()})), other(supervisor("other", {second.port()}));
        Fleet fleet;
        QVERIFY(fleet.add(addressOf(one)));
        QVERIFY(fleet.add(addressOf(other)));
        QTRY_COMPARE(namesOf(fleet), QStringList({"one", "other"}));
        QTRY_COMPARE(ownerOf(fleet, first), QString("one"));
        QTRY_COMPARE(ownerOf(fleet, second), QString("other"));
        QCOMPARE(fleet.robot()->name(), QString("one")); // that was added first
        for (const auto &robot : fleet.robots()) {
            QTRY_COMPARE(int(robot->allWithMethod("motor.drive").size()), 1);
            QCOMPARE(robot->problem(), QString());
        }
    }

    void whoNamesADaemonFirstKeepsIt() {
        FakeDaemon motors(plain()), one(supervisor("one", {motors.port()}));
        const FakeDaemon other(supervisor("other", {motors.port()}));
        Fleet fleet;
        QVERIFY(fleet.add(addressOf(one)));
        QTRY_COMPARE(ownerOf(fleet, motors), QString("one"));
        QVERIFY(fleet.add(addressOf(other)));
        QTRY_VERIFY(fleet.robotAt(addressOf(other)));
        const Robot &loser = *fleet.robotAt(addressOf(other));
        QTRY_COMPARE(loser.problem(),
                     QString("Port %1 stays with the robot one, which names it too").arg(motors.port()));
        QCOMPARE(ownerOf(fleet, motors), QString("one"));
        QCOMPARE(fleet.robotAt(addressOf(one))->problem(), QString());
        one.say("processes", list("one", {}));
        QTRY_COMPARE(ownerOf(fleet, motors), QString("other"));
        QCOMPARE(loser.problem(), QString());
    }

    // Its own, the other supervisor's, none, one twice, and a thousand.
    void namesPortsOfAllKinds() {
        FakeDaemon one(supervisor("one", {}));
        const FakeDaemon other(supervisor("other", {}));
        Fleet fleet;
        QVERIFY(fleet.add(addressOf(one)));
        QVERIFY(fleet.add(addressOf(other)));
        QTRY_COMPARE(namesOf(fleet), QStringList({"one", "other"}));
        QVector<int> ports{one.port(), other.port(), other.port(), 0};
        one.say("processes", list("one", ports));
        const Robot &robot = *fleet.robotAt(addressOf(one));
        QTRY_COMPARE(robot.problem(), QString("Port %1 is that of the robot other").arg(other.port()));
        QCOMPARE(ownerOf(fleet, other), QString("other"));
        for (int port = 20000; port < 21000; ++port)
            ports.append(port);
        one.say("processes", list("one", ports));
        QTRY_VERIFY(robot.problem().startsWith("904 more processes"));
        QCOMPARE(int(robot.daemons().size()), 97); // and itself
        QCOMPARE(int(fleet.robotAt(addressOf(other))->daemons().size()), 1);
    }

    void namedNoMore() {
        FakeDaemon known(plain()), unknown(plain()),
            rover(supervisor("rover", {known.port(), unknown.port(), 9}));
        Fleet fleet;
        QVERIFY(fleet.add(addressOf(known)));
        QVERIFY(fleet.add(addressOf(rover)));
        QTRY_COMPARE(ownerOf(fleet, unknown), QString("rover"));
        QTRY_COMPARE(int(fleet.robot()->allWithMethod("motor.drive").size()), 2);
        rover.say("processes", list("rover", {}));
        QTRY_COMPARE(ownerOf(fleet, known), QString("127.0.0.1"));
        QCOMPARE(ownerOf(fleet, unknown), QString("127.0.0.1")); // it is there
        QCOMPARE(int(fleet.robotAt("127.0.0.1")->daemons().size()), 2);
        rover.say("processes", list("rover", {known.port(), unknown.port()}));
        QTRY_COMPARE(namesOf(fleet), QStringList("rover"));
    }

    void whatIsChosenStaysChosen() {
        FakeDaemon motors(plain()), stranger(plain());
        Fleet fleet;
        QVERIFY(fleet.add(addressOf(motors)));
        QVERIFY(fleet.add(addressOf(stranger)));
        Robot *const host = fleet.robots().front().get();
        DaemonLink *const chosen = host->daemons()[motors.port() < stranger.port() ? 0 : 1];
        fleet.choose(chosen);
        QSignalSpy daemonChosen(&fleet, &Fleet::daemonChosen), robotChosen(&fleet, &Fleet::robotChosen);
        FakeDaemon rover(supervisor("rover", {motors.port()}));
        QVERIFY(fleet.add(addressOf(rover)));
        QTRY_COMPARE(ownerOf(fleet, motors), QString("rover"));
        QCOMPARE(fleet.robot(), host);
        QCOMPARE(robotChosen.count(), 0);
        QVERIFY(!fleet.daemon()); // the panels show none of another robot
        QCOMPARE(daemonChosen.count(), 1);
        fleet.choose(chosen);
        QCOMPARE(fleet.robot()->name(), QString("rover"));
        fleet.choose(host);
        QVERIFY(!fleet.daemon());
        fleet.choose(fleet.robotAt(addressOf(rover)));
        QVERIFY(fleet.daemon() == chosen); // as it was when that robot was chosen last
        fleet.choose(host);
        rover.say("processes", list("rover", {}));
        QTRY_COMPARE(ownerOf(fleet, motors), QString("127.0.0.1"));
        fleet.choose(fleet.robotAt(addressOf(rover)));
        QVERIFY(!fleet.daemon()); // which is another robot's now
        fleet.choose(host);
        rover.say("processes", list("rover", {motors.port(), stranger.port()}));
        QTRY_COMPARE(int(fleet.robots().size()), 1); // nobody is left there
        QCOMPARE(fleet.robot()->name(), QString("rover"));
    }

    void theRobotOfLastTimeIsChosen() {
        const FakeDaemon one(supervisor("one", {})), other(supervisor("other", {}));
        for (const bool isMeant : {false, true}) {
            Fleet fleet;
            fleet.prefer(addressOf(other));
            QVERIFY(fleet.add(addressOf(one)));
            QTRY_VERIFY(fleet.robotAt(addressOf(one)));
            if (isMeant)
                fleet.keepChoice(); // somebody drives it
            QVERIFY(fleet.add(addressOf(other)));
            QTRY_VERIFY(fleet.robotAt(addressOf(other)));
            QCOMPARE(fleet.robot(), fleet.robotAt(addressOf(isMeant ? one : other)));
        }
    }

    void whatIsNoAddressIsRefused() {
        Fleet fleet;
        for (const char *const wrong :
             {"999.1.1.1", "999.1.1.1:7450", "1.2.3", "1.2.3.4.5", "256.0.0.1", "1..2.3"})
            QVERIFY2(!fleet.add(wrong), wrong);
        QVERIFY(fleet.addresses().isEmpty());
        for (const char *const right : {"192.168.1.20", "10.0.0.1:7450", "rover-3", "rover.3d"})
            QVERIFY2(fleet.add(right), right);
    }

    void twoNamesOfThisComputerAreOneHost() {
        const FakeDaemon daemon(plain());
        Fleet fleet;
        QVERIFY(fleet.add(addressOf(daemon)));
        QVERIFY(fleet.add(QString("localhost:%1").arg(daemon.port())));
        QVERIFY(fleet.add("localhost"));
        QVERIFY(fleet.add("127.0.0.1"));
        QCOMPARE(fleet.addresses(), QStringList({addressOf(daemon), "127.0.0.1"}));
        QTRY_VERIFY(fleet.robotAt("127.0.0.1")->withName("fake"));
        int count = 0;
        for (const auto &robot : fleet.robots())
            for (const DaemonLink *link : robot->daemons())
                count += link->port() == daemon.port();
        QCOMPARE(count, 1);
    }

    void oneProcessAtTwoAddressesIsTold() {
        Mischief named = supervisor("rover", {});
        named.results["daemon.info"] =
            R"({"name":"supervisor","pid":17,"started":1000.5,"host":"h","description_hash":"1"})";
        const FakeDaemon one(named), other(named);
        Fleet fleet;
        QVERIFY(fleet.add(addressOf(one)));
        QTRY_VERIFY(fleet.robotAt(addressOf(one)));
        QVERIFY(fleet.add(addressOf(other)));
        QTRY_VERIFY(fleet.robotAt(addressOf(other)));
        const auto problems = [&] {
            return fleet.robotAt(addressOf(one))->problem() + fleet.robotAt(addressOf(other))->problem();
        };
        TRY_STARTS(problems(), "The same as the robot rover");
    }

    void robotsOfOneNameAreToldApart() {
        const FakeDaemon one(supervisor("rover", {})), other(supervisor("rover", {}));
        Fleet fleet;
        QVERIFY(fleet.add(addressOf(one)));
        QTRY_VERIFY(fleet.robotAt(addressOf(one)) && fleet.robot()->name() == "rover");
        QCOMPARE(fleet.titleOf(*fleet.robot()), QString("rover"));
        QVERIFY(fleet.add(addressOf(other)));
        QTRY_COMPARE(namesOf(fleet), QStringList({"rover", "rover"}));
        for (const auto &robot : fleet.robots())
            QCOMPARE(fleet.titleOf(*robot), QString("rover (%1)").arg(robot->address()));
    }

    void givenNames() {
        const FakeDaemon one(supervisor("rover", {}));
        Fleet fleet;
        fleet.setNames({{addressOf(one), "Red"}});
        QVERIFY(fleet.add(addressOf(one)));
        QTRY_COMPARE(namesOf(fleet), QStringList("Red"));
        fleet.rename(*fleet.robot(), "  " + QString(10000, 'x'));
        QVERIFY(fleet.robot()->name().size() < 40);
        fleet.rename(*fleet.robot(), " ");
        QTRY_COMPARE(namesOf(fleet), QStringList("rover"));
        QVERIFY(fleet.names().isEmpty());
    }

    void putToARobotOfItsOwn() {
        const FakeDaemon one(plain()), other(plain()), third(plain());
        QMap<QString, QString> places;
        {
            Fleet fleet;
            for (const FakeDaemon *daemon : {&one, &other, &third})
                QVERIFY(fleet.add(addressOf(*daemon)));
            const auto link = [&](const FakeDaemon &daemon) {
                for (const auto &robot : fleet.robots())
                    for (DaemonLink *found : robot->daemons())
                        if (found->address() == addressOf(daemon))
                            return found;
                return static_cast<DaemonLink *>(nullptr);
            };
            fleet.choose(link(other));
            QSignalSpy moved(&fleet, &Fleet::moved);
            fleet.place(link(other), nullptr);
            QCOMPARE(moved.count(), 1);
            QCOMPARE(ownerOf(fleet, other), QString("127.0.0.1#2"));
            QCOMPARE(fleet.robot()->name(), QString("127.0.0.1")); // as it was
            QVERIFY(!fleet.daemon());
            fleet.place(link(third), fleet.robotAt("127.0.0.1#2"));
            fleet.place(link(one), nullptr);
            QCOMPARE(namesOf(fleet), QStringList({"127.0.0.1#2", "127.0.0.1#3"}));
            places = fleet.places();
            fleet.place(link(one), fleet.robotAt("127.0.0.1#2"));
            QCOMPARE(namesOf(fleet), QStringList("127.0.0.1#2"));
        }
        Fleet next;
        QVERIFY(next.add(addressOf(one)));
        places["127.0.0.1:1"] = "127.0.0.1:7"; // nonsense
        places["x"] = "10.0.0.1#2";
        next.setPlaces(places);
        for (const FakeDaemon *daemon : {&other, &third})
            QVERIFY(next.add(addressOf(*daemon)));
        QVERIFY(next.add("127.0.0.1:1"));
        QCOMPARE(namesOf(next), QStringList({"127.0.0.1", "127.0.0.1#2", "127.0.0.1#3"}));
        QCOMPARE(ownerOf(next, third), QString("127.0.0.1#2"));
        const FakeDaemon rover(supervisor("rover", {third.port()}));
        QVERIFY(next.add(addressOf(rover)));
        QTRY_COMPARE(ownerOf(next, third), QString("rover")); // who names it knows better
    }

    void removedAndBroughtBack() {
        const FakeDaemon motors(plain()), stranger(plain()), rover(supervisor("rover", {motors.port()}));
        Fleet fleet;
        for (const FakeDaemon *daemon : {&motors, &stranger, &rover})
            QVERIFY(fleet.add(addressOf(*daemon)));
        QTRY_COMPARE(ownerOf(fleet, motors), QString("rover"));
        fleet.choose(fleet.robotAt(addressOf(rover)));
        fleet.setObjection([](const Robot &robot) { return robot.name() + " is busy"; });
        QCOMPARE(fleet.remove(fleet.robot()).error().message, QString("rover is busy"));
        fleet.setObjection({});
        QPointer<DaemonLink> link = fleet.robot()->daemons().front();
        const auto back = fleet.remove(fleet.robot());
        QVERIFY(back);
        QCOMPARE(namesOf(fleet), QStringList("127.0.0.1"));
        QCOMPARE(fleet.robot()->name(), QString("127.0.0.1"));
        QCOMPARE(fleet.addresses(), QStringList(addressOf(stranger)));
        QTRY_VERIFY(!link); // and no connection of it
        for (const QString &address : *back)
            QVERIFY(fleet.add(address));
        QTRY_COMPARE(ownerOf(fleet, motors), QString("rover"));
        while (!fleet.robots().empty())
            QVERIFY(fleet.remove(fleet.robots().front().get()));
        QVERIFY(!fleet.robot());
        QVERIFY(fleet.addresses().isEmpty());
    }

    void removedWhileAnotherNamesItsDaemon() {
        const FakeDaemon motors(plain());
        const FakeDaemon one(supervisor("one", {motors.port()})), other(supervisor("other", {motors.port()}));
        Fleet fleet;
        QVERIFY(fleet.add(addressOf(one)));
        QTRY_COMPARE(ownerOf(fleet, motors), QString("one"));
        QVERIFY(fleet.add(addressOf(other)));
        QTRY_VERIFY(fleet.robotAt(addressOf(other)) && !fleet.robotAt(addressOf(other))->problem().isEmpty());
        QVERIFY(fleet.remove(fleet.robotAt(addressOf(one))));
        QCOMPARE(ownerOf(fleet, motors), QString("other"));
        QTRY_VERIFY(fleet.robot()->withMethod("motor.drive"));
    }

    void removedFromAHostThatWasSearched() {
        const FakeDaemon other(supervisor("other", {}));
        Fleet fleet;
        QVERIFY(fleet.add("127.0.0.1"));
        QVERIFY(fleet.add(addressOf(other)));
        QTRY_COMPARE(ownerOf(fleet, other), QString("other"));
        const auto back = fleet.remove(fleet.robotAt(addressOf(other)));
        QVERIFY(back && back->contains("127.0.0.1")); // where it may have been found
        QVERIFY(!fleet.addresses().contains("127.0.0.1"));
        for (const QString &address : *back)
            QVERIFY(fleet.add(address));
        QVERIFY(fleet.addresses().contains("127.0.0.1"));
    }

private:
    static QString addressOf(const FakeDaemon &daemon) { return QString("127.0.0.1:%1").arg(daemon.port()); }
    static Mischief plain() {
        Mischief daemon;
        daemon.hasTopics = false;
        daemon.isMotors = true;
        return daemon;
    }
    static QByteArray list(const QByteArray &robot, const QVector<int> &ports) {
        QByteArray processes;
        for (const int port : ports) {
            processes += processes.isEmpty() ? "" : ",";
            processes += R"({"name":"p","state":"running","pid":7,"restarts":0,"port":)" +
                         QByteArray::number(port) + '}';
        }
        return "{\"robot\":\"" + robot + "\",\"processes\":[" + processes + "]}";
    }
    static Mischief supervisor(const QByteArray &robot, const QVector<int> &ports) {
        Mischief daemon;
        daemon.topics["processes"] = list(robot, ports);
        return daemon;
    }
    static QStringList namesOf(const Fleet &fleet) {
        QStringList names;
        for (const auto &robot : fleet.robots())
            names.append(robot->name());
        names.sort();
        return names;
    }
    /// The name of the robot that has the daemon; empty: none.
    static QString ownerOf(const Fleet &fleet, const FakeDaemon &daemon) {
        for (const auto &robot : fleet.robots())
            for (const DaemonLink *link : robot->daemons())
                if (link->address() == addressOf(daemon))
                    return robot->name();
        return {};
    }
};
