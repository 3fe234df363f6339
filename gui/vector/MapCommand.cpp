#include "common/progress/Progress.h"
#include "gui/vector/Failure.h"
#include "gui/vector/MapFiles.h"
#include "gui/vector/MapOptions.h"
#include "gui/vector/MapRun.h"
#include "vectorlib/io/CsvPoints.h"
#include "vectorlib/io/MapCsv.h"
#include "vectorlib/io/Number.h"
#include "vectorlib/io/Tum.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <sstream>

namespace hermes::vector {

namespace {

using Clock = std::chrono::steady_clock;

class MapCommand {
public:
    MapOptions options;

    void run() {
        options.segment.over({}); // contradictions come to light before any file is touched
        options.source.open = options.segment.open;
        if (!options.sensor.empty())
            options.source.mount = parsePose(options.sensor);
        openSession();
        if (options.onlyScan)
            writeScan();
        else if (options.localize.empty())
            build();
        else
            localize();
    }

private:
    /// A session, a file of one, or a bag.
    void openSession() {
        const std::string &path = options.source.path;
        std::error_code ignored;
        const bool isFolder = std::filesystem::is_directory(std::filesystem::u8path(path), ignored);
        const bool isBag = bag::isBag(path);
        if (!isFolder && !isBag)
            return;
        if (!isBag || (hasExtension(path, ".mcap") && isOwn(path))) {
            auto session = std::make_shared<RecordedSession>(path);
            if (!(isFolder && captureIn(path)) && session->scanTopics().first.empty())
                return;
            options.source.session = std::move(session);
        } else {
            options.source.bag = std::make_shared<BagDrive>(path);
            options.source.bag->choose(options.source.scanner);
        }
        if (options.source.session && !options.isSigmaGiven())
            options.sigma = options.source.session->sigma().value_or(options.sigma);
    }
    /// Whether hermes-recorder wrote it.
    static bool isOwn(const std::string &path) {
        const auto reader = valueOrFail(bag::open(path));
        const auto &topics = reader->topics();
        return std::any_of(topics.begin(), topics.end(), [](const bag::Topic &topic) {
            const std::string end = "/scan2d";
            return topic.serialization == "json" && topic.name.size() > end.size() &&
                   topic.name.compare(topic.name.size() - end.size(), end.size(), end) == 0;
        });
    }

    void build() {
        const auto begin = Clock::now();
        MapRun run;
        run.closesLoops = options.loops == "close";
        apply(run.tracker);

        OutputSet files(options.force);
        std::optional<MapFile> mapFile;
        if (!options.outMap.empty())
            mapFile.emplace(files, options.outMap);
        std::ostream *trajectoryFile = files.openIfNamed(options.outTrajectory);
        std::ostream *graphFile = files.openIfNamed(options.outGraph);
        std::ostream *trustFile = files.openIfNamed(options.outTrust);
        std::ostream *svgFile = files.openIfNamed(options.svg);
        std::ostream &summaryFile = files.open(options.summary);

        std::optional<MapProgress> progress(run.closesLoops);
        const MapSourceReport report =
            readMapScans(options.source, [&](MapScan &scan, std::size_t number, std::size_t total) {
                run.take(scan);
                progress->track(number + 1, total);
            });
        run.finish([&](const char *stage) { progress->begin(stage); },
                   [&](std::size_t done, std::size_t all) { progress->finish(done, all); });
        progress.reset();
        const vectorlib::MapDrawing drawing = {title(": map of ", run.trajectory().size()), run.segments(),
                                               run.trajectory(), run.reference()};
        if (mapFile)
            mapFile->write(drawing);
        if (graphFile)
            vectorlib::writeG2o(*graphFile, run.graph());
        if (trustFile)
            writeTrust(*trustFile, run);
        if (svgFile)
            drawMap(*svgFile, drawing);
        nlohmann::ordered_json json = run.summary();
        json["segments"] = drawing.segments.size();
        json["map_bytes"] = sizeAsCsv(drawing.segments);
        json.update(report.summary());
        report.warn(std::cerr);
        if (trajectoryFile)
            writeTrajectory(*trajectoryFile, run.trajectory(), json);
        if (drawing.segments.empty())
            std::cerr << "hermes-vector: " << options.source.path
                      << ": the map is empty: no scan showed a wall\n";
        warnOfLost(run.tracker.counts());
        json.update(tellContradictions(run.tracker, report.mount));
        run.warnOfBreaks(std::cerr);
        conclude(json, begin, summaryFile);
        files.commit();
    }

