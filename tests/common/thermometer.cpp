// The daemon that the tests of the skeleton and of hermesctl run.
#include "common/daemon/Daemon.h"

#include <cmath>
#include <stdexcept>

using namespace hermes;

class Thermometer : public Daemon {
public:
    Thermometer()
        : Daemon({"thermometer", "Thermometer", "Measures a temperature that is made up", 7499}) {
        addSetting(
            Field::number("period_s", "Time between readings").unit("s").range(0.001, 60).byDefault(0.1));
        addSetting(Field::text("sensor.name", "What it measures").byDefault("room").appliesOnRestart());
        addTopic(Topic("temperature", "Each reading in degrees Celsius").schema({{"type", "number"}}));
        addTopic(Topic("extremes", "Least and greatest reading").snapshot([this] { return extremes(); }));
        addCommand(Command("thermometer.read", "Reads now")
                       .param(Field::text("unit", "Of the result").choices({"C", "K"}).byDefault("C"))
                       .returns({{"type", "number"}})
                       .example({{"unit", "K"}}, 293.15)
                       .handler([this](const Call &call) -> Result<QJsonValue> {
                           return read() + (call.text("unit") == "K" ? 273.15 : 0);
                       }));
        addCommand(
            Command("thermometer.calibrate", "Shifts all readings; answers when it has settled")
                .param(Field::number("offset_k", "Shift").unit("K").range(-5, 5))
                .param(Field::integer("settle_ms", "Time to settle").unit("ms").range(0, 10000).byDefault(10))
                .returnsNull()
                .asyncHandler([this](const Call &call, const Reply &reply) {
                    offset = call.number("offset_k");
                    QTimer::singleShot(call.integer("settle_ms"), this, [reply] { reply.result({}); });
                }));
        addCommand(Command("thermometer.break", "Fails in the way asked for, to test what becomes of errors")
                       .param(Field::text("way", "How").choices({"throw", "nan", "silent", "device"}))
                       .asyncHandler(
                           [](const Call &call, const Reply &reply) { breakDown(call.text("way"), reply); }));
        addCommand(Command("thermometer.echo", "Gives back what it gets")
                       .param(Field::any("value", "Anything"))
                       .handler([](const Call &call) { return call.value("value"); }));
        connect(&timer, &QTimer::timeout, this, &Thermometer::tick);
    }

protected:
    Result<void> start() override {
        settingsChanged({});
        health().expectEvery("sensor", std::chrono::seconds(120));
        setState(DaemonState::Running);
        return {};
    }
    void stop() override { timer.stop(); }
    void settingsChanged(const QStringList &) override {
        timer.start(int(settings().number("period_s") * 1000));
    }

private:
    double read() const { return 20 + offset + std::sin(0.01 * count); }
    QJsonValue extremes() const { return QJsonObject{{"least", 19 + offset}, {"greatest", 21 + offset}}; }
    void tick() {
        ++count;
        health().set("sensor", HealthLevel::Ok, "reading", {{"count", count}});
        publish("temperature", read());
    }
    static void breakDown(const QString &way, const Reply &reply) {
        if (way == "throw")
            throw std::runtime_error("broken on purpose");
        if (way == "nan")
            reply.result(QJsonObject{{"reading", std::nan("")}});
        if (way == "device")
            reply.error(
                Error(ErrorCode::DeviceFault, "the sensor is unplugged", QJsonObject{{"device", "t0"}}));
    }

    QTimer timer;
    double offset = 0;
    int count = 0;
};

int main(int argc, char **argv) {
    return runDaemon<Thermometer>(argc, argv);
}
