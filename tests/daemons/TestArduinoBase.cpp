// A base of two wheels with an Arduino that speaks the text protocol, on a clock of its own: what is sent to
// it, what stops it when it restarts, is not heard or loses bytes, and that no time is promised that it
// cannot keep.
#include "daemons/motorcontrol/DriveEngine.h"
#include "daemons/motorcontrol/LineMaster.h"
#include "daemons/motorcontrol/MotorMessages.h"
#include "protocol/drive/ArduinoDevice.h"

#include <deque>

using namespace hermes;
using namespace hermes::motorcontrol;

namespace {

/// The device's end of the line, from the text of its firmware: letters until CR, of which the last before
/// the blank counts; a missing argument is 0, what follows no number is left out.
class FakeArduino {
public:
    std::array<double, 2> counts{}, speeds{}; ///< counts; counts/s
    std::array<int, 2> perFrame{};            ///< as it was told
    bool latched = false;                     ///< it answers, and keeps its set-point
    bool answersEmpty = true;                 ///< "Invalid Command" to a CR alone
    double sinceSetPoint = 10;

    /// It hears nothing for so long, and begins anew.
    void restart(double seconds) {
        dead_ = seconds;
        perFrame = {};
        text_.clear();
    }
    void advance(double seconds) {
        dead_ -= seconds;
        sinceSetPoint += seconds;
        if (sinceSetPoint >= 2)
            perFrame = {};
        for (std::size_t i = 0; i < 2; ++i) {
            const double target = 30.0 * perFrame[i], most = 8000 * seconds; // counts/s^2
            speeds[i] += std::clamp(target - speeds[i], -most, most);
            counts[i] = dead_ > 0 ? 0 : counts[i] + speeds[i] * seconds;
        }
    }
    std::string receive(std::uint8_t byte) {
        if (dead_ > 0)
            return {};
        if (byte != '\r') {
            text_.push_back(char(byte));
            return {};
        }
        const std::string command = std::exchange(text_, {});
        const auto blank = command.find(' ');
        const char letter = command.empty() || blank == 0 ? 0 : command[std::min(blank, command.size()) - 1];
        if (letter == 'e')
            return std::to_string(std::int64_t(counts[0])) + ' ' + std::to_string(std::int64_t(counts[1])) +
                   "\r\n";
        if (letter != 'm')
            return answersEmpty || letter != 0 ? "Invalid Command\r\n" : "";
        int left = 0, right = 0;
        std::sscanf(command.c_str() + blank, " %d", &left);
        const auto second = command.find(' ', blank + 1);
        if (second != std::string::npos)
            std::sscanf(command.c_str() + second, " %d", &right);
        sinceSetPoint = 0;
        if (!latched)
            perFrame = {left, right};
        return "OK\r\n";
    }
    double fastest() const { return std::max(std::abs(speeds[0]), std::abs(speeds[1])); }

private:
    std::string text_;
    double dead_ = 0;
};

QJsonObject arduinoSettings(const QJsonObject &more = {}) {
    QJsonObject all{{"controllers", QJsonObject{{"kind", "arduino"}, {"timeout_s", 2}}},
                    {"frame", QJsonObject{{"layout", "differential"},
                                          {"wheel_radius_m", 0.033},
                                          {"half_track_m", 0.1},
                                          {"counts_per_turn", 3000}}},
                    {"pid", QJsonObject{{"qpps", 6000}}},
                    {"safety", QJsonObject{{"deceleration", 0.5}}},
                    {"faults", QJsonObject{{"encoder_hold_s", 1.0}}},
                    {"wheels", QJsonObject{{"front_right", QJsonObject{{"reversed", true}}}}},
                    {"motion", QJsonObject{{"vx", 0.3}}}};
    for (auto group = more.begin(); group != more.end(); ++group) {
        QJsonObject values = all[group.key()].toObject();
        const QJsonObject changed = group.value().toObject();
        for (auto value = changed.begin(); value != changed.end(); ++value)
            values[value.key()] = value.value();
        all[group.key()] = values;
    }
    return all;
}

Result<MotorSettings> settingsOf(const QJsonObject &json) {
    Settings settings;
    declareMotorSettings([&](const Field &field) { settings.declare(field); });
    settings.addRule(checkMotorSettings);
    const auto set = settings.set(json);
    if (!set)
        return set.error();
    return MotorSettings::from(settings);
}

struct Base {
    struct Packet {
        double time;
        std::string text;
    };