    /// The poses in a finished map.
    void localize() {
        const auto begin = Clock::now();
        const std::vector<vectorlib::MapEdge> map = loadMap(options.localize);
        LocalizeRun run(map, options.localize);
        apply(run.localizer);

        OutputSet files(options.force);
        std::ostream *trajectoryFile = files.openIfNamed(options.outTrajectory);
        std::ostream *svgFile = files.openIfNamed(options.svg);
        std::ostream &summaryFile = files.open(options.summary);
        Progress progress("finding, scan");
        const MapSourceReport report =
            readMapScans(options.source, [&](const MapScan &scan, std::size_t number, std::size_t total) {
                run.take(scan);
                if (total > 0) // a capture tells how far it is read
                    progress.update(double(number + 1), double(total));
            });
        report.warn(std::cerr);
        const nlohmann::ordered_json contradictions =
            tellContradictions(run.localizer.tracker, report.mount); // also where no place was found
        run.finish(options.source.path);
        nlohmann::ordered_json json = run.summary();
        json.update(contradictions);
        json.update(report.summary());
        const std::vector<vectorlib::StampedPose> trajectory = run.trajectory();
        if (svgFile)
            vectorlib::drawMap(*svgFile,
                               {title(": in a finished map, ", trajectory.size()), map, trajectory, {}});
        if (trajectoryFile)
            writeTrajectory(*trajectoryFile, trajectory, json);
        conclude(json, begin, summaryFile);
        files.commit();
    }

    /// One scan as a file of points instead of a map.
    void writeScan() const {
        OutputSet files(options.force);
        std::ostream &out = files.open(options.summary);
        const std::size_t wanted = *options.onlyScan;
        std::size_t scans = 0;
        const MapSourceReport report =
            readMapScans(options.source, [&](MapScan &scan, std::size_t number, std::size_t) {
                scans = number + 1;
                if (number == wanted)
                    vectorlib::writeCsvPoints(out, scan.points);
            });
        if (wanted >= scans)
            throw Failure(options.source.path + ": found " + std::to_string(scans) +
                          " scans, expected a scan " + std::to_string(wanted) + " (they count from 0)");
        report.warn(std::cerr);
        files.commit();
    }

