// What the settings demand of each kind of motor controller.
#include "ArduinoSettings.h"

using namespace hermes;

class TestDeviceSettings : public QObject {
    Q_OBJECT
private Q_SLOTS:
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
        const auto kind = [](const char *name, double timeout_s, const QJsonObject &more = {}) {
            QJsonObject controllers{{"kind", name}, {"timeout_s", timeout_s}, {"count", 1}};
            for (auto value = more.begin(); value != more.end(); ++value)
                controllers[value.key()] = value.value();
            return QJsonObject{{"controllers", controllers}};
        };
        row("one RoboClaw", kind("roboclaw", 0.2), QString());
        row("one Roboteq", kind("roboteq", 0.5), QString());
        row("a Roboteq for so long", kind("roboteq", 0.6), QString("controllers.timeout_s"));
        row("an OpenCR", kind("opencr", 0.5), QString());
        row("an OpenCR, sooner", kind("opencr", 0.4), QString("controllers.timeout_s"));
        row("VESCs", kind("vesc", 2), QString());
        row("VESCs on one line", kind("vesc", 1, {{"count", 0}}), QString("controllers.2.url"));
        row("no address of a RoboClaw", kind("roboclaw", 0.2, {{"1", QJsonObject{{"address", 127}}}}),
            QString("controllers.1.address"));
        row("VESCs that are too slow", kind("vesc", 1, {{"least_erpm", 9000}}),
            QString("faults.encoder_commanded_rad_s"));
        const auto unstopped = [&](const char *name, double timeout_s, double vx) {
            QJsonObject all = kind(name, timeout_s);
            all["safety"] = QJsonObject{{"no_device_timeout", true}};
            all["motion"] = QJsonObject{{"vx", vx}};
            return all;
        };
        row("a second VESC where there is none", kind("vesc", 1, {{"1", QJsonObject{{"address", 255}}}}),
            QString("wheels.front_right.motor"));
        row("never stopping", unstopped("vesc", 1, 0.3), QString());
        row("never stopping, fast", unstopped("vesc", 1, 0.31), QString("motion.vx"));
        row("never stopping, though it does", unstopped("opencr", 0.5, 0.3),
            QString("safety.no_device_timeout"));
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
};
