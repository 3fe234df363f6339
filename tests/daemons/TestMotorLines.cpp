#include "common/Time.h"
#include "common/interface/SerialInterface.h"
#include "daemons/simulator/DeviceLines.h"
#include "daemons/simulator/Simulation.h"
#include "protocol/drive/Bus.h"
#include "protocol/roboclaw/Packet.h"

#include <cerrno>

using namespace hermes;
using namespace hermes::simulator;
using namespace hermes::roboclaw;
using drive::Bus;

/// The host's and the device's end of a serial line, with true bytes between them.
struct Robot {
    QTemporaryDir folder;
    Drivetrain drivetrain;
    MotorLines lines{[this](int line, const QByteArray &bytes, double now) {
        return drivetrain.receive(line, reinterpret_cast<const std::uint8_t *>(bytes.constData()),
                                  std::size_t(bytes.size()), now);
    }};
    Bus bus;
    ReplyParser parser;
    std::unique_ptr<SerialInterface> serial;
    QTimer timer;

    /// Opens both ends; false when one fails.
    bool connectEnds() {
        const QString device = folder.filePath("motors");
        if (!lines.open({device}))
            return false;
        serial = std::make_unique<SerialInterface>(*InterfaceUrl::parse("serial://" + device), nullptr);
        serial->setReconnecting(true);
        QObject::connect(serial.get(), &Interface::opened, [this] { bus.setOpen(true); });
        QObject::connect(serial.get(), &Interface::closed, [this] { bus.setOpen(false); });
        QObject::connect(serial.get(), &Interface::received, [this](const QByteArray &bytes) {
            bus.feed(reinterpret_cast<const std::uint8_t *>(bytes.constData()), std::size_t(bytes.size()),
                     monotonicNow());
            pump();
        });
        timer.setTimerType(Qt::PreciseTimer);
        QObject::connect(&timer, &QTimer::timeout, [this] { pump(); });
        timer.start(1);
        serial->open();
        return serial->isOpen();
    }
    void pump() {
        while (const Bytes *bytes = bus.poll(monotonicNow()))
            serial->write(QByteArray(reinterpret_cast<const char *>(bytes->data()), int(bytes->size())));
    }
    Bus::Outcome ask(std::uint8_t address, Command command, const Values &values = {}) {
        Bus::Outcome result;
        bool ended = false;
        bus.submit({&parser, Request::make(address, command, values)->bytes, address},
                   [&](const Bus::Outcome &outcome) {
                       result = outcome;
                       ended = true;
                   });
        pump();
        while (!ended)
            QCoreApplication::processEvents(QEventLoop::WaitForMoreEvents);
        return result;
    }
};

static World room() {
    return {
        "room", {{-5, -5, 5, -5}, {5, -5, 5, 5}, {5, 5, -5, 5}, {-5, 5, -5, -5}}, {{0, 0, 0}, {2, 0, 0}}, {}};
}

/// Drives all wheels of a simulation with this speed, counts/s, as a host does.
static void driveWheels(Simulation &simulation, const std::array<std::int64_t, 4> &speeds,
                        std::int64_t acceleration) {
    static double now = 0;
    const auto send = [&](std::uint8_t address, Command command, const Values &values) {
        const auto request = Request::make(address, command, values);
        now += 1;
        QCOMPARE(simulation.drivetrain().receive(0, request->bytes.data(), request->bytes.size(), now).size(),
                 std::size_t(1));
    };
    for (const std::uint8_t address : {0x80, 0x81}) {
        for (const Command command : {Command::SetVelocityPidM1, Command::SetVelocityPidM2})
            send(address, command, {0x4000, 0x10000, 0x8000, 150000});
    }
    send(0x80, Command::SpeedAccel, {acceleration, speeds[0], speeds[1]});
    send(0x81, Command::SpeedAccel, {acceleration, speeds[2], speeds[3]});
}

static void pass(Simulation &simulation, double seconds) {
    const auto end = simulation.now_ns() + std::int64_t(seconds * 1e9);
    while (simulation.now_ns() < end)
        simulation.nextPacket();
}

