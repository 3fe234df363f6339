#include "common/daemon/Daemon.h"

#include <cmath>

using namespace hermes;

/// Stands for your device: its readings are made up.
class Sensor {
public:
    bool isOpen() const { return true; }
    double read() { return 1013 + std::sin(0.01 * ++count_); }

private:
    int count_ = 0;
};

class Barometer : public Daemon {
public:
    Barometer()
        : Daemon({"barometer", "Barometer", "Measures the air pressure", 7499}) {
        addSetting(
            Field::number("period_s", "Time between readings").unit("s").range(0.001, 60).byDefault(0.1));
        addTopic(Topic("pressure", "Each reading in hPa").schema({{"type", "number"}}));
        addCommand(Command("barometer.read", "Reads now")
                       .param(Field::text("unit", "Of the result").choices({"hPa", "bar"}).byDefault("hPa"))
                       .returns({{"type", "number"}})
                       .example({{"unit", "bar"}}, 1.013)
                       .handler([this](const Call &call) -> Result<QJsonValue> {
                           if (!sensor.isOpen())
                               return Error(ErrorCode::DeviceFault, "the sensor is unplugged");
                           return sensor.read() / (call.text("unit") == "bar" ? 1000 : 1);
                       }));
        connect(&timer, &QTimer::timeout, this, [this] {
            health().set("sensor", HealthLevel::Ok, "reading");
            publish("pressure", sensor.read());
        });
    }

protected:
    Result<void> start() override { // settings are valid, channels are open
        settingsChanged({});
        setState(DaemonState::Running);
        return {}; // or an Error: the program ends with status 1 and says why
    }
    void stop() override { timer.stop(); }
    void settingsChanged(const QStringList &) override {
        timer.start(int(settings().number("period_s") * 1000));
    }

private:
    Sensor sensor;
    QTimer timer;
};

int main(int argc, char **argv) {
    return runDaemon<Barometer>(argc, argv);
}
