#include "gui/desktop/model/Fleet.h"
#include "tests/gui/desktop/FakeDaemon.h"

using namespace hermes;
using namespace hermes::desktop;

/// Which daemon belongs to which robot, and which robot is the chosen one.
class TestFleet : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void robotsTellWhoTheyAre() {
        const FakeDaemon red(of(1)), sameHost(of(1)), blue(of(2)), plainOne(plain());
        Fleet fleet;
        QVERIFY(add(fleet, {&red, &sameHost, &blue, &plainOne}));
        QVERIFY(fleet.add(red.address("127.0.0.2")));
        QTRY_VERIFY(fleet.robotAt(red.address("127.0.0.2")) && fleet.robotAt(blue.address()));
        QTRY_COMPARE(int(fleet.robotAt(idOf(1))->daemons().size()), 3); // on two hosts
        QCOMPARE(fleet.robotAt(red.address("127.0.0.2")), fleet.robotAt(idOf(1)));
        QCOMPARE(fleet.robotAt(sameHost.address()), fleet.robotAt(idOf(1)));
        QCOMPARE(fleet.robotAt(idOf(1))->address(), QString("127.0.0.1, 127.0.0.2"));
        QCOMPARE(fleet.robotAt(blue.address()), fleet.robotAt(idOf(2)));
        QTRY_COMPARE(ownerOf(fleet, plainOne), QString("127.0.0.1")); // no robot of its host has a supervisor
        QCOMPARE(int(fleet.robots().size()), 3);
        for (const auto &robot : fleet.robots())
            for (DaemonLink *daemon : robot->daemons())
                QVERIFY(robot->has(daemon) && fleet.robotOf(daemon) == robot.get());
    }

    // Each with its supervisor; what runs there is told by that of its host.
    void aRobotOfTwoComputers() {
        FakeDaemon near(of(1, supervisor("rover", {}))), far(of(1, supervisor("rover", {}))), motors(of(1));
        const auto hasIts = [&](const FakeDaemon &supervisor, const QString &motorsAddress, Fleet &fleet) {
            const DaemonLink *const link = fleet.daemonAt(motorsAddress);
            return link && fleet.robots().front()->process(*link) &&
                   fleet.robots().front()->supervisorOf(*link)->port() == supervisor.port();
        };
        Fleet fleet;
        QVERIFY(fleet.add(near.address()));
        QVERIFY(fleet.add(far.address("127.0.0.2")));
        QTRY_COMPARE(namesOf(fleet), QStringList("rover"));
        QTRY_VERIFY(near.subscriptions("processes") == 1 && far.subscriptions("processes") == 1);
        near.say("processes", list("rover", {motors.port()}));
        QTRY_VERIFY(hasIts(near, motors.address(), fleet));
        QVERIFY(!fleet.daemonAt(motors.address("127.0.0.2")));
        far.say("processes", list("rover", {motors.port()}));
        QTRY_VERIFY(hasIts(far, motors.address("127.0.0.2"), fleet));
        QVERIFY(hasIts(near, motors.address(), fleet));
        QTRY_COMPARE(fleet.robot()->problem(), QString("2 of its daemons can be driven, of which one is"));
        QVERIFY(fleet.remove(fleet.robot()));
        QVERIFY(fleet.robots().empty() && fleet.addresses().isEmpty());
    }

    void whatIsNoIdIsNone_data() {
        const Rows<QByteArray> row("robot");
        row("text", R"({"id":"127.0.0.1","name":"x"})");
        row("empty", R"({"id":"","name":"x"})");
        row("long", R"({"id":")" + QByteArray(100000, '1') + R"(","name":"x"})");
        row("nil", R"({"id":"00000000-0000-0000-0000-000000000000","name":"x"})");
        row("in braces", R"({"id":"{11111111-2222-4333-8444-555555555555}","name":"x"})");
    }
    void whatIsNoIdIsNone() {
        QFETCH(QByteArray, robot);
        Mischief odd = plain();
        odd.results["daemon.info"] = R"({"name":"odd","description_hash":"1","robot":)" + robot + '}';
        const FakeDaemon daemon(odd);
        Fleet fleet;
        QVERIFY(fleet.add(daemon.address()));
        QTRY_VERIFY(fleet.robotAt(daemon.address()));
        QCOMPARE(fleet.robotAt(daemon.address())->id(), QString("127.0.0.1"));
    }

    void toldAnotherRobotThanBefore() {
        FakeDaemon daemon(of(1));
        Fleet fleet;
        QVERIFY(fleet.add(daemon.address()));
        QTRY_COMPARE(fleet.robotAt(daemon.address()), fleet.robotAt(idOf(1)));
        QVERIFY(fleet.robot());
        QSignalSpy moved(&fleet, &Fleet::moved);
        daemon.setResult("daemon.info", R"({"name":"fake","description_hash":"1","robot":{"id":")" +
                                            idOf(2).toUtf8() + R"(","name":"\u001bb"}})");
        daemon.dropAll();
        QTRY_COMPARE(namesOf(fleet), QStringList("b"));
        QCOMPARE(fleet.robot(), fleet.robotAt(idOf(2)));
        QCOMPARE(moved.count(), 1);
    }

    void whatASupervisorNamesIsItsRobot() {
        const FakeDaemon motors(plain()), stranger(plain());
        Fleet fleet;
        QVERIFY(add(fleet, {&motors, &stranger}));
        QCOMPARE(namesOf(fleet), QStringList("127.0.0.1"));
        DaemonLink *const link = fleet.robots().front()->daemons().front();
        const FakeDaemon rover(supervisor("rover", {motors.port()}));
        QSignalSpy moved(&fleet, &Fleet::moved);
        QVERIFY(fleet.add(rover.address())); // second
        QTRY_COMPARE(ownerOf(fleet, motors), QString("rover"));
        QCOMPARE(ownerOf(fleet, rover), QString("rover"));
        QTRY_COMPARE(ownerOf(fleet, stranger), QString("rover")); // the only one there
        QCOMPARE(namesOf(fleet), QStringList("rover"));
        QVERIFY(fleet.robotAt(rover.address())->has(link));
        QCOMPARE(moved.count(), 3);
        const FakeDaemon other(supervisor("other", {}));
        QVERIFY(fleet.add(other.address()));
        QTRY_COMPARE(ownerOf(fleet, stranger), QString("127.0.0.1")); // of which one nobody knows
        QCOMPARE(ownerOf(fleet, motors), QString("rover"));
    }

    void twoSupervisorsOfOneHostAreTwo() {
        const FakeDaemon first(plain()), second(plain());
        const FakeDaemon one(supervisor("one", {first.port()})), other(supervisor("other", {second.port()}));
        Fleet fleet;
        QVERIFY(add(fleet, {&one, &other}));
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
        QVERIFY(fleet.add(one.address()));
        QTRY_COMPARE(ownerOf(fleet, motors), QString("one"));
        QVERIFY(fleet.add(other.address()));
        QTRY_VERIFY(fleet.robotAt(other.address()));
        QTRY_COMPARE(int(fleet.robotAt(other.address())->named().size()), 1);
        QCOMPARE(ownerOf(fleet, motors), QString("one"));
        one.say("processes", list("one", {}));
        QTRY_COMPARE(ownerOf(fleet, motors), QString("other"));
    }

    // Its own, the other supervisor's, none, one twice, and a thousand.
    void namesPortsOfAllKinds() {
        FakeDaemon one(supervisor("one", {}));
        const FakeDaemon other(supervisor("other", {}));
        Fleet fleet;
        QVERIFY(add(fleet, {&one, &other}));
        QTRY_COMPARE(namesOf(fleet), QStringList({"one", "other"}));
        QTRY_COMPARE(one.subscriptions("processes"), 1);
        QVector<int> ports{one.port(), other.port(), other.port(), 0};
        one.say("processes", list("one", ports));
        const Robot &robot = *fleet.robotAt(one.address());
        QTRY_COMPARE(int(robot.named().size()), 1);
        QCOMPARE(ownerOf(fleet, other), QString("other"));
        for (int port = 20000; port < 21000; ++port)
            ports.append(port);
        one.say("processes", list("one", ports));
        QTRY_VERIFY(robot.problem().startsWith("904 more processes"));
        QCOMPARE(int(robot.daemons().size()), 97); // and itself
        QCOMPARE(int(fleet.robotAt(other.address())->daemons().size()), 1);
    }

    void namedNoMore() {
        FakeDaemon known(plain()), unknown(plain()),
            rover(supervisor("rover", {known.port(), unknown.port(), 9}));
        const FakeDaemon other(supervisor("other", {}));
        Fleet fleet;
        QVERIFY(add(fleet, {&known, &other, &rover}));
        QTRY_VERIFY(fleet.robotAt(other.address()));
        QTRY_COMPARE(ownerOf(fleet, unknown), QString("rover"));
        QTRY_COMPARE(int(fleet.robotAt(rover.address())->allWithMethod("motor.drive").size()), 2);
        rover.say("processes", list("rover", {}));
        QTRY_COMPARE(ownerOf(fleet, known), QString("127.0.0.1"));
        QCOMPARE(ownerOf(fleet, unknown), QString("127.0.0.1")); // it is there
        QCOMPARE(int(fleet.robotAt("127.0.0.1")->daemons().size()), 2);
        rover.say("processes", list("rover", {known.port(), unknown.port()}));
        QTRY_COMPARE(namesOf(fleet), QStringList({"other", "rover"}));
    }

    void whatIsChosenStaysChosen() {
        FakeDaemon motors(plain()), stranger(plain()), rover(supervisor("rover", {}));
        const FakeDaemon other(supervisor("other", {}));
        Fleet fleet;
        QVERIFY(add(fleet, {&motors, &stranger, &rover, &other}));
        QTRY_COMPARE(namesOf(fleet), QStringList({"127.0.0.1", "other", "rover"}));
        QTRY_COMPARE(int(fleet.robotAt("127.0.0.1")->allWithMethod("motor.drive").size()), 2);
        QTRY_COMPARE(rover.subscriptions("processes"), 1);
        Robot *const host = fleet.robotAt("127.0.0.1");
        DaemonLink *const chosen = fleet.daemonAt(motors.address());
        fleet.choose(chosen);
        QSignalSpy daemonChosen(&fleet, &Fleet::daemonChosen), robotChosen(&fleet, &Fleet::robotChosen);
        rover.say("processes", list("rover", {motors.port()}));
        QTRY_COMPARE(ownerOf(fleet, motors), QString("rover"));
        QCOMPARE(fleet.robot(), host);
        QCOMPARE(robotChosen.count(), 0);
        QVERIFY(!fleet.daemon()); // the panels show none of another robot
        QCOMPARE(daemonChosen.count(), 1);
        fleet.choose(chosen);
        QCOMPARE(fleet.robot()->name(), QString("rover"));
        fleet.choose(host);
        QVERIFY(!fleet.daemon());
        fleet.choose(fleet.robotAt(rover.address()));
        QVERIFY(fleet.daemon() == chosen); // as it was when that robot was chosen last
        fleet.choose(host);
        rover.say("processes", list("rover", {}));
        QTRY_COMPARE(ownerOf(fleet, motors), QString("127.0.0.1"));
        fleet.choose(fleet.robotAt(rover.address()));
        QVERIFY(!fleet.daemon()); // which is another robot's now
        fleet.choose(host);
        rover.say("processes", list("rover", {motors.port(), stranger.port()}));
        QTRY_COMPARE(int(fleet.robots().size()), 2); // nobody is left there
        QCOMPARE(fleet.robot()->name(), QString("rover"));
    }

    void theRobotOfLastTimeIsChosen() {
        const FakeDaemon one(supervisor("one", {})), other(supervisor("other", {}));
        QString last = other.address(); // as it was kept before robots had ids
        for (const bool isMeant : {false, false, true}) {
            Fleet fleet;
            fleet.prefer(last);
            QVERIFY(fleet.add(one.address()));
            QTRY_VERIFY(fleet.robotAt(one.address()));
            if (isMeant)
                fleet.keepChoice(); // somebody drives it
            QVERIFY(fleet.add(other.address()));
            QTRY_VERIFY(fleet.robotAt(other.address()));
            QCOMPARE(fleet.robot(), fleet.robotAt((isMeant ? one : other).address()));
            last = fleet.preferred();
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
        QVERIFY(fleet.add(daemon.address()));
        QVERIFY(fleet.add(QString("localhost:%1").arg(daemon.port())));
        QVERIFY(fleet.add("localhost"));
        QVERIFY(fleet.add("127.0.0.1"));
        QCOMPARE(fleet.addresses(), QStringList({daemon.address(), "127.0.0.1"}));
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
        QVERIFY(fleet.add(one.address()));
        QTRY_VERIFY(fleet.robotAt(one.address()));
        QVERIFY(fleet.add(other.address()));
        QTRY_VERIFY(fleet.robotAt(other.address()));
        const auto problems = [&] {
            return fleet.robotAt(one.address())->problem() + fleet.robotAt(other.address())->problem();
        };
        QTRY_COMPARE(problems().count(" of the robot rover, by another address"), 2); // it is one robot
    }

    void robotsOfOneNameAreToldApart() {
        const FakeDaemon one(supervisor("rover", {})), other(supervisor("rover", {}));
        Fleet fleet;
        QVERIFY(fleet.add(one.address()));
        QTRY_VERIFY(fleet.robotAt(one.address()) && fleet.robot()->name() == "rover");
        QCOMPARE(fleet.titleOf(*fleet.robot()), QString("rover"));
        QVERIFY(fleet.add(other.address()));
        QTRY_COMPARE(namesOf(fleet), QStringList({"rover", "rover"}));
        for (const auto &robot : fleet.robots())
            QCOMPARE(fleet.titleOf(*robot), QString("rover (%1)").arg(robot->address()));
    }

    void givenNames() {
        const FakeDaemon one(supervisor("rover", {}));
        Fleet fleet;
        QVERIFY(fleet.add(one.address()));
        QTRY_VERIFY(fleet.robotAt(one.address()));
        fleet.setNames({{fleet.robot()->id(), "Red"}});
        QTRY_COMPARE(namesOf(fleet), QStringList("Red"));
        fleet.rename(*fleet.robot(), "  " + QString(10000, 'x'));
        QVERIFY(fleet.robot()->name().size() < 40);
        fleet.rename(*fleet.robot(), " ");
        QTRY_COMPARE(namesOf(fleet), QStringList("rover"));
        QVERIFY(fleet.names().isEmpty());
    }

    void removedAndBroughtBack() {
        const FakeDaemon motors(plain()), stranger(plain()), rover(supervisor("rover", {motors.port()}));
        Fleet fleet;
        for (const QString &address : {motors.address(), stranger.address("127.0.0.2"), rover.address()})
            QVERIFY(fleet.add(address));
        QTRY_COMPARE(ownerOf(fleet, motors), QString("rover"));
        fleet.choose(fleet.robotAt(rover.address()));
        fleet.setObjection([](const Robot &robot) { return robot.name() + " is busy"; });
        QCOMPARE(fleet.remove(fleet.robot()).error().message, QString("rover is busy"));
        fleet.setObjection({});
        QPointer<DaemonLink> link = fleet.robot()->daemons().front();
        const auto back = fleet.remove(fleet.robot());
        QVERIFY(back);
        QCOMPARE(namesOf(fleet), QStringList("127.0.0.2"));
        QCOMPARE(fleet.robot()->name(), QString("127.0.0.2"));
        QCOMPARE(fleet.addresses(), QStringList(stranger.address("127.0.0.2")));
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
        QVERIFY(fleet.add(one.address()));
        QTRY_COMPARE(ownerOf(fleet, motors), QString("one"));
        QVERIFY(fleet.add(other.address()));
        QTRY_VERIFY(fleet.robotAt(other.address()) && !fleet.robotAt(other.address())->named().empty());
        QVERIFY(fleet.remove(fleet.robotAt(one.address())));
        QCOMPARE(ownerOf(fleet, motors), QString("other"));
        QTRY_VERIFY(fleet.robot()->withMethod("motor.drive"));
    }

    void removedFromAHostThatWasSearched() {
        const FakeDaemon other(supervisor("other", {}));
        Fleet fleet;
        QVERIFY(fleet.add("127.0.0.1"));
        QVERIFY(fleet.add(other.address()));
        QTRY_COMPARE(ownerOf(fleet, other), QString("other"));
        const auto back = fleet.remove(fleet.robotAt(other.address()));
        QVERIFY(back && back->contains("127.0.0.1")); // where it may have been found
        QVERIFY(!fleet.addresses().contains("127.0.0.1"));
        for (const QString &address : *back)
            QVERIFY(fleet.add(address));
        QVERIFY(fleet.addresses().contains("127.0.0.1"));
    }

private:
    static bool add(Fleet &fleet, std::initializer_list<const FakeDaemon *> daemons) {
        return std::all_of(daemons.begin(), daemons.end(),
                           [&](const FakeDaemon *one) { return fleet.add(one->address()).ok(); });
    }
    static QString idOf(int robot) { return QString("11111111-2222-4333-8444-55555555555%1").arg(robot); }
    /// That daemon, where it tells this robot.
    static Mischief of(int robot, Mischief daemon = plain()) {
        daemon.robotId = idOf(robot).toUtf8();
        return daemon;
    }
    static Mischief plain() {
        Mischief daemon;
        daemon.isEverywhere = true;
        daemon.hasTopics = false;
        daemon.isMotors = true;
        return daemon;
    }
    static QByteArray list(const QByteArray &robot, const QVector<int> &ports) {
        QStringList processes;
        for (const int port : ports)
            processes
                << QString(R"({"name":"p","state":"running","pid":7,"restarts":0,"port":%1})").arg(port);
        return "{\"robot\":\"" + robot + "\",\"processes\":[" + processes.join(',').toUtf8() + "]}";
    }
    static Mischief supervisor(const QByteArray &robot, const QVector<int> &ports) {
        Mischief daemon;
        daemon.isEverywhere = true;
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
                if (link->address() == daemon.address())
                    return robot->name();
        return {};
    }
};
