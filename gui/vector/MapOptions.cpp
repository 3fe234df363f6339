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
        .add_option("LOG", source.path,
                    "CARMEN log, pcap of an " + velodyne::sensorNames() +
                        ", or a folder of points files taken in name order (2 before 10)")
        ->required();
    command
        .add_option("--scan", onlyScan,
                    "Build no map: write the points of scan N, from 0, as CSV x,y in its sensor's frame, for "
                    "the commands that take one scan")
        ->transform(wholeNumber(0, 1e9))
        ->type_name("N");
    command
        .add_option(
            "--localize", localize,
            "Build no map: find the poses in this finished one (CSV by map --out-map), which does not "
            "change")
        ->type_name("FILE");
}

void MapOptions::addFiles(CLI::App &command) {
    command
        .add_option("--out-map", outMap,
                    "The map; its kind follows from the extension: csv, svg, geojson, dxf, pgm")
        ->check(MapFile::knownName())
        ->type_name("FILE");
    command
        .add_option("--out-trajectory", outTrajectory,
                    "The sensor's poses, TUM format: stamp x y z qx qy qz qw; a stamp that is not later than "
                    "the one before is moved to a microsecond behind it")
        ->type_name("FILE");
    command
        .add_option("--out-graph", outGraph, "The poses and the motions measured between them, g2o format")
        ->type_name("FILE");
    command
        .add_option("--out-trust", outTrust,
                    "How probable it is that each pose of the trajectory was found right, CSV stamp,trust")
        ->type_name("FILE");
    command
        .add_option("--summary,--out", summary,
                    "The summary, or the points of --scan; standard output when not given")
        ->type_name("FILE");
    command.add_option("--svg", svg, "Also draw a picture of map and trajectory")
        ->check(pictureName())
        ->type_name("FILE");
}

void MapOptions::addWays(CLI::App &command) {
    command
        .add_option("--odometry", odometry,
                    "use: expect the motion that the log's odometry tells; ignore: expect "
                    "the motion to go on as before")
        ->check(CLI::IsMember({"use", "ignore"}))
        ->type_name("HOW")
        ->capture_default_str();
    command
        .add_option("--loops", loops,
                    "close: match scans of places that were met again and bring the whole drive into one "
                    "frame; leave: poses as they were tracked")
        ->check(CLI::IsMember({"close", "leave"}))
        ->type_name("HOW")
        ->capture_default_str();
    command.add_flag(
        "--corrected", source.corrected,
        "The log's scan poses are a corrected reference: odometry is taken from its ODOM lines only, and the "
        "summary tells the error against the reference");
    command
        .add_option("--sensor", sensor,
                    "Pose of the sensor on the robot of a CARMEN log: metres, radians (degrees as 90deg)")
        ->check(poseText(true))
        ->type_name("X,Y,THETA");
    command
        .add_option("--field-of-view", source.fieldOfView,
                    "Angle that a scan of a CARMEN log covers, degrees")
        ->check(between(1, 360))
        ->type_name("DEG");
    command
        .add_option("--max-range", source.maxRange, "No return of a CARMEN log from this range on, metres")
        ->check(between(0.01, 1000))
        ->type_name("M");
    command
        .add_option("--seconds-per-turn", source.secondsPerTurn,
                    "Time in which the scanner of a CARMEN log makes a full turn, below 0 for clockwise; 0: "
                    "each scan "
                    "is of one moment. Else the turns of the robot tell it")
        ->check(between(-10, 10))
        ->type_name("S");
    command.add_flag("--mirrored", source.mirrored,
                     "The angles of a CARMEN log count clockwise, as of a scanner that hangs upside down");
    command.add_option("--every", source.every, "Take every N-th scan only")
        ->transform(wholeNumber(1, 1e9))
        ->type_name("N")
        ->capture_default_str();
    command.add_flag("--skip-damaged", source.skipDamaged,
                     "Count damaged lines of a log and go on instead of stopping at the first");
    source.sensor.addTo(command);
    command.add_option("--sigma", sigma, "Largest standard deviation of points from their line, metres")
        ->check(aboveZero())
        ->type_name("M")
        ->capture_default_str();
    segment.addTo(command,
                  "defaults by the scanner: 10, 0.05, 0.20, 15 for a dense one, else 5, 0.10, 0.60, 4");
    command.add_flag("--force", force, "Overwrite files that exist");
}

} // namespace hermes::vector
