#include "common/world/WorldFile.h"
#include "gui/vector/Failure.h"
#include "gui/vector/Input.h"
#include "gui/vector/InstalledWorlds.h"
#include "gui/vector/Options.h"
#include "gui/vector/Progress.h"
#include "gui/vector/experiment/Calibration.h"
#include "gui/vector/experiment/CriterionExperiment.h"
#include "gui/vector/experiment/GlobalPairsExperiment.h"
#include "gui/vector/experiment/Gnuplot.h"
#include "gui/vector/experiment/PlacesExperiment.h"
#include "gui/vector/experiment/QualityExperiment.h"
#include "gui/vector/experiment/RealScanExperiment.h"
#include "gui/vector/experiment/RegistrationExperiment.h"
#include "gui/vector/experiment/RelationAreas.h"
#include "gui/vector/experiment/RelationRun.h"
#include "gui/vector/experiment/RotationExperiment.h"
#include "gui/vector/experiment/SegmentationExperiment.h"
#include "gui/vector/experiment/VectorizationExperiment.h"
#include "gui/vector/experiment/WeightingTables.h"
#include "vectorlib/io/CarmenLog.h"

#include <filesystem>
#include <iostream>
#include <map>
#include <sstream>

namespace hermes::vector {

namespace {

struct ExperimentCommand {
    std::string name;
    std::string folder = ".";
    std::vector<std::string> logs;
    std::vector<std::size_t> every{1};
    std::string other;
    std::string worlds = installedWorlds().string();
    ExperimentOptions options;
    PairsOptions pairOptions;
    bool noGuess = false;
    std::size_t pictures = 0;
    bool force = false;

    void run();

