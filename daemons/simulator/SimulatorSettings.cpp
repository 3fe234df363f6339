#include "common/files/FilesSetting.h"
#include "daemons/simulator/Simulator.h"

namespace hermes::simulator {

void Simulator::addNumber(const char *group, const char *name, const char *text, const char *unit,
                          double least, double most, double value) {
    addSetting(Field::number(name, text)
                   .unit(unit)
                   .range(least, most)
                   .byDefault(value)
                   .appliesOnRestart()
                   .group(group));
}

void Simulator::declareSettings() {
    addSetting(Field::text("world", "World file to load at the start; empty: none until sim.load")
                   .byDefault("")
                   .appliesOnRestart()
                   .group("World"));
    addSetting(namedFilesField());
    addSetting(Field::integer("seed", "Of the noise: the same seed gives the same noise")
                   .range(0, 4294967295.0)
                   .byDefault(1)
                   .appliesOnRestart()
                   .group("World"));
    addNumber("World", "wall_height_m", "Height of the walls; beams above them return nothing", "m", 0.01,
              100, 2.5);
    addNumber("Robot", "robot.speed_mps", "Largest speed along the path", "m/s", 0.01, 20, 0.8);
    addNumber("Robot", "robot.acceleration_mps2", "When speeding up and slowing down", "m/s^2", 0.01, 50,
              0.8);
    addNumber("Robot", "robot.turn_rate_rps", "Largest turn rate", "rad/s", 0.01, 20, 1.0);
    addNumber("Robot", "robot.radius_m", "Of its outline, which walls stop", "m", 0.01, 5, 0.3);
    addSetting(Field::boolean("robot.autostart", "Follow the path at once, without sim.drive")
                   .byDefault(false)
                   .appliesOnRestart()
                   .group("Robot"));
    addSetting(Field::text("lidar.host", "IPv4 address that packets are sent to")
                   .byDefault("127.0.0.1")
                   .appliesOnRestart()
                   .group("Lidar"));
    addSetting(Field::integer("lidar.port", "UDP port that packets are sent to")
                   .range(1, 65535)
                   .byDefault(velodyne::dataPort)
                   .appliesOnRestart()
                   .group("Lidar"));
    addSetting(
        Field::integer("lidar.position_port", "UDP port that position packets are sent to; 0: none are")
            .range(0, 65535)
            .byDefault(velodyne::positionPort)
            .appliesOnRestart()
            .group("Lidar"));
    addNumber("Lidar", "lidar.rpm", "Turns of the head a minute", "1/min", 300, 1200, 600);
    addNumber("Lidar", "lidar.height_m", "Of the sensor above the floor", "m", 0.01, 10, 0.5);
    addNumber("Lidar", "lidar.min_range_m", "Nearer things return nothing", "m", 0, 10, 0.05);
    addNumber("Lidar", "lidar.max_range_m", "Farther things return nothing", "m", 1, 131, 100);
    addSetting(Field::number("lidar.sigma_m", "Standard deviation of the range")
                   .unit("m")
                   .range(0, 1)
                   .byDefault(0.01)
                   .group("Lidar"));
    addSetting(Field::number("lidar.dropouts", "Share of the returns that do not come")
                   .range(0, 1)
                   .byDefault(0)
                   .group("Lidar"));
    addSetting(Field::number("lidar.outliers", "Share of the returns with a wrong range, up to twice as far")
                   .range(0, 1)
                   .byDefault(0)
                   .group("Lidar"));
    declareMotorSettings();
    declareGpsSettings();
}

Simulation::Options Simulator::options() {
    const Settings &values = settings();
    Simulation::Options options;
    options.speed = values.number("robot.speed_mps");
    options.acceleration = values.number("robot.acceleration_mps2");
    options.turnRate = values.number("robot.turn_rate_rps");
    options.rpm = values.number("lidar.rpm");
    options.lidar.sigma = values.number("lidar.sigma_m");
    options.lidar.dropouts = values.number("lidar.dropouts");
    options.lidar.outliers = values.number("lidar.outliers");
    options.lidar.sensorHeight = values.number("lidar.height_m");
    options.lidar.wallHeight = values.number("wall_height_m");
    options.lidar.minRange = values.number("lidar.min_range_m");
    options.lidar.maxRange = values.number("lidar.max_range_m");
    options.radius = values.number("robot.radius_m");
    options.drivetrain = drivetrainOptions();
    options.gps = gpsOptions();
    options.seed = std::uint64_t(values.number("seed"));
    return options;
}

} // namespace hermes::simulator
