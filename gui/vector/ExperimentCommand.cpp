#include "gui/vector/Failure.h"
#include "gui/vector/Input.h"
#include "gui/vector/Options.h"
#include "gui/vector/Progress.h"
#include "gui/vector/experiment/Gnuplot.h"
#include "gui/vector/experiment/PairsExperiment.h"
#include "gui/vector/experiment/QualityExperiment.h"
#include "gui/vector/experiment/SegmentationExperiment.h"
#include "gui/vector/experiment/VectorizationExperiment.h"
#include "vectorlib/io/CarmenLog.h"

#include <filesystem>
#include <iostream>
#include <map>
#include <sstream>

namespace hermes {

namespace {

const std::map<std::string, std::string> experiments = {
    {"segmentation-room", "figure 5.6: a room, by noise and outliers"},
    {"segmentation-objects", "figure 5.7: the same with small objects"},
    {"semicircle", "figure 6.7: time by the number of lines"},
    {"edges", "figure 6.8: four solitary edges"},
    {"corners", "figure 6.9: one cluster with sharp corners"},
    {"room", "figure 6.10: a furnished room"},
    {"polygons", "closed polygons: error by the number of vertices"},
    {"log", "the scans of --log: error by the number of vertices"},
    {"pairs", "the motions between scans of --log: error against its corrected poses"}};

struct ExperimentCommand {
    std::string name;
    std::string folder = ".";
    std::string log;
    ExperimentOptions options;
    PairsOptions pairOptions;
    std::size_t pictures = 0;
    bool force = false;

    void run() {
        std::error_code error;
        std::filesystem::create_directories(folder, error);
        if (error)
            throw Failure(folder + ": cannot be made: " + error.message());
        Progress progress("run");
        options.progress = [&](std::size_t done, std::size_t all) { progress.update(done, all); };
        pairOptions.progress = options.progress;
        OutputSet files(force);
        if (name == "segmentation-room")
            segment(files, furnishedRoom());
        else if (name == "segmentation-objects")
            segment(files, roomWithSmallObjects());
        else if (name == "semicircle")
            semicircle(files);
        else if (name == "polygons" || name == "log")
            quality(files);
        else if (name == "pairs")
            pairs(files);
        else
            scene(files, name == "edges"     ? solitaryEdges()
                         : name == "corners" ? sharpCorners()
                                             : furnishedRoom());
        files.commit();
    }

private:
    std::ostream &open(OutputSet &files, const std::string &suffix) const {
        return files.open((std::filesystem::path(folder) / (name + suffix)).string());
    }
    void segment(OutputSet &files, const Scene &scene) const {
        std::ostream &csv = open(files, ".csv");
        const std::vector<SegmentationPanel> panels = segmentationExperiment(scene, options.seed);
        writeCsv(csv, panels);
        for (const SegmentationPanel &panel : panels)
            hermes::draw(open(files, "-" + std::to_string(std::lround(100 * panel.noise)) + "cm-" +
                                         std::to_string(std::lround(100 * panel.outlierShare)) +
                                         "percent.svg"),
                         scene, panel);
    }
    void semicircle(OutputSet &files) const {
        std::ostream &csv = open(files, ".csv");
        const std::vector<ResultRow> rows = semicircleExperiment(options);
        writeCsv(csv, rows);
        std::map<double, std::vector<ResultRow>, std::greater<>> bySigma;
        for (const ResultRow &row : rows)
            bySigma[row.sigma].push_back(row);
        for (const auto &[sigma, some] : bySigma) {
            std::ostringstream text;
            text << "-sigma" << sigma;
            draw(files, text.str(), plotsOf("semicircle, sigma " + text.str().substr(6) + " m", some));
        }
    }
    void quality(OutputSet &files) const {
        std::ostream &csv = open(files, ".csv");
        const std::vector<QualityRow> rows =
            name == "polygons" ? polygonExperiment(options) : logExperiment(readLog().scans, options);
        writeCsv(csv, rows);
        draw(files, "", plotsOf(rows));
    }
    // The shares go to standard output, too; pictures are of pairs that are not near the reference.
    void pairs(OutputSet &files) const {
        const vectorlib::CarmenLog read = readLog();
        std::ostream &csv = open(files, ".csv"), &json = open(files, ".json");
        const std::vector<PairResult> results = pairsExperiment(read, pairOptions);
        writeCsv(csv, results);
        const std::string summary = summaryOf(results).dump(2) + '\n';
        json << summary;
        std::cout << summary;
        std::size_t drawn = 0;
        for (const PairResult &pair : results)
            if (!pair.isWithin(pair.match.pose, 0.10) && drawn++ < pictures)
                hermes::draw(open(files, "-" + std::to_string(pair.from) + ".svg"), read, pair);
    }
    vectorlib::CarmenLog readLog() const {
        if (log.empty())
            throw CLI::ValidationError("--log", "the experiment " + name + " needs the name of a CARMEN log");
        Input input(log);
        return valueOrFail(vectorlib::readCarmenLog(input.stream(), input.name()));
    }
    void scene(OutputSet &files, const Scene &scene) const {
        std::ostream &csv = open(files, ".csv");
        const std::vector<ResultRow> rows = sceneExperiment(scene, options);
        writeCsv(csv, rows);
        draw(files, "", plotsOf(scene.title, rows));
    }
    void draw(OutputSet &files, const std::string &suffix, const std::vector<Plot> &plots) const {
        writeLatex(open(files, suffix + ".tex"), name, plots);
        for (const Plot &plot : plots) {
            std::ostringstream script;
            writeGnuplot(script, plot);
            const std::optional<std::string> svg = runGnuplot(script.str());
            if (!svg) {
                std::cerr << "hermes-vector: gnuplot is not installed: no pictures beside the CSV and LaTeX "
                             "files\n";
                return;
            }
            open(files, suffix + "-" + plot.name + ".svg") << *svg;
        }
    }
};

} // namespace

void addExperimentCommand(CLI::App &app) {
    auto command = std::make_shared<ExperimentCommand>();
    CLI::App *sub =
        app.add_subcommand("experiment", "Regenerate an experiment of the thesis as CSV, SVG and LaTeX");
    std::string list = "Which one:";
    std::vector<std::string> names;
    for (const auto &[name, what] : experiments) {
        names.push_back(name);
        list += "\n  " + name + ": " + what;
    }
    sub->add_option("NAME", command->name, list)->required()->check(CLI::IsMember(names));
    sub->add_option("--out", command->folder, "Folder for the files; made when missing")
        ->type_name("FOLDER")
        ->capture_default_str();
    sub->add_option("--log", command->log, "CARMEN log for the experiments log and pairs")->type_name("FILE");
    sub->add_option("--every", command->pairOptions.every,
                    "pairs: match every N-th scan with the next N-th one")
        ->check(between(1, 1e9))
        ->type_name("N")
        ->capture_default_str();
    sub->add_option("--first", command->pairOptions.first, "pairs: only the first N pairs")
        ->check(between(1, 1e9))
        ->type_name("N");
    sub->add_option("--draw", command->pictures,
                    "pairs: draw the first N pairs that are not within 10 cm and 2 degrees")
        ->check(between(0, 10000))
        ->type_name("N")
        ->capture_default_str();
    sub->add_option("--runs", command->options.runs, "Scans for each number of points")
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

} // namespace hermes