    void segmentationRoom(OutputSet &files, std::ostream &csv) const { segment(files, csv, furnishedRoom()); }
    void segmentationObjects(OutputSet &files, std::ostream &csv) const {
        segment(files, csv, roomWithSmallObjects());
    }
    void semicircle(OutputSet &files, std::ostream &csv) const {
        const std::vector<ResultRow> rows = semicircleExperiment(options);
        writeCsv(csv, rows);
        std::map<double, std::vector<ResultRow>, std::greater<>> bySigma;
        for (const ResultRow &row : rows)
            bySigma[row.sigma].push_back(row);
        for (const auto &[sigma, some] : bySigma) {
            std::ostringstream text;
            text << "-sigma" << sigma;
            draw(files, {plotsOf("semicircle, sigma " + text.str().substr(6) + " m", some), {}, {}},
                 text.str());
        }
    }
    void edges(OutputSet &files, std::ostream &csv) const { scene(files, csv, solitaryEdges()); }
    void corners(OutputSet &files, std::ostream &csv) const { scene(files, csv, sharpCorners()); }
    void room(OutputSet &files, std::ostream &csv) const { scene(files, csv, furnishedRoom()); }
    void emptyRoom(OutputSet &files, std::ostream &csv) const {
        realScan(files, csv, RealScanKind::EmptyRoom);
    }
    void corridor(OutputSet &files, std::ostream &csv) const { realScan(files, csv, RealScanKind::Corridor); }
    void laboratory(OutputSet &files, std::ostream &csv) const {
        realScan(files, csv, RealScanKind::Laboratory);
    }
    void polygons(OutputSet &files, std::ostream &csv) const {
        quality(files, csv, "all polygons", polygonExperiment(options));
    }
    void ofLog(OutputSet &files, std::ostream &csv) const {
        quality(files, csv, "log", logExperiment(readLog().scans, options));
    }
    // The shares go to standard output, too; pictures are of pairs that are not near the reference.
    void pairs(OutputSet &files, std::ostream &csv) const {
        const vectorlib::CarmenLog read = readLog();
        if (noGuess)
            pairs(files, csv, read, globalPairsExperiment(read, pairOptions),
                  [](const GlobalPairResult &pair) { return pair.best(); });
        else
            pairs(files, csv, read, pairsExperiment(read, pairOptions),
                  [](const PairResult &pair) { return pair.match.pose; });
    }
    template <typename Result, typename Pose>
    void pairs(OutputSet &files, std::ostream &csv, const vectorlib::CarmenLog &read,
               const std::vector<Result> &results, Pose found) const {
        std::ostream &json = open(files, ".json");
        writeCsv(csv, results);
        const std::string summary = summaryOf(results).dump(2) + '\n';
        json << summary;
        std::cout << summary;
        std::size_t drawn = 0;
        for (const Result &pair : results)
            if (!pair.isWithin(found(pair), 0.10) && drawn++ < pictures)
                vector::draw(open(files, "-" + std::to_string(pair.from) + ".svg"), read, pair, found(pair));
    }
    void calibration(OutputSet &files, std::ostream &csv) const {
        if (logs.empty())
            readLog(); // tells what is missing
        std::vector<GlobalPairResult> results;
        for (std::size_t i = 0; i < logs.size(); ++i) {
            PairsOptions of = pairOptions;
            of.every = every[std::min(i, every.size() - 1)];
            for (GlobalPairResult &pair : globalPairsExperiment(readLog(logs[i]), of))
                results.push_back(std::move(pair));
        }
        const Calibration found = calibrationOf(results);
        writeCsv(csv, found);
        std::cout << summaryOf(found).dump(2) << '\n';
        draw(files, {{plotOf(found)}, {}, {}});
    }
    void places(OutputSet &files, std::ostream &csv) const {
        const vectorlib::CarmenLog read = readLog();
        std::optional<vectorlib::CarmenLog> strange;
        if (!other.empty())
            strange = readLog(other);
        std::ostream &json = open(files, ".json");
        const PlacesReport report = placesExperiment(read, strange ? &*strange : nullptr, options.progress);
        writeCsv(csv, report);
        const std::string summary = summaryOf(report, !strange).dump(2) + '\n';
        json << summary;
        std::cout << summary;
    }
    void criterion(OutputSet &files, std::ostream &csv) const {
        const std::vector<Surface> surfaces = criterionSurfaces();
        writeCsv(csv, surfaces);
        draw(files, {{}, surfaces, {}});
    }
    void criterionTime(OutputSet &files, std::ostream &csv) const {
        const std::vector<CriterionTime> times = criterionTimes(options);
        writeCsv(csv, times);
        draw(files, {plotsOf(times), {}, {}});
    }
    void accuracy(OutputSet &files, std::ostream &csv) const {
        const auto rows = registrationExperiment(world("cutsquare"), {manyPoints, sigmas, 0}, options);
        writeCsv(csv, rows);
        draw(files, {accuracyPlots(rows), {}, {}});
    }
    void dispersion(OutputSet &files, std::ostream &csv) const {
        const World square = world("cutsquare"), pillars = world("pillars");
        const auto rows = registrationExperiment(square, {{100, 300, 1000}, sigmas, 0}, options);
        const auto hard = registrationExperiment(pillars, {{300}, {0.05}, 0}, options);
        std::vector<RegistrationRow> all = rows;
        all.insert(all.end(), hard.begin(), hard.end());
        writeCsv(csv, all);
        constexpr double scale = 5; // of the ellipses
        Figures figures;
        for (const auto &[panel, points, sigma] : {std::tuple{"a", 100, 0.1},
                                                   {"b", 300, 0.1},
                                                   {"c", 1000, 0.1},
                                                   {"d", 300, 0.03},
                                                   {"e", 300, 0.01}})
            figures.plots.push_back(dispersionPlot(square, select(rows, points, sigma, false), panel, scale));
        figures.plots.push_back(dispersionPlot(pillars, select(hard, 300, 0.05, false), "f", scale));
        figures.plots.push_back(dispersionPlot(pillars, select(hard, 300, 0.05, true), "f-weighted", scale));
        draw(files, figures);
    }
    void weighting(OutputSet &files, std::ostream &csv) const {
        std::vector<RegistrationRow> rows;
        for (const char *place : {"cutsquare", "oblique", "pillars"}) {
            const auto some = registrationExperiment(world(place), {manyPoints, sigmas, 0}, options);
            rows.insert(rows.end(), some.begin(), some.end());
        }
        writeCsv(csv, rows);
        const std::vector<WeightingRow> tables = weightingRows(rows);
        writeCsv(open(files, "-tables.csv"), tables);
        draw(files, {weightingPlots(rows), {}, weightingTables(tables)});
    }
    void reliability(OutputSet &files, std::ostream &csv) const {
        // Every pose sees two walls that are longer, but noise may cut one of them below it.
        constexpr double shortest = 2;
        const World pillars = world("pillars");
        const auto rows = registrationExperiment(pillars, {{300}, {0.1}, shortest}, options);
        writeCsv(csv, rows);
        draw(files, {{reliabilityPlot(pillars, select(rows, 300, 0.1, true))}, {}, {}});
    }
    void rotation(OutputSet &files, std::ostream &csv) const {
        const std::vector<RotationRow> rows = rotationExperiment(options);
        writeCsv(csv, rows);
        draw(files, {{plotOf(rows)}, {}, {}});
    }

