#include "daemons/scanmatcher/ScanMatcher.h"

#include "common/client/DaemonAddress.h"
#include "common/settings/DottedPath.h"
#include "common/settings/SettingsTable.h"
#include "vectorlib/mapping/NamedSettings.h"

namespace hermes::scanmatcher {
namespace {

std::vector<SchemaViolation> checkAddresses(const QJsonObject &settings) {
    std::vector<SchemaViolation> wrong;
    for (const QString path : {"source.address", "source2.address", "odometry.address"}) {
        const QString address = valueAt(settings, path).toString();
        if (address.isEmpty() && path != "source.address")
            continue;
        if (const Result<void> fine = checkAddress(address); !fine)
            wrong.push_back({path, address, fine.error().message});
    }
    const auto of = [&](const QString &source) {
        return std::pair(valueAt(settings, source + ".address"), valueAt(settings, source + ".topic"));
    };
    if (of("source") == of("source2"))
        wrong.push_back(
            {"source2.address", of("source2").first, "another daemon or topic than that of source"});
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
    SettingsTable table;
    table.group("Source");
    table.define("source.address", "127.0.0.1:7420", "Daemon that publishes the scans: HOST:PORT or a URL");
    table.define("source.topic", "scan2d", "Its topic");
    table.define("source.queue", 50, "Scans that may wait to be matched; more drop the oldest", "scans", 1,
                 10000);
    table.define("source2.address", "",
                 "Daemon that publishes the scans of a second scanner on the robot; none: there is "
                 "one scanner");
    table.define("source2.topic", "scan2d", "Its topic");
    table.group("Odometry");
    table.define("odometry.address", "",
                 "Daemon that publishes the robot's odometry: HOST:PORT or a URL; none: poses are expected "
                 "from the scans alone");
    table.define("odometry.topic", "odometry", "Its topic");
    table.define("odometry.stop", true,
                 "Send motor.stop to this daemon when the scans contradict its odometry, as wheels "
                 "that turn on the spot make them");
    for (const auto &[name, what] : {std::pair(QString("sensor."), QString("the sensor is")),
                                     std::pair(QString("sensor2."), QString("the second scanner is"))}) {
        table.define(name + "x_m", 0.0, "How far " + what + " ahead of the robot's centre", "m", -100, 100);
        table.define(name + "y_m", 0.0, "How far it is to the left", "m", -100, 100);
        table.define(name + "theta_rad", 0.0, "Its heading in the robot's frame, counter-clockwise", "rad",
                     -2 * vectorlib::pi, 2 * vectorlib::pi);
        table.define(name + "upside_down", false, "It is mounted upside down, or counts angles clockwise");
    }
    table.group("Matching", SettingsTable::Applies::OnRestart);
    table.define("matcher.start", "mapping", "What to do from the start on")
        .choices({"mapping", "localization", "nothing"});
    table.group("Matching");
    table.define("matcher.compensate_motion", true,
                 "Correct each scan for the sensor's motion while it was taken");
    table.define("matcher.sigma_m", 0.02, "Largest standard deviation of points from their line segment", "m",
                 0.001, 1);
    table.define("matcher.expected_deviation_m", 0.05, "How far the expected position is usually wrong", "m",
                 0.001, 10);
    table.define("matcher.expected_deviation_rad", 0.10, "How far the expected heading is usually wrong",
                 "rad", 0.001, 3);
    table.define("matcher.permitted_m", 0.5, "Largest error of the expected position in x and y", "m", 0.01,
                 20);
    table.define("matcher.permitted_rad", 0.4, "Largest error of the expected heading", "rad", 0.01, 3.1);
    table.define("matcher.remember_mb", 300.0,
                 "Memory that a drive may take to close its loops. What is driven beyond that is not "
                 "remembered, also when this is raised later",
                 "MB", 0.1, 100000);
    table.define("matcher.relocalize_s", 3.0, "Longest search of the whole map", "s", 0.01, 20);
    table.define("matcher.min_matched_share", 0.15, "Share of the seen length that must match the map")
        .range(0, 1);
    table.define("matcher.close_loops", true,
                 "Match scans of places that are met again, and make the map anew where the drive bent; "
                 "only while the map grows");
    table.define("matcher.relocalize_after", 10,
                 "Lost scans in a row after which the whole map is searched; 0: never. "
                 "Only 1 and 2 act while the map grows",
                 "scans", 0, 100000);
    table.group("Map", SettingsTable::Applies::OnRestart);
    table.define("map.folder", ".", "Below it are the files of maps that clients name; made when missing");
    table.define("map.journal", "",
                 "File below map.folder, NAME.journal, in which the drive is written down while the "
                 "map grows, every 4 s; where there is one, NAME-2.journal and so on. Empty: none");
    table.declareIn(settings());
}

vectorlib::ScanTrackerSettings ScanMatcher::trackerSettings() const {
    auto &values = const_cast<ScanMatcher *>(this)->settings();
    return vectorlib::namedTrackerSettings([&](const char *name) {
        const QJsonValue value = values.value(name);
        return value.isBool() ? double(value.toBool()) : value.toDouble();
    });
}

} // namespace hermes::scanmatcher
