// A base of two wheels with an Arduino that speaks the text protocol, on a clock of its own: what is sent to
// it, what stops it when it restarts, is not heard or loses bytes, and that no time is promised that it
// cannot keep.
#include "ArduinoBench.h"
#include "daemons/motorcontrol/MotorMessages.h"
#include "protocol/drive/ArduinoDevice.h"

using namespace hermes;
using namespace hermes::motorcontrol;
using Base = ArduinoBench;

class TestArduinoBase : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void drivesTwoWheels() {
        Base base;
        QVERIFY2(base.driveOff(), qPrintable(base.engine.controller(0).error()));
        QVERIFY(base.arduino.speeds[0] > 0 &&
                base.arduino.speeds[1] < 0); // one is mounted the other way round
        // 0.2 m/s: 2894 counts/s, 96.5 in a thirtieth
        base.run(1);
        QVERIFY2(base.sent.back().text == "e\r" || base.sent.back().text == "m 96 -96\r",
                 base.sent.back().text.c_str());
        const Telemetry &told = base.engine.report();
        QVERIFY2(std::abs(told.twist.vx - 0.2) < 0.005, saying(told.twist.vx));
        QCOMPARE(told.controllers.size(), std::size_t(1));
        QCOMPARE(told.controllers[0].timeout_s.value_or(0), 2.0);
        QVERIFY(told.controllers[0].coasts);
        QVERIFY(told.pose.x > 0.2 && std::abs(told.pose.theta) < 0.01);
        base.speed = 0;
        QVERIFY(base.runUntil([&] { return base.arduino.fastest() == 0; }, 0.6));
        base.run(0.5);
        QVERIFY(base.engine.controller(0).stands());
        QVERIFY2(!told.latch.isSet(), qPrintable(told.latch.text())); // no battery, no fault
        QCOMPARE(base.engine.controller(0).readings().setups, 1);
        QVERIFY(!powerOf(told, {}).controllers[0].ready);
        QCOMPARE(int(base.line.counts(base.engine.controller(0)).unexpected), 0);
    }

    void promisesNoTimeThatItCannotKeep() {
        MotorSettings settings = *settingsOf(arduinoSettings());
        settings.serialTimeout_s = 0.2;
        Base base(settings);
        base.run(5);
        QVERIFY(!base.isReady());
        VERIFY_CONTAINS(base.engine.controller(0).error(), QString("controllers.timeout_s promises 0.2 s"));
        for (int i = 0; i < 100; ++i) { // it stands all the time, and that is known
            base.run(0.01);
            QVERIFY(base.engine.controller(0).stands());
        }
        base.passes = [](const std::string &) { return std::string(); };
        QVERIFY(base.runUntil([&] { return !base.engine.controller(0).stands(); }, 0.3)); // nor is it heard
        base.passes = [](const std::string &text) { return text; };
        QVERIFY(base.runUntil([&] { return base.engine.controller(0).stands(); }, 5));
        for (const auto &packet : base.sent)
            QVERIFY(Base::isStop(packet) || packet.text.find('m') == std::string::npos);
        settings.serialTimeout_s = 2;
        base.engine.configure(settings);
        QVERIFY(base.driveOff());
        settings.serialTimeout_s = 0.5;
        base.engine.configure(settings);
        QVERIFY(base.runUntil([&] { return base.arduino.fastest() == 0; }, 1));
        base.run(3);
        QVERIFY(!base.isReady() && base.arduino.fastest() == 0);
        QCOMPARE(base.engine.report().twist.vx, 0.0); // not what it was when it was read last
    }

    void theWayWithoutThisProgramIsTold() {
        const MotorSettings settings = *settingsOf(arduinoSettings());
        Base base(settings);
        QVERIFY(base.driveOff(0.3));
        base.run(0.5);
        const double before = base.arduino.counts[0];
        base.die(3);
        QCOMPARE(base.arduino.fastest(), 0.0);
        const double way = (base.arduino.counts[0] - before) / 3000 * 2 * 3.14159 * 0.033;
        QVERIFY2(way > 0.55 && way < settings.longestWay_m(2), saying(way));
    }

    void aPulledLineLosesNoWay() {
        Base base;
        QVERIFY(base.driveOff(0.3));
        base.line.setClosed("pulled");
        base.die(3);
        base.speed = 0;
        base.line.setOpen();
        QVERIFY(base.runUntil([&] { return base.isReady(); }, 1));
        base.run(0.1);
        const Telemetry &told = base.engine.report();
        QCOMPARE(told.counterJumps, 0ULL);
        const double way = base.arduino.counts[0] / 3000 * 2 * 3.14159 * 0.033;
        QVERIFY2(way > 0.6 && std::abs(told.pose.x - way) < 0.01, saying(told.pose.x - way));
    }

    void nothingButStopsBeforeItStands() {
        Base base;
        base.arduino.perFrame = {100, 100}; // from a program that ran before
        base.arduino.sinceSetPoint = 0;
        base.arduino.speeds = {3000, 3000};
        QVERIFY(base.runUntil([&] { return base.isReady(); }));
        QVERIFY(Base::isStop(base.sent.front()));
        for (const auto &packet : base.sent)
            QVERIFY2(Base::isStop(packet) || packet.text.find('m') == std::string::npos, packet.text.c_str());
        QCOMPARE(base.arduino.fastest(), 0.0);
    }

    // Also so quickly that nothing but its counts tells of it.
    void oneThatRestartsIsSetUpAnew_data() {
        const Rows<double, double> row("dead_s", "after_s");
        row("watchdog", 0.002, 1);
        row("watchdog, soon", 0.002, 0);
        row("boot loader", 1.6, 2);
    }

    void oneThatRestartsIsSetUpAnew() {
        FETCH(double, dead_s, double, after_s);
        Base base;
        QVERIFY(base.driveOff());
        base.run(after_s);
        const double x = base.engine.report().pose.x;
        base.arduino.restart(dead_s);
        QVERIFY(base.runUntil([&] { return !base.isReady(); }, 0.5));
        std::size_t lost = base.sent.size();
        while (base.sent[lost - 1].time >= base.now)
            --lost;
        base.engine.drive().acquire(Base::client, "test", 10, base.now); // who drives on whatever happens
        QVERIFY(base.runUntil([&] { return base.isReady(); }, 6));
        QCOMPARE(base.engine.controller(0).readings().setups, 2);
        QCOMPARE(base.arduino.fastest(), 0.0);
        QVERIFY(Base::isStop(base.sent[lost]));
        for (std::size_t i = lost; i < base.sent.size(); ++i)
            QVERIFY(Base::isStop(base.sent[i]) || base.sent[i].text.find('m') == std::string::npos);
        base.run(0.2);
        QVERIFY2(std::abs(base.engine.report().pose.x - x) < 0.1, saying(base.engine.report().pose.x - x));
    }

    // A digit that is lost makes a wrong number, and an answer that is lost one that comes too late: neither
    // is a restart.
    void damageIsNoRestart() {
        Base base;
        QVERIFY(base.driveOff());
        const double x = base.engine.report().pose.x, begin = base.now;
        int answers = 0;
        base.passes = [&](const std::string &text) {
            const bool isCounts = text.size() > 6 && text[0] != 'O' && text[0] != 'I';
            ++answers;
            return isCounts && answers % 20 == 7 ? text.substr(1) : answers % 50 == 33 ? std::string() : text;
        };
        base.run(5);
        QVERIFY(base.isReady());
        QCOMPARE(base.engine.controller(0).readings().restarts, 0);
        const double way = base.engine.report().pose.x - x;
        QVERIFY2(std::abs(way - 0.2 * (base.now - begin)) < 0.02, saying(way));
    }

    // Whose encoders have no supply any more stands by its counts, while it still rolls.
    void noStandBeforeItCanHaveBraked() {
        Base base;
        QVERIFY(base.driveOff(0.3));
        base.arduino.showsCounts = false;
        base.run(0.3);
        base.stop();
        const double begin = base.now;
        QVERIFY(base.runUntil([&] { return base.engine.controller(0).stands(); }, 3));
        QVERIFY2(base.now - begin > 0.9 * 0.3 / 0.5, saying(base.now - begin)); // safety.deceleration
    }

    // What is left of a command in its buffer would take the next one in.
    void aLostEndSwallowsNoStop_data() {
        const Rows<bool> row("answersEmpty");
        row("it answers an empty command", true);
        row("it does not", false);
    }

    void aLostEndSwallowsNoStop() {
        QFETCH(bool, answersEmpty);
        Base base;
        base.arduino.answersEmpty = answersEmpty;
        QVERIFY(base.driveOff());
        bool loses = true;
        base.hears = [&](const std::string &text) {
            const bool isLost = loses && text.find('m') != std::string::npos;
            loses = loses && !isLost;
            return isLost ? text.substr(0, text.size() - 1) : text;
        };
        QVERIFY(base.runUntil([&] { return !loses; }, 0.1));
        base.stop();
        QVERIFY(base.runUntil([&] { return Base::isStop(base.sent.back()); }, 0.06));
        QCOMPARE(base.arduino.perFrame, (std::array{0, 0}));
        base.run(1);
        QVERIFY2(base.isReady(), qPrintable(base.engine.controller(0).error()));
        QVERIFY(base.engine.controller(0).stands());
    }

    void whoIsNotHeardIsStoppedInSilence_data() {
        const Rows<bool> row("drives");
        row("while it drives", true);
        row("from the beginning", false);
    }

    void whoIsNotHeardIsStoppedInSilence() {
        QFETCH(bool, drives);
        Base base;
        QVERIFY(!drives || base.driveOff());
        base.passes = [](const std::string &) { return std::string(); };
        QVERIFY(base.runUntil([&] { return !base.isReady(); }, 0.5));
        QVERIFY(base.runUntil([&] { return base.arduino.fastest() == 0; }, 0.6)); // it hears
        QVERIFY(!base.engine.controller(0).stands());
        base.run(3);
        const std::size_t from = base.sent.size();
        base.run(10);
        QVERIFY(base.sent.size() > from + 1);
        for (std::size_t i = from; i < base.sent.size(); ++i) {
            QVERIFY(Base::isStop(base.sent[i]));
            QVERIFY(base.sent[i].time - base.sent[i - 1].time > 2.05);
        }
        base.passes = [](const std::string &text) { return text; };
        QVERIFY(base.runUntil([&] { return base.isReady(); }, 6));
    }

    // The zero that was sent last may be lost: so long as it turns it is not told to stand.
    void whoHasNotHeardItsStopMayTurn_data() {
        const Rows<double> row("later");
        row("at once", 0);
        row("before it is lost", 0.1);
        row("when it is lost", 0.4);
    }
    void whoHasNotHeardItsStopMayTurn() {
        QFETCH(double, later);
        Base base;
        QVERIFY(base.driveOff());
        base.hears = [](const std::string &) { return std::string(); };
        base.run(later);
        base.stop();
        QVERIFY(base.runUntil([&] { return !base.isReady(); }, 1));
        const auto mayTurn = [&] { return base.engine.controller(0).mayTurn(); };
        QVERIFY(base.runUntil([&] { return base.arduino.fastest() == 0 || !mayTurn(); }, 4));
        QVERIFY(mayTurn());
        QVERIFY(base.runUntil([&] { return !mayTurn(); }, 4)); // nor for ever
    }

    void whoDoesNotObeyIsStoppedBySilence() {
        Base base;
        QVERIFY(base.driveOff());
        base.arduino.latched = true;
        base.stop();
        const double told = base.now;
        QVERIFY(base.runUntil([&] { return base.arduino.fastest() == 0; }, 6));
        // 1.5 times braking and 0.3 s; its time-out; braking
        QVERIFY2(base.now - told < 1.5 * 0.4 + 0.3 + 2.1 + 0.4, saying(base.now - told));
        QVERIFY(base.engine.report().latch.isSet());
    }

    void damagedAnswersAreNoAnswers_data() {
        const Rows<QByteArray> row("answer");
        for (const char *text : {"12", "12 ", "12 3 4", "12  3", "x 3", "12 3x", "4294967296 1", "OK", "",
                                 "1111111111111111111111111111111111111111"})
            row(text[0] ? text : "empty", QByteArray(text));
    }

    void damagedAnswersAreNoAnswers() {
        QFETCH(QByteArray, answer);
        drive::ArduinoDevice device;
        const drive::Command counts{drive::Command::Kind::ReadEncoders};
        const auto ask = [&](const QByteArray &text) {
            device.reader().begin(device.bytes(counts));
            auto result = drive::ReplyReader::Result::Incomplete;
            for (const char letter : text) {
                if (result == drive::ReplyReader::Result::Incomplete)
                    result = device.reader().feed(std::uint8_t(letter));
            }
            return result;
        };
        QCOMPARE(ask("Invalid Command\r\n-2147483648 2147483647\r\n"), drive::ReplyReader::Result::Done);
        QCOMPARE(device.counts(), (std::array{0x80000000u, 0x7FFFFFFFu}));
        QCOMPARE(ask(answer + "\r\n"), drive::ReplyReader::Result::Unexpected);
        QCOMPARE(device.bytes(counts)[0], std::uint8_t('\r'));
        QCOMPARE(ask(answer + "\r\n7 -8\r\n"), answer.size() > 32 ? drive::ReplyReader::Result::Unexpected
                                                                  : drive::ReplyReader::Result::Done);
    }

    void speedsFitItsIntegers() {
        drive::ArduinoDevice device;
        const auto bytes = device.bytes({drive::Command::Kind::SetSpeeds, 0, {INT32_MAX, INT32_MIN}, 1});
        QCOMPARE(QByteArray(reinterpret_cast<const char *>(bytes.data()), int(bytes.size())),
                 QByteArray("\rm 32767 -32767\r"));
    }
};