    void freeHome(OutputSet &files, std::ostream &csv) const {
        relation(files, csv, homeScans(3069), HalfTurnScanner::rays, vectorlib::pi,
                 {{"scans", 3069}, {"length_m", 43.19}, {"mean_us", 3480}});
    }
    void freeLeaps(OutputSet &files, std::ostream &csv) const {
        relation(files, csv, homeScans(23), HalfTurnScanner::rays, vectorlib::pi,
                 {{"scans", 23}, {"length_m", 43.19}});
    }
    void freeLog(OutputSet &files, std::ostream &csv) const {
        const vectorlib::CarmenLog read = readLog();
        std::vector<PosedScan> scans;
        for (std::size_t i = 0; i < read.scans.size(); i += pairOptions.every) {
            scans.push_back({{}, read.scans[i].laserPose});
            read.scans[i].appendPoints(scans.back().points);
        }
        if (scans.empty())
            throw Failure(logs[0] + ": found no scan");
        const vectorlib::CarmenScan &scan = read.scans.front();
        relation(files, csv, scans, scan.ranges.size(), scan.angleStep * double(scan.ranges.size()),
                 {{"last_error_x_m", 0.0784}, {"last_error_y_m", -0.0066}, {"last_error_deg", 2.12}});
    }
    void freeCopy(OutputSet &files, std::ostream &csv) const {
        const std::vector<InjectedError> rows = injectedErrors(world("home"), options.seed);
        writeCsv(csv, rows);
        draw(files, {plotsOf(rows), {}, {}});
    }
    void freeApproach(OutputSet &files, std::ostream &csv) const {
        const ApproachResult result =
            approach(world("corner"), options.seed, pairOptions.every, options.progress);
        writeCsv(csv, result);
        tell(files, summaryOf(result));
        draw(files, {plotsOf(result), {}, {}});
    }

private:
    std::vector<PosedScan> homeScans(std::size_t count) const {
        const World home = world("home");
        return scansAt(home, posesAlong(home, count), options.seed);
    }
    void relation(OutputSet &files, std::ostream &csv, const std::vector<PosedScan> &scans, std::size_t rays,
                  double fieldOfView, const nlohmann::ordered_json &published) const {
        const RelationRun run = relationRun(scans, {fieldOfView, rays, options.progress});
        writeCsv(csv, run);
        tell(files, summaryOf(run, published));
        draw(files, {plotsOf(run), {}, {}});
    }
    // Figures for people: on standard output and beside the table.
    void tell(OutputSet &files, const nlohmann::ordered_json &summary) const {
        const std::string text = summary.dump(2) + '\n';
        open(files, ".json") << text;
        std::cout << text;
    }
    // Paper 4: 100 ... 3000 points, noise of 1, 3 and 10 cm.
    const std::vector<int> manyPoints{100, 200, 300, 500, 1000, 2000, 3000};
    const std::vector<double> sigmas{0.01, 0.03, 0.1};