    /// To a ScanTracker or a MapLocalizer.
    template <typename Tracker>
    void apply(Tracker &tracker) const {
        vectorlib::ScanTrackerSettings settings =
            options.source.session ? options.source.session->tracker() : vectorlib::ScanTrackerSettings();
        if (options.source.session && options.source.mount)
            settings.sensorOnRobot = *options.source.mount;
        if (options.source.bag)
            settings.sensorOnRobot = options.source.mount
                                         ? *options.source.mount
                                         : options.source.bag->scanner().mount.value_or(vectorlib::Pose2D());
        settings.useOdometry = options.odometry == "use";
        settings.seekWhereContradicted = false; // the parts of a log are joined later
        tracker.apply(settings);
        setUp(tracker);
    }
    void setUp(vectorlib::ScanTracker &tracker) const {
        tracker.segmentation = [this](const vectorlib::EarSettings &scanner) {
            return options.segment.over(scanner);
        };
        tracker.builder.extract.vectorize.settings.sigma = options.sigma;
    }
    void setUp(vectorlib::MapLocalizer &localizer) const { setUp(localizer.tracker); }
    static void conclude(nlohmann::ordered_json &json, Clock::time_point begin, std::ostream &summary) {
        json["seconds"] = std::chrono::duration<double>(Clock::now() - begin).count();
        summary << json.dump(2) << '\n';
    }
    static void warnOfLost(const vectorlib::ScanTrackerCounts &counts) {
        if (counts.lost * 20 > counts.scans)
            std::cerr
                << "hermes-vector: " << counts.lost << " of " << counts.scans
                << " scans were lost: what the map shows of them stands where they were expected, which may "
                   "be far off\n";
    }
    /// Where odometry and scans contradict each other: tells the option that mends it; the same for the
    /// summary.
    static nlohmann::ordered_json tellContradictions(const vectorlib::ScanTracker &tracker,
                                                     const vectorlib::Pose2D &mount) {
        nlohmann::ordered_json json = nlohmann::ordered_json::object();
        if (const auto times = tracker.counts().contradicted; times > 0) {
            json["contradicted"] = times;
            std::cerr
                << "hermes-vector: odometry and scans contradict each other " << times
                << " time(s): the sensor is mounted otherwise on the robot (--sensor), its angles count "
                   "clockwise (--mirrored), or the odometry is wrong (--odometry ignore)\n";
        }
        const auto turned = tracker.scanner().turned();
        if (tracker.scanner().isMirrored()) {
            json["mirrored"] = true;
            std::cerr << "hermes-vector: the scans turn the other way than the odometry: their angles count "
                         "clockwise (--mirrored)\n";
        } else if (turned) {
            json["sensor_turned_rad"] = *turned;
            std::cerr
                << "hermes-vector: the scans do not go where the odometry leads: the sensor is turned on "
                   "the robot (--sensor "
                << vectorlib::Number(mount.x) << ',' << vectorlib::Number(mount.y) << ','
                << std::lround(vectorlib::wrapAngle(mount.theta + *turned) * 180 / vectorlib::pi) << "deg)\n";
        }
        return json;
    }
    static void writeTrajectory(std::ostream &out, const std::vector<vectorlib::StampedPose> &trajectory,
                                nlohmann::ordered_json &json) {
        const vectorlib::StampMend mend = vectorlib::writeTum(out, trajectory);
        if (mend.moved == 0)
            return;
        std::cerr << "hermes-vector: moved " << mend.moved
                  << " stamp(s) of the trajectory so that they ascend, the farthest by "
                  << vectorlib::Fixed{mend.farthest, 6} << " s: those of the scans have " << mend.ties
                  << " tie(s) and " << mend.stepsBack << " step(s) back\n";
        json["moved_stamps"] = {{"stamps", mend.moved},
                                {"ties", mend.ties},
                                {"steps_back", mend.stepsBack},
                                {"farthest_s", mend.farthest}};
    }
    static void writeTrust(std::ostream &out, const MapRun &run) {
        out << "stamp,trust\n";
        for (std::size_t i = 0; i < run.trust().size(); ++i)
            out << vectorlib::Fixed{run.trajectory()[i].stamp, 6} << ',' << vectorlib::Number(run.trust()[i])
                << '\n';
    }
    std::string title(const char *what, std::size_t scans) const {
        return std::filesystem::u8path(options.source.path).filename().u8string() + what +
               std::to_string(scans) + " scans";
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
        "map",
        "Build the vector map of a CARMEN log, a bag of ROS, a capture or a folder of scans, or find the "
        "poses in a finished map (summary as JSON)");
    command->options.addTo(*sub);
    sub->callback([command, sub] {
        if (command->options.loops == "leave" && sub->count("--out-graph") > 0)
            throw CLI::ValidationError("--out-graph", "there is a graph only with --loops close");
        command->run();
    });
}

} // namespace hermes::vector
