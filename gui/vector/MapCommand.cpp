#include "gui/vector/Failure.h"
#include "gui/vector/MapFiles.h"
#include "gui/vector/MapRun.h"
#include "gui/vector/Options.h"
#include "gui/vector/Progress.h"
#include "vectorlib/io/CsvPoints.h"
#include "vectorlib/io/G2o.h"
#include "vectorlib/io/MapCsv.h"

#include <chrono>
#include <filesystem>
#include <iostream>
#include <sstream>

namespace hermes::vector {

namespace {

struct MapCommand {
    MapSourceOptions source;
    std::string odometry = "use";
    std::string outMap;
    std::string outTrajectory;
    std::string outGraph;
    std::string loops = "close";
    std::string summary;
    std::string svg;
    std::optional<std::size_t> onlyScan;
    bool force = false;
    SegmentOptions segment;
    double sigma = vectorlib::VectorizerSettings().sigma;

    void run() {
        const auto begin = std::chrono::steady_clock::now();
        MapRun run;
        vectorlib::ScanTrackerSettings settings;
        settings.useOdometry = odometry == "use";
        run.closesLoops = loops == "close";
        run.tracker.apply(settings);
        segment.over({}); // contradictions come to light before any file is touched
        run.tracker.segmentation = [this](const vectorlib::EarSettings &scanner) {
            return segment.over(scanner);
        };
        run.tracker.builder.extract.vectorize.settings.sigma = sigma;
        source.open = segment.open;

        OutputSet files(force);
        std::optional<MapFile> mapFile;
        if (!outMap.empty())
            mapFile.emplace(files, outMap);
        std::ostream *trajectoryFile = outTrajectory.empty() ? nullptr : &files.open(outTrajectory);
        std::ostream *graphFile = outGraph.empty() ? nullptr : &files.open(outGraph);
        std::ostream *svgFile = svg.empty() ? nullptr : &files.open(svg);
        std::ostream &summaryFile = files.open(summary);

        const MapSourceReport report = readScans(run);
        const vectorlib::MapDrawing drawing = {title(run), run.segments(), run.trajectory(), run.reference()};
        if (mapFile)
            mapFile->write(drawing);
        vectorlib::StampMend mend;
        if (trajectoryFile)
            mend = vectorlib::writeTum(*trajectoryFile, run.trajectory());
        if (graphFile)
            vectorlib::writeG2o(*graphFile, run.graph());
        if (svgFile)
            drawMap(*svgFile, drawing);

        nlohmann::ordered_json json = run.summary();
        json["segments"] = drawing.segments.size();
        json["map_bytes"] = sizeAsCsv(drawing.segments);
        if (report.damagedLines > 0) {
            json["damaged_lines"] = report.damagedLines;
            std::cerr << "hermes-vector: left out " << report.damagedLines
                      << " damaged line(s), the first: " << report.firstDamage << '\n';
        }
        if (mend.moved > 0)
            json["moved_stamps"] = tell(mend);
        if (!report.otherSensors.empty())
            std::cerr << "hermes-vector: " << report.otherSensors << '\n';
        warnOfLost(run.tracker.counts());
        json["seconds"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        summaryFile << json.dump(2) << '\n';
        files.commit();
    }

    /// One scan as a file of points instead of a map.
    void writeScan() const {
        OutputSet files(force);
        std::ostream &out = files.open(summary);
        std::size_t scans = 0;
        const MapSourceReport report =
            readMapScans(source, [&](MapScan &scan, std::size_t number, std::size_t) {
                scans = number + 1;
                if (number == *onlyScan)
                    vectorlib::writeCsvPoints(out, scan.points);
            });
        if (*onlyScan >= scans)
            throw Failure(source.path + ": found " + std::to_string(scans) + " scans, expected a scan " +
                          std::to_string(*onlyScan) + " (they count from 0)");
        if (!report.otherSensors.empty())
            std::cerr << "hermes-vector: " << report.otherSensors << '\n';
        files.commit();
    }

    MapSourceReport readScans(MapRun &run) const {
        MapSourceReport report;
        {
            Progress progress("scan");
            report = readMapScans(source, [&](MapScan &scan, std::size_t number, std::size_t total) {
                run.take(scan);
                progress.update(number + 1, total);
            });
        }
        run.finish();
        return report;
    }
    static void warnOfLost(const vectorlib::ScanTrackerCounts &counts) {
        if (counts.lost * 20 > counts.scans)
            std::cerr
                << "hermes-vector: " << counts.lost << " of " << counts.scans
                << " scans were lost: what the map shows of them stands where they were expected, which may "
                   "be far off\n";
    }
    static nlohmann::ordered_json tell(const vectorlib::StampMend &mend) {
        std::cerr << "hermes-vector: moved " << mend.moved
                  << " stamp(s) of the trajectory so that they ascend, the farthest by "
                  << vectorlib::Fixed{mend.farthest, 6} << " s: those of the scans have " << mend.ties
                  << " tie(s) and " << mend.stepsBack << " step(s) back\n";
        return {{"stamps", mend.moved},
                {"ties", mend.ties},
                {"steps_back", mend.stepsBack},
                {"farthest_s", mend.farthest}};
    }
    std::string title(const MapRun &run) const {
        return std::filesystem::path(source.path).filename().string() + ": map of " +
               std::to_string(run.trajectory().size()) + " scans";
    }
    static std::size_t sizeAsCsv(const std::vector<vectorlib::MapEdge> &segments) {
        std::ostringstream text;
        vectorlib::writeMapCsv(text, segments);
        return text.str().size();
    }
};

} // namespace

void addMapCommand(CLI::App &app) {
    auto command = std::make_shared<MapCommand>();
    CLI::App *sub = app.add_subcommand(
        "map", "Build the vector map of a CARMEN log, a capture or a folder of scans (summary as "
               "JSON)");
    sub->add_option("LOG", command->source.path,
                    "CARMEN log, pcap of an " + velodyne::sensorNames() +
                        ", or a folder of points files taken in name order")
        ->required();
    CLI::Option *scan =
        sub->add_option(
               "--scan", command->onlyScan,
               "Build no map: write the points of scan N, from 0, as CSV x,y in its sensor's frame, for "
               "the commands that take one scan")
            ->transform(wholeNumber(0, 1e9))
            ->type_name("N");
    sub->add_option("--out-map", command->outMap,
                    "The map; its kind follows from the extension: csv, svg, geojson, dxf, pgm")
        ->check(CLI::Validator(
            [](const std::string &path) {
                return MapFile::isKnown(path) ? std::string()
                                              : "found " + path +
                                                    ", expected a name that ends with .csv, .svg, .geojson, "
                                                    ".dxf or .pgm";
            },
            ""))
        ->type_name("FILE");
    sub->add_option("--out-trajectory", command->outTrajectory,
                    "The sensor's poses, TUM format: stamp x y z qx qy qz qw; a stamp that is not later than "
                    "the one before is moved to a microsecond behind it")
        ->type_name("FILE");
    CLI::Option *graph = sub->add_option("--out-graph", command->outGraph,
                                         "The poses and the motions measured between them, g2o format")
                             ->type_name("FILE");
    sub->add_option("--summary,--out", command->summary,
                    "The summary, or the points of --scan; standard output when not given")
        ->type_name("FILE");
    sub->add_option("--svg", command->svg, "Also draw a picture of map and trajectory")->type_name("FILE");
    sub->add_option("--odometry", command->odometry,
                    "use: expect the motion that the log's odometry tells; ignore: expect "
                    "the motion to go on as before")
        ->check(CLI::IsMember({"use", "ignore"}))
        ->type_name("HOW")
        ->capture_default_str();
    sub->add_option(
           "--loops", command->loops,
           "close: match scans of places that were met again and bring the whole drive into one frame; "
           "leave: poses as they were tracked")
        ->check(CLI::IsMember({"close", "leave"}))
        ->type_name("HOW")
        ->capture_default_str();
    sub->add_flag(
        "--corrected", command->source.corrected,
        "The log's scan poses are a corrected reference: odometry is taken from its ODOM lines only, and the "
        "summary tells the error against the reference");
    sub->add_option("--every", command->source.every, "Take every N-th scan only")
        ->transform(wholeNumber(1, 1e9))
        ->type_name("N")
        ->capture_default_str();
    sub->add_flag("--skip-damaged", command->source.skipDamaged,
                  "Count damaged lines of a log and go on instead of stopping at the first");
    command->source.sensor.addTo(*sub);
    sub->add_option("--sigma", command->sigma, "Largest standard deviation of points from their line, metres")
        ->check(aboveZero())
        ->type_name("M")
        ->capture_default_str();
    command->segment.addTo(
        *sub, "defaults by the scanner: 10, 0.05, 0.20, 15 for a dense one, else 5, 0.10, 0.60, 4");
    sub->add_flag("--force", command->force, "Overwrite files that exist");
    sub->footer(
        example("hermes-vector map intel.log.gz --corrected --out-map intel.svg --out-trajectory intel.tum"));
    for (const char *ofMap : {"--out-map", "--out-trajectory", "--out-graph", "--svg", "--odometry",
                              "--loops", "--corrected", "--every"})
        scan->excludes(sub->get_option(ofMap));
    sub->callback([command, graph] {
        if (command->loops == "leave" && graph->count() > 0)
            throw CLI::ValidationError("--out-graph", "there is a graph only with --loops close");
        command->onlyScan ? command->writeScan() : command->run();
    });
}

} // namespace hermes::vector
