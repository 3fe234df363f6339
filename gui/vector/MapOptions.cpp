#include "gui/vector/MapOptions.h"

#include "gui/vector/MapFiles.h"

namespace hermes::vector {

void MapOptions::addTo(CLI::App &command) {
    addInput(command);
    addFiles(command);
    addWays(command);
    command.footer(
        example("hermes-vector map intel.log.gz --corrected --out-map intel.svg --out-trajectory intel.tum"));
    const auto excludes = [&command](const char *option, std::initializer_list<const char *> others) {
        for (const char *other : others)
            command.get_option(option)->excludes(command.get_option(other));
    };
    excludes("--scan", {"--out-map", "--out-trajectory", "--out-graph", "--out-trust", "--svg", "--odometry",
                        "--loops", "--corrected", "--every", "--localize", "--sensor"});
    excludes("--localize", {"--out-map", "--out-graph", "--out-trust", "--loops"});
}

void MapOptions::addInput(CLI::App &command) {
    command
        .add_option(
            "LOG", source.path,
            "CARMEN log, bag of ROS (.bag, .db3, .mcap or the folder of one), pcap of an " +
                velodyne::sensorNames() +
                " (of NAME-0001.pcap, NAME-0002.pcap ... the first), the folder of a session, or one of "
                "points files taken in name order (2 before 10)")
        ->required();
    addOption(command, "--scan N", onlyScan, wholeNumber(0, 1e9),
              "Build no map: write the points of scan N, from 0, as CSV x,y in its sensor's frame, for the "
              "commands that take one scan");
    addOption(
        command, "--localize FILE", localize,
        "Build no map: find the poses in this finished one (CSV by map --out-map), which does not change");
}

void MapOptions::addFiles(CLI::App &command) {
    addOption(command, "--out-map FILE", outMap, MapFile::knownName(),
              "The map; its kind follows from the extension: csv, svg, geojson, dxf, pgm");
    addOption(command, "--out-trajectory FILE", outTrajectory,
              "The sensor's poses, TUM format: stamp x y z qx qy qz qw; a stamp that is not later than the "
              "one before is moved to a microsecond behind it");
    addOption(command, "--out-graph FILE", outGraph,
              "The poses and the motions measured between them, g2o format");
    addOption(command, "--out-trust FILE", outTrust,
              "How probable it is that each pose of the trajectory was found right, CSV stamp,trust");
    addOption(command, "--summary,--out FILE", summary,
              "The summary, or the points of --scan; standard output when not given");
    addOption(command, "--svg FILE", svg, pictureName(), "Also draw a picture of map and trajectory");
}

void MapOptions::addWays(CLI::App &command) {
    addOption(
        command, "--odometry HOW", odometry, CLI::IsMember({"use", "ignore"}),
        "use: expect the motion that the log's odometry tells; ignore: expect the motion to go on as before")
        ->capture_default_str();
    addOption(command, "--loops HOW", loops, CLI::IsMember({"close", "leave"}),
              "close: match scans of places that were met again and bring the whole drive into one frame; "
              "leave: poses as they were tracked")
        ->capture_default_str();
    command.add_flag("--corrected", source.corrected,
                     "The log's scan poses are a corrected reference: odometry is taken from its ODOM lines "
                     "only, and the summary tells the error against the reference");
    addOption(command, "--sensor X,Y,THETA", sensor, poseText(true),
              "Pose of the sensor on the robot of a CARMEN log, a session or a bag: metres, radians (degrees "
              "as 90deg)");
    addOption(command, "--field-of-view DEG", source.fieldOfView, between(1, 360),
              "Angle that a scan of a CARMEN log covers, degrees");
    addOption(command, "--max-range M", source.maxRange, between(0.01, 1000),
              "No return of a CARMEN log from this range on, metres");
    addOption(command, "--seconds-per-turn S", source.secondsPerTurn, between(-10, 10),
              "Time in which the scanner of a CARMEN log makes a full turn, below 0 for clockwise; 0: each "
              "scan is of one moment. Else the turns of the robot tell it");
    command.add_flag("--mirrored", source.mirrored,
                     "The angles of a CARMEN log count clockwise, as of a scanner that hangs upside down");
    addOption(command, "--every N", source.every, wholeNumber(1, 1e9), "Take every N-th scan only")
        ->capture_default_str();
    command.add_flag("--skip-damaged", source.skipDamaged,
                     "Count damaged lines of a log and go on instead of stopping at the first");
    source.sensor.addTo(command);
    addOption(command, "--topic NAME", source.scanner.topic,
              "Of a bag with several scanners: the topic of this one");
    addOption(
        command, "--laser ID", source.scanner.cloud.laser, wholeNumber(0, 1e6),
        "Of a bag's cloud of points: the ring that is used, else the one that looks nearest to the horizon");
    addOption(command, "--height M", source.scanner.cloud.height, between(-100, 100),
              "Of a bag's cloud without rings: how high over the sensor the slice lies that is used, metres");
    sigmaOption_ = addOption(command, "--sigma M", sigma, aboveZero(),
                             "Largest standard deviation of points from their line, metres")
                       ->capture_default_str();
    segment.addTo(command,
                  "defaults by the scanner: 10, 0.05, 0.20, 15 for a dense one, else 5, 0.10, 0.60, 4");
    command.add_flag("--force", force, "Overwrite files that exist");
}

} // namespace hermes::vector