    std::ostream &open(OutputSet &files, const std::string &suffix) const {
        return files.open((std::filesystem::path(folder) / (name + suffix)).string());
    }
    World world(const std::string &place) const {
        Outcome<World> found = readWorld((std::filesystem::path(worlds) / (place + ".json")).string());
        if (!found)
            throw Failure(found.error() + "; --worlds names the folder of the worlds");
        found->name = place; // whatever it calls itself: the name goes into scripts and documents
        return *found;
    }
    static std::vector<RegistrationRow> select(const std::vector<RegistrationRow> &rows, int points,
                                               double sigma, bool weighted) {
        std::vector<RegistrationRow> some;
        for (const RegistrationRow &row : rows)
            if (row.points == points && row.sigma == sigma && row.weighted == weighted)
                some.push_back(row);
        return some;
    }
    void segment(OutputSet &files, std::ostream &csv, const Scene &scene) const {
        const std::vector<SegmentationPanel> panels = segmentationExperiment(scene, options.seed);
        writeCsv(csv, panels);
        for (const SegmentationPanel &panel : panels)
            vector::draw(open(files, "-" + std::to_string(std::lround(100 * panel.noise)) + "cm-" +
                                         std::to_string(std::lround(100 * panel.outlierShare)) +
                                         "percent.svg"),
                         scene, panel);
    }
    void quality(OutputSet &files, std::ostream &csv, const std::string &title,
                 const std::vector<QualityRow> &rows) const {
        writeCsv(csv, rows);
        draw(files, {plotsOf(title, rows), {}, {}});
    }
    void realScan(OutputSet &files, std::ostream &csv, RealScanKind kind) const {
        const RealScanResult result = realScanExperiment(readLog().scans, kind);
        if (result.points == 0)
            throw Failure(logs[0] + ": no scan has returns on half of its rays");
        writeCsv(csv, result);
        writeLatex(open(files, ".tex"), name, result);
        vector::draw(open(files, ".svg"), name, result);
    }
    vectorlib::CarmenLog readLog() const {
        if (logs.size() != 1)
            throw CLI::ValidationError("--log", "the experiment " + name + " needs the name of a CARMEN log");
        return readLog(logs[0]);
    }
    static vectorlib::CarmenLog readLog(const std::string &file) {
        Input input(file);
        return valueOrFail(vectorlib::readCarmenLog(input.stream(), input.name()));
    }
    void scene(OutputSet &files, std::ostream &csv, const Scene &scene) const {
        const std::vector<ResultRow> rows = sceneExperiment(scene, options);
        writeCsv(csv, rows);
        draw(files, {plotsOf(scene.title, rows), {}, {}});
    }
    void draw(OutputSet &files, const Figures &figures, const std::string &suffix = "") const {
        writeLatex(open(files, suffix + ".tex"), name, figures);
        bool drawn = true;
        for (const Plot &plot : figures.plots)
            drawn = drawn && draw(files, suffix, plot);
        for (const Surface &surface : figures.surfaces)
            drawn = drawn && draw(files, suffix, surface);
        if (!drawn)
            std::cerr
                << "hermes-vector: gnuplot is not installed: no pictures beside the CSV and LaTeX files\n";
    }
    template <typename Figure>
    bool draw(OutputSet &files, const std::string &suffix, const Figure &figure) const {
        std::ostringstream script;
        writeGnuplot(script, figure);
        const std::optional<std::string> svg = runGnuplot(script.str());
        if (svg)
            open(files, suffix + "-" + figure.name + ".svg") << *svg;
        return svg.has_value();
    }
};

struct Experiment {
    const char *name;
    const char *what;
    void (ExperimentCommand::*run)(OutputSet &, std::ostream &csv) const;
};

constexpr Experiment experiments[] = {
    {"segmentation-room", "figure 5.6: a room, by noise and outliers", &ExperimentCommand::segmentationRoom},
    {"segmentation-objects", "figure 5.7: the same with small objects",
     &ExperimentCommand::segmentationObjects},
    {"semicircle", "figure 6.7: time by the number of lines", &ExperimentCommand::semicircle},
    {"edges", "figure 6.8: four solitary edges", &ExperimentCommand::edges},
    {"corners", "figure 6.9: one cluster with sharp corners", &ExperimentCommand::corners},
    {"room", "figure 6.10: a furnished room", &ExperimentCommand::room},
    {"empty-room", "figure 6.11: the scan of --log with long lines all around",
     &ExperimentCommand::emptyRoom},
    {"corridor", "figure 6.12: the scan of --log with long lines in one direction",
     &ExperimentCommand::corridor},
    {"laboratory", "figure 6.13: the scan of --log with the most lines", &ExperimentCommand::laboratory},
    {"polygons", "closed polygons: error by the number of vertices", &ExperimentCommand::polygons},
    {"log", "the scans of --log: error by the number of vertices", &ExperimentCommand::ofLog},
    {"pairs", "the motions between scans of --log: error against its corrected poses",
     &ExperimentCommand::pairs},
    {"calibration", "matches without estimate in all pairs of --log ...: probability told, and share right",
     &ExperimentCommand::calibration},
    {"places", "scans of --log searched in a map of every other scan: how often their place is found",
     &ExperimentCommand::places},
    {"criterion", "figures 7.3 to 7.6: the criterion of two segments", &ExperimentCommand::criterion},
    {"criterion-time", "figures 7.7 to 7.9: its time, pair by pair and from sums",
     &ExperimentCommand::criterionTime},
    {"accuracy", "paper figure 6: error and ambiguity of registration", &ExperimentCommand::accuracy},
    {"dispersion", "paper figures 7 and 8: scatter at every pose", &ExperimentCommand::dispersion},
    {"weighting", "paper tables 1 and 2: what weights gain, what ambiguity tells",
     &ExperimentCommand::weighting},
    {"reliability", "paper figure 9: reliability at every pose", &ExperimentCommand::reliability},
    {"rotation", "paper figure 10: Mitsuta's and Wahba's mean rotation", &ExperimentCommand::rotation},
    {"free-home", "pose-free thesis 6.2, 6.3, 6.11: 3,069 scans of a home", &ExperimentCommand::freeHome},
    {"free-leaps", "pose-free thesis 6.4, 6.5, 6.11: 23 scans of the same way",
     &ExperimentCommand::freeLeaps},
    {"free-copy", "pose-free thesis 6.7, 6.8: a scan on its copy", &ExperimentCommand::freeCopy},
    {"free-approach", "pose-free thesis 6.9, 6.10: straight to where walls meet",
     &ExperimentCommand::freeApproach},
    {"free-log", "pose-free thesis 6.12, 6.13: the scans of --log", &ExperimentCommand::freeLog}};

void ExperimentCommand::run() {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        throw Failure(folder + ": cannot be made: " + error.message());
    Progress progress("run");
    options.progress = [&](std::size_t done, std::size_t all) { progress.update(done, all); };
    pairOptions.progress = options.progress;
    pairOptions.every = every[0];
    OutputSet files(force);
    std::ostream &csv = open(files, ".csv"); // first: that it exists is told before the work is done
    for (const Experiment &experiment : experiments)
        if (name == experiment.name)
            (this->*experiment.run)(files, csv);
    files.commit();
}

} // namespace

void addExperimentCommand(CLI::App &app) {
    auto command = std::make_shared<ExperimentCommand>();
    CLI::App *sub = app.add_subcommand(
        "experiment",
        "Regenerate an experiment of the thesis or of the registration paper as CSV, SVG and LaTeX");
    std::string list = "Which one:";
    std::vector<std::string> names;
    for (const Experiment &e : experiments) {
        names.emplace_back(e.name);
        list += std::string("\n  ") + e.name + ": " + e.what;
    }
    sub->add_option("NAME", command->name, list)->required()->check(CLI::IsMember(names));
    sub->add_option("--out", command->folder, "Folder for the files; made when missing")
        ->type_name("FOLDER")
        ->capture_default_str();
    sub->add_option(
           "--log", command->logs,
           "CARMEN log for log, pairs, places, free-log, empty-room, corridor and laboratory; several for "
           "calibration")
        ->allow_extra_args(false)
        ->type_name("FILE");
    sub->add_option(
           "--other", command->other,
           "places: search the scans of this CARMEN log of another building, which are to be refused")
        ->type_name("FILE");
    sub->add_option(
           "--every", command->every,
           "pairs, calibration, free-log, free-approach: only every N-th scan, and its next N-th one; of "
           "several logs the first N for the first, the last for all that follow")
        ->allow_extra_args(false)
        ->check(between(1, 1e9))
        ->type_name("N")
        ->capture_default_str();
    sub->add_option("--first", command->pairOptions.first, "pairs: only the first N pairs")
        ->check(between(1, 1e9))
        ->type_name("N");
    sub->add_flag("--no-guess", command->noGuess,
                  "pairs: match by the two scans alone, without odometry or any other estimate");
    sub->add_option("--half", command->pairOptions.half,
                    "pairs: only the first or the second half, blocks of 50 pairs in turn: to choose "
                    "parameters on one and judge them on the other")
        ->transform(CLI::CheckedTransformer(
            std::map<std::string, PairHalf>{{"1", PairHalf::First}, {"2", PairHalf::Second}}))
        ->type_name("1|2");
    sub->add_option("--draw", command->pictures,
                    "pairs: draw the first N pairs that are not within 10 cm and 2 degrees")
        ->check(between(0, 10000))
        ->type_name("N")
        ->capture_default_str();
    sub->add_option(
           "--worlds", command->worlds,
           "Folder of cutsquare.json, oblique.json, pillars.json, home.json and corner.json instead of "
           "those installed with the program")
        ->type_name("FOLDER");
    sub->add_option("--runs", command->options.runs, "Scans for each number of points (and each pose)")
        ->check(between(1, 10000))
        ->type_name("N")
        ->capture_default_str();
    sub->add_option("--max-points", command->options.maxPoints, "Leave out larger clouds")
        ->check(between(20, 1e6))
        ->type_name("N")
        ->capture_default_str();
    sub->add_option("--seed", command->options.seed, "Of the noise; the same seed gives the same scans")
        ->type_name("I")
        ->capture_default_str();
    sub->add_flag("--force", command->force, "Overwrite files that exist");
    sub->footer(example("hermes-vector experiment corners --out results"));
    sub->callback([command] { command->run(); });
}

} // namespace hermes::vector
