#include "daemons/scanmatcher/ScanMatcher.h"

#include "common/client/DaemonAddress.h"
#include "common/settings/DottedPath.h"
#include "vectorlib/mapping/NamedSettings.h"

namespace hermes::scanmatcher {
namespace {

std::vector<SchemaViolation> checkAddresses(const QJsonObject &settings) {
    std::vector<SchemaViolation> wrong;
    for (const QString &path : {QString("source.address"), QString("odometry.address")}) {
        const QString address = valueAt(settings, path).toString();
        if (address.isEmpty() && path == "odometry.address")
            continue;
        if (const Result<void> fine = checkAddress(address); !fine)
            wrong.push_back({path, address, fine.error().message});
    }
    return wrong;
}

std::vector<SchemaViolation> checkJournal(const QJsonObject &settings) {
    const QString name = valueAt(settings, "map.journal").toString();
    const QString suffix = ".journal";
    if (name.isEmpty() || (name.endsWith(suffix) && name.size() > suffix.size() && !name.contains('/')))
        return {};
    return {{"map.journal", name, "a file's name that ends with " + suffix + ", without a folder"}};
}

} // namespace

void ScanMatcher::declareSettings() {
    settings().addRule(checkAddresses);
    settings().addRule(checkJournal);
    addSetting(Field::text("source.address", "Daemon that publishes the scans: HOST:PORT or a URL")
                   .byDefault("127.0.0.1:7420")
                   .group("Source"));
    addSetting(Field::text("source.topic", "Its topic").byDefault("scan2d").group("Source"));
    addSetting(Field::integer("source.queue", "Scans that may wait to be matched; more drop the oldest")
                   .unit("scans")
                   .range(1, 10000)
                   .byDefault(50)
                   .group("Source"));
    addSetting(Field::text("odometry.address",
                           "Daemon that publishes the robot's odometry: HOST:PORT or a URL; "
                           "none: poses are expected from the scans alone")
                   .byDefault("")
                   .group("Odometry"));
    addSetting(Field::text("odometry.topic", "Its topic").byDefault("odometry").group("Odometry"));
    addSetting(
        Field::boolean("odometry.stop",
                       "Send motor.stop to this daemon when the scans contradict its odometry, as wheels "
                       "that turn on the spot make them")
            .byDefault(true)
            .group("Odometry"));
    const auto sensor = [this](const char *name, const char *text) {
        addSetting(Field::number(name, text).unit("m").range(-100, 100).byDefault(0).group("Odometry"));
    };
    sensor("sensor.x_m", "How far the sensor is ahead of the robot's centre");
    sensor("sensor.y_m", "How far it is to the left");
    addSetting(Field::angle("sensor.theta_rad", "Its heading in the robot's frame, counter-clockwise")
                   .byDefault(0)
                   .group("Odometry"));
    addSetting(Field::text("matcher.start", "What to do from the start on")
                   .choices({"mapping", "localization", "nothing"})
                   .byDefault("mapping")
                   .appliesOnRestart()
                   .group("Matching"));
    addSetting(Field::boolean("matcher.compensate_motion",
                              "Correct each scan for the sensor's motion while it was taken")
                   .byDefault(true)
                   .group("Matching"));
    struct Number {
        const char *name, *text, *unit;
        double least, most, usual;
    };
    for (const Number &n : {
             Number{"matcher.sigma_m", "Largest standard deviation of points from their line segment", "m",
                    0.001, 1, 0.02},
             Number{"matcher.expected_deviation_m", "How far the expected position is usually wrong", "m",
                    0.001, 10, 0.05},
             Number{"matcher.expected_deviation_rad", "How far the expected heading is usually wrong", "rad",
                    0.001, 3, 0.10},
             Number{"matcher.permitted_m", "Largest error of the expected position in x and y", "m", 0.01, 20,
                    0.5},
             Number{"matcher.permitted_rad", "Largest error of the expected heading", "rad", 0.01, 3.1, 0.4},
             Number{"matcher.remember_mb",
                    "Memory that a drive may take to close its loops. What is driven beyond that is not "
                    "remembered, also when this is raised later",
                    "MB", 0.1, 100000, 300},
             Number{"matcher.relocalize_s", "Longest search of the whole map", "s", 0.01, 20, 3},
         })
        addSetting(Field::number(n.name, n.text)
                       .unit(n.unit)
                       .range(n.least, n.most)
                       .byDefault(n.usual)
                       .group("Matching"));
    addSetting(Field::number("matcher.min_matched_share", "Share of the seen length that must match the map")
                   .range(0, 1)
                   .byDefault(0.15)
                   .group("Matching"));
    addSetting(Field::boolean(
                   "matcher.close_loops",
                   "Match scans of places that are met again, and make the map anew where the drive bent; "
                   "only while the map grows")
                   .byDefault(true)
                   .group("Matching"));
    addSetting(Field::integer("matcher.relocalize_after",
                              "Lost scans in a row after which the whole map is searched; 0: never. "
                              "Only 1 and 2 act while the map grows")
                   .unit("scans")
                   .range(0, 100000)
                   .byDefault(10)
                   .group("Matching"));
    addSetting(
        Field::text("map.folder", "Below it are the files of maps that clients name; made when missing")
            .byDefault(".")
            .appliesOnRestart()
            .group("Map"));
    addSetting(
        Field::text("map.journal",
                    "File below map.folder, NAME.journal, in which the drive is written down while the "
                    "map grows, every 4 s; where there is one, NAME-2.journal and so on. Empty: none")
            .byDefault("")
            .appliesOnRestart()
            .group("Map"));
}

vectorlib::ScanTrackerSettings ScanMatcher::trackerSettings() const {
    auto &values = const_cast<ScanMatcher *>(this)->settings();
    return vectorlib::namedTrackerSettings([&](const char *name) {
        const QJsonValue value = values.value(name);
        return value.isBool() ? double(value.toBool()) : value.toDouble();
    });
}

} // namespace hermes::scanmatcher