class TestMotorLines : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void answersOnThePseudoTerminal() {
        Robot robot;
        QVERIFY(robot.connectEnds());
        const auto version = robot.ask(0x80, Command::ReadVersion);
        QCOMPARE(version.result, Bus::Result::Done);
        QCOMPARE(QByteArray(robot.parser.reply().text.data()), QByteArray("RoboClaw 2x45A v4.2.8"));
        std::vector<double> waits;
        for (int i = 0; i < 200; ++i) {
            const std::uint8_t address = i % 2 ? 0x80 : 0x81;
            const auto done = robot.ask(address, i % 4 < 2 ? Command::Speed : Command::ReadEncoders,
                                        i % 4 < 2 ? Values{100, 100} : Values{});
            QCOMPARE(done.result, Bus::Result::Done);
            waits.push_back(done.received - done.sent);
        }
        std::sort(waits.begin(), waits.end());
        QVERIFY2(waits[100] < 0.01, saying(waits[100]));
        QCOMPARE(robot.ask(0x82, Command::ReadEncoders).result, Bus::Result::TimedOut);
    }

    void slowAnswersAreRepeated() {
        Robot robot;
        QVERIFY(robot.connectEnds());
        robot.drivetrain.controller(0).faults().delay = 0.2;
        QCOMPARE(robot.ask(0x80, Command::ReadMainBattery).result, Bus::Result::TimedOut);
        robot.drivetrain.controller(0).faults().delay = 0;
        QTRY_COMPARE(int(robot.bus.strayBytes()), 3 * 4); // the late answers come, and are nobody's
        QCOMPARE(robot.ask(0x80, Command::ReadMainBattery).result, Bus::Result::Done);
    }

    void damagedAnswersAreRepeated() {
        Robot robot;
        QVERIFY(robot.connectEnds());
        robot.drivetrain.controller(0).faults().corrupt = 0.2;
        int done = 0;
        for (int i = 0; i < 50; ++i)
            done += robot.ask(0x80, Command::ReadEncoders).result == Bus::Result::Done;
        QVERIFY(done >= 45); // each has three attempts
        QVERIFY(robot.bus.counts(0x80).crcErrors > 0 && robot.bus.counts(0x80).retries > 0);
    }

    void pulledLineIsFoundAgain() {
        Robot robot;
        QVERIFY(robot.connectEnds());
        QCOMPARE(robot.ask(0x80, Command::SetEncoderM1, {1234}).result, Bus::Result::Done);
        robot.lines.setPulled(0, true);
        QCOMPARE(robot.ask(0x80, Command::ReadEncoders).result, Bus::Result::LineClosed);
        QVERIFY(robot.lines.state()[0].device.isEmpty());
        robot.lines.setPulled(0, false);
        QTRY_VERIFY(robot.serial->isOpen());
        const auto counts = robot.ask(0x80, Command::ReadEncoders);
        QCOMPARE(counts.result, Bus::Result::Done);
        QCOMPARE(robot.parser.reply()[0], std::int64_t(1234));
    }

    void motorsAtAnotherSpeedHearAndAnswerGarbage() {
        QByteArray came, heard;
        MotorLines lines([&](int, const QByteArray &bytes, double) {
            came += bytes;
            roboclaw::Bytes answer;
            for (int i = 0; i < bytes.size(); ++i)
                answer.push('a');
            return std::vector<RoboClawEmulator::Answer>{{answer, 0}};
        });
        QVERIFY(lines.open({""}, 57600).ok());
        for (const int turn : {0, 1, 2, 3}) {
            const int baud = turn == 1 ? 115200 : 57600;
            lines.setPulled(0, turn == 3);
            lines.setPulled(0, false); // which changes nothing unless it was pulled
            SerialInterface near(
                *InterfaceUrl::parse(QString("serial://%1?baud=%2").arg(lines.state()[0].device).arg(baud)),
                nullptr);
            QObject::connect(&near, &Interface::received, [&](const QByteArray &bytes) { heard += bytes; });
            near.open();
            lines.setPulled(0, false);
            came.clear();
            heard.clear();
            near.write("m 10 10\r");
            QTRY_COMPARE(heard.size(), 8);
            QCOMPARE(came == "m 10 10\r", baud == 57600);
            QCOMPARE(heard == "aaaaaaaa", baud == 57600);
        }
    }

    void badLinkIsNamed() {
        Robot robot;
        const auto opened = robot.lines.open({"/proc/none/motors"});
        QVERIFY(!opened);
        VERIFY_CONTAINS(opened.error().message, "/proc/none");
        QCOMPARE(robot.lines.count(), 0);
    }

    void sentencesThatNobodyReadsAreLost() {
        SensorLine line;
        QVERIFY(line.open("").ok());
        QFile near(line.state().line.device);
        QVERIFY(near.open(QIODevice::ReadOnly | QIODevice::Unbuffered));
        const auto unread = [&near] {
            int size = 0;
            return ::ioctl(near.handle(), FIONREAD, &size) == 0 ? size : -1;
        };
        int left = 0;
        for (int i = 0; i < 30; ++i) { // each arrives before the next is sent
            line.send(QByteArray::number(i).rightJustified(98, '.') + "\r\n");
            left = left > 2048 ? 100 : left + 100;
            QTRY_COMPARE_WITH_TIMEOUT(unread(), left, 2000);
        }
        QByteArray latest(8192, '\0'); // QFile would wait for all of it
        latest.resize(int(::read(near.handle(), latest.data(), std::size_t(latest.size()))));
        QVERIFY(latest.size() == left && latest.endsWith("29\r\n"));
        QCOMPARE(line.state().bytes, qint64(3000));
        QCOMPARE(line.state().unreadLost, qint64(3000 - left));
    }

    void otherSpeedMakesGarbage_data() { rowsOf("speed", {"115200", "256000"}); }

    void otherSpeedMakesGarbage() {
        QFETCH(QString, speed);
        const int baud = speed.toInt();
        QByteArray came, heard;
        SensorLine line;
        QVERIFY(line.open("", baud, 0.3, [&](const QByteArray &bytes) { came += bytes; }).ok());
        const QString device = "serial://" + line.state().line.device;
        for (const int wanted : {baud, 9600, baud}) {
            SerialInterface near(*InterfaceUrl::parse(QString("%1?baud=%2").arg(device).arg(wanted)),
                                 nullptr);
            QObject::connect(&near, &Interface::received, [&](const QByteArray &bytes) { heard += bytes; });
            near.open();
            QVERIFY(near.isOpen());
            heard.clear();
            const QByteArray text = "at " + QByteArray::number(wanted);
            line.send(text);
            near.write(text);
            QTRY_COMPARE(heard.size(), text.size());
            QCOMPARE(heard == text, wanted == baud);
            if (wanted == baud)
                QTRY_VERIFY(came.endsWith(text));
            else // what is on its way yet comes when the speed fits again
                QVERIFY(!came.contains(text));
        }
    }

    void programMayBeBehindForAWhile() {
        SensorLine line;
        QVERIFY(line.open("", 0, 0.2, [](const QByteArray &) {}).ok());
        QElapsedTimer timer;
        timer.start();
        for (int i = 0; i < 30; ++i)
            line.send(QByteArray(100, 'x'));
        QCOMPARE(line.state().unreadLost, qint64(0));
        QTRY_VERIFY((line.send("x"), line.state().unreadLost >= 3000));
        QVERIFY(timer.elapsed() >= 200);
        QVERIFY(line.state().bytes > line.state().unreadLost);
    }

    void claimOfAKilledProgramIsDropped() {
        SensorLine line;
        QVERIFY(line.open("").ok());
        const QByteArray device = line.state().line.device.toLocal8Bit();
        const int claimed = ::open(device.constData(), O_RDWR | O_NOCTTY | O_CLOEXEC);
        QVERIFY(claimed >= 0 && ::ioctl(claimed, TIOCEXCL) == 0);
        ::close(claimed);
        line.send("$GPRMC*4B\r\n");
        int exclusive = 1;
        const int again = ::open(device.constData(), O_RDWR | O_NOCTTY | O_CLOEXEC);
        QVERIFY(again >= 0);
        const int told = ::ioctl(again, TIOCGEXCL, &exclusive), reason = told == 0 ? 0 : errno;
        ::close(again);
        if (reason == ENOTTY)
            QSKIP("whether a line is claimed is not told here (TIOCGEXCL): QEMU does not know it");
        QCOMPARE(reason, 0);
        QCOMPARE(exclusive, 0);
    }

    void wheelsDriveTheSimulation() {
        Simulation simulation(room(), {}, 0);
        const std::int64_t speed = 30240; // 0.5 m/s
        driveWheels(simulation, {-speed, speed, speed, -speed}, 120000);
        pass(simulation, 2);
        const auto truth = simulation.truth();
        QVERIFY2(std::abs(truth.pose.y - 0.9375) < 0.03, saying(truth.pose.y));
        QVERIFY(std::abs(truth.pose.x) < 0.01 && std::abs(truth.pose.theta) < 0.01);
        QVERIFY(std::abs(truth.twist.vy - 0.5) < 0.01 && simulation.isPlaced());
        driveWheels(simulation, {0, 0, 0, 0}, 240000);
        pass(simulation, 1);
        const auto standing = simulation.truth();
        pass(simulation, 1);
        QCOMPARE(simulation.truth().pose.y, standing.pose.y);
        // What the wheels' encoders counted is the way that the robot made.
        const double way = double(simulation.drivetrain().wheel(1).count()) / 38000 * 2 * M_PI * 0.1;
        QVERIFY2(std::abs(standing.pose.y - way) < 0.001, saying("%1 %2", standing.pose.y, way));
    }

    void followingIgnoresTheWheels() {
        Simulation simulation(room(), {}, 0);
        QVERIFY(simulation.drive());
        driveWheels(simulation, {30000, 30000, 30000, 30000}, 120000);
        pass(simulation, 1);
        QVERIFY(!simulation.isPlaced());
        driveWheels(simulation, {0, 0, 0, 0}, 240000);
        pass(simulation, 5);
        QVERIFY(simulation.truth().finished);
        QCOMPARE(simulation.truth().pose.x, 2.0);
        driveWheels(simulation, {-30000, -30000, -30000, -30000}, 120000);
        pass(simulation, 1);
        QVERIFY(simulation.isPlaced() && simulation.truth().pose.x < 1.8); // on from where it was
    }

    void wallStopsTheSimulation() {
        Simulation simulation(room(), {}, 0);
        simulation.place({4.5, 0, 0});
        driveWheels(simulation, {30000, 30000, 30000, 30000}, 120000);
        pass(simulation, 2);
        const auto truth = simulation.truth();
        QVERIFY2(std::abs(truth.pose.x - 4.7) < 1e-6, qPrintable(QString::number(truth.pose.x, 'g', 10)));
        QVERIFY(truth.touching);
        QVERIFY(simulation.drivetrain().wheel(0).count() > 40000); // the wheels slip
    }
};