    explicit Base(const MotorSettings &settings = *settingsOf(arduinoSettings()))
        : engine(settings)
        , line({&engine.controller(0)}) {
        line.setOpen();
    }

    void run(double seconds) {
        for (const double end = now + seconds; now < end;)
            step();
    }
    bool runUntil(const std::function<bool()> &isSo, double limit = 10) {
        for (const double end = now + limit; now < end; step()) {
            if (isSo())
                return true;
        }
        return false;
    }
    /// The program dies: the device alone goes on.
    void die(double seconds) {
        for (const double end = now + seconds; now < end; now += tick)
            arduino.advance(tick);
    }
    bool isReady() { return engine.controller(0).isReady(); }
    bool driveOff(double vx = 0.2) {
        if (!runUntil([this] { return isReady(); }))
            return false;
        run(0.02); // the next cycle
        if (!engine.drive().acquire(client, "test", 10, now))
            return false;
        speed = vx;
        return runUntil([&] { return arduino.fastest() > 0.9 * vx / 0.033 * 3000 / 6.2832; }, 2);
    }
    /// Without the ramp.
    void stop() {
        speed = 0;
        engine.drive().stop(client, "test");
        engine.obey();
    }
    static bool isStop(const Packet &packet) { return packet.text.find("m 0 0\r") != std::string::npos; }

    static constexpr double tick = 0.001;
    static constexpr quint64 client = 1;
    double now = 1, speed = 0;
    FakeArduino arduino;
    DriveEngine engine;
    LineMaster line;
    std::vector<Packet> sent;
    /// What arrives of what is sent, and of what is answered.
    std::function<std::string(const std::string &)> hears = [](const std::string &text) { return text; },
                                                    passes = [](const std::string &text) { return text; };

private:
    void step() {
        now += tick;
        arduino.advance(tick);
        if (now >= nextCycle_) {
            nextCycle_ += 0.02;
            engine.cycle(now);
            if (engine.drive().lease().isHeldBy(client))
                engine.drive().driveTwist(client, {speed, 0, 0}, 0, now);
            engine.obey();
        }
        while (!answers_.empty() && answers_.front().time <= now) {
            const std::string text = answers_.front().text;
            answers_.pop_front();
            line.feed(reinterpret_cast<const std::uint8_t *>(text.data()), text.size(), now);
        }
        while (const drive::Bytes *packet = line.poll(now)) {
            sent.push_back(
                {now, std::string(reinterpret_cast<const char *>(packet->data()), packet->size())});
            for (const char letter : hears(sent.back().text)) {
                const std::string answer = passes(arduino.receive(std::uint8_t(letter)));
                if (!answer.empty())
                    answers_.push_back({now + 0.004, answer});
            }
        }
    }

    double nextCycle_ = 1;
    std::deque<Packet> answers_;
};

} // namespace

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
        QCOMPARE(told.controllers[0].timeout_s, 2.0);
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
    }

    void settingsFitTogether_data() {
        const Rows<QJsonObject, QString> row("changes", "refused");
        row("as they should", QJsonObject(), QString());
        row("a time that it cannot keep", {{"controllers", QJsonObject{{"timeout_s", 0.5}}}},
            QString("controllers.timeout_s"));
        row("a RoboClaw for so long", {{"controllers", QJsonObject{{"kind", "roboclaw"}}}},
            QString("controllers.timeout_s"));
        row("mecanum", {{"frame", QJsonObject{{"layout", "mecanum"}}}}, QString("frame.layout"));
        row("two wheels on one motor", {{"wheels", QJsonObject{{"front_left", QJsonObject{{"motor", 2}}}}}},
            QString("wheels.front_right.motor"));
        row("on a second controller",
            {{"wheels", QJsonObject{{"front_left", QJsonObject{{"controller", 2}}}}}},
            QString("wheels.front_left.controller"));
        row("too coarse",
            {{"frame", QJsonObject{{"counts_per_turn", 300}}}, {"pid", QJsonObject{{"qpps", 600}}}},
            QString("faults.encoder_commanded_rad_s"));
    }

    void settingsFitTogether() {
        FETCH(QJsonObject, changes, QString, refused);
        const auto settings = settingsOf(arduinoSettings(changes));
        const QString message = settings ? QString() : settings.error().message;
        if (refused.isEmpty())
            QCOMPARE(message, refused);
        else
            VERIFY_CONTAINS(message, refused);
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
