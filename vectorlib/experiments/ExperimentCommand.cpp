#include "vectorlib/experiments/ExperimentCommand.h"

#include "common/progress/Progress.h"
#include "gui/vector/Options.h"
#include "vectorlib/experiments/Commands.h"

#include <algorithm>

namespace hermes::experiments {

using vector::addOption;
using vector::between;
using vector::example;
using vector::wholeNumber;

namespace {

struct Experiment {
    const char *name;
    const char *what;
    void (ExperimentCommand::*run)(OutputSet &, std::ostream &csv) const;
    const char *takes; ///< options, beside those that all take
    int runs = 20;     ///< without --runs
};

constexpr const char *ofScenes = "--runs --max-points --seed --noise";
constexpr const char *ofScans = "--log --port --sender"; // which may lie in a capture
constexpr const char *ofWorlds = "--worlds --runs --max-points --seed --known-edges";
constexpr int published = 100; // runs of the registration paper

constexpr Experiment experiments[] = {
    {"segmentation-room", "figure 5.6: a room, by noise and outliers",
     &ExperimentCommand::segmentation<furnishedRoom>, "--seed"},
    {"segmentation-objects", "figure 5.7: the same with small objects",
     &ExperimentCommand::segmentation<roomWithSmallObjects>, "--seed"},
    {"adaptive-threshold", "figures 5.3, 5.4: the threshold without and with its bounds",
     &ExperimentCommand::adaptiveThreshold, "--seed"},
    {"real-segmentation", "figure 5.5: three scans of --log, clusters in colours",
     &ExperimentCommand::realSegmentation, ofScans},
    {"threshold", "figures 6.1 to 6.3: error by points, of a precise corner and of one with noise",
     &ExperimentCommand::threshold, "--seed"},
    {"semicircle", "figure 6.7: time by the number of lines", &ExperimentCommand::semicircle, "--max-points"},
    {"edges", "figure 6.8: four solitary edges", &ExperimentCommand::vectorization<solitaryEdges>, ofScenes},
    {"corners", "figure 6.9: one cluster with sharp corners", &ExperimentCommand::vectorization<sharpCorners>,
     ofScenes},
    {"room", "figure 6.10: a furnished room", &ExperimentCommand::vectorization<furnishedRoom>, ofScenes},
    {"empty-room", "figure 6.11: the scan of --log with long lines all around",
     &ExperimentCommand::realScan<RealScanKind::EmptyRoom>, ofScans},
    {"corridor", "figure 6.12: the scan of --log with long lines in one direction",
     &ExperimentCommand::realScan<RealScanKind::Corridor>, ofScans},
    {"laboratory", "figure 6.13: the scan of --log with the most lines",
     &ExperimentCommand::realScan<RealScanKind::Laboratory>, ofScans},
    {"polygons", "closed polygons: error by the number of vertices", &ExperimentCommand::polygons,
     "--runs --seed"},
    {"log", "the scans of --log: error by the number of vertices", &ExperimentCommand::ofLog, "--log --runs"},
    {"pairs", "the motions between scans of --log: error against its corrected poses",
     &ExperimentCommand::pairs, "--log --every --first --half --no-guess --draw"},
    {"calibration", "matches without estimate in all pairs of --log ...: probability told, and share right",
     &ExperimentCommand::calibration, "--log --every --first --half"},
    {"places", "scans of --log searched in a map of every other scan: how often their place is found",
     &ExperimentCommand::places, "--log --other"},
    {"drawn-places", "scans of simulated worlds, floor plans and towns searched in their maps",
     &ExperimentCommand::drawnPlaces, "--worlds --runs --seed"},
    {"place-trust",
     "the weights of PlaceTrust, fitted to one half of scans of --log ... and of drawn buildings",
     &ExperimentCommand::placeTrust, "--log --other --worlds --runs --seed"},
    {"pose-trust",
     "the weights of PoseTrust, fitted to one half of the poses tracked in --log ... and in drawn buildings",
     &ExperimentCommand::poseTrust, "--log --other --runs --seed"},
    {"criterion", "figures 7.3 to 7.6: the criterion of two segments", &ExperimentCommand::criterion, ""},
    {"criterion-time", "figures 7.7 to 7.9: its time, pair by pair and from sums",
     &ExperimentCommand::criterionTime, "--seed"},
    {"potential-pairs", "figures 7.16 to 7.20: potential pairs by accuracy, bundles, discrepancy",
     &ExperimentCommand::potentialPairs, "--worlds --runs --seed"},
    {"hausdorff-criteria", "thesis 7.1.4: other criteria as in figures 7.3 to 7.6, and what each holds",
     &ExperimentCommand::hausdorffCriteria, "--seed"},
    {"overview-steps", "overview figure 2: ten scans 60 cm apart, with a bad odometry",
     &ExperimentCommand::overviewSteps, "--worlds --runs --seed"},
    {"overview-loop", "overview figure 4: a corridor there and back, 46.71 m in 33 scans",
     &ExperimentCommand::overviewLoop, "--worlds --runs --seed"},
    {"baseline", "overview 2.2: its matcher and ours on the same pairs of simulated scans, or of --log ...",
     &ExperimentCommand::baseline, "--log --every --first --worlds --runs --seed"},
    {"registration-space",
     "paper figures 2 to 4: the space of transformations, nearly collinear segments, the ellipse of "
     "reliability",
     &ExperimentCommand::registrationSpace, ""},
    {"accuracy", "paper figure 6: error and ambiguity of registration", &ExperimentCommand::accuracy,
     ofWorlds, published},
    {"registration-bias", "paper figure 6: what of the error many points and many scans do not take away",
     &ExperimentCommand::registrationBias, "--worlds --runs --max-points --seed", published},
    {"dispersion", "paper figures 7 and 8: scatter at every pose", &ExperimentCommand::dispersion, ofWorlds,
     published},
    {"weighting", "paper tables 1 and 2: what weights gain, what ambiguity tells",
     &ExperimentCommand::weighting, ofWorlds, published},
    {"reliability", "paper figure 9: reliability at every pose", &ExperimentCommand::reliability, ofWorlds,
     published},
    {"rotation", "paper figure 10: Mitsuta's and Wahba's mean rotation", &ExperimentCommand::rotation,
     "--runs --seed"},
    {"free-home", "pose-free thesis 6.2, 6.3, 6.11: 3,069 scans of a home", &ExperimentCommand::freeHome,
     "--worlds --seed"},
    {"free-leaps", "pose-free thesis 6.4, 6.5, 6.11: 23 scans of the same way", &ExperimentCommand::freeLeaps,
     "--worlds --seed"},
    {"free-copy", "pose-free thesis 6.7, 6.8: a scan on its copy", &ExperimentCommand::freeCopy,
     "--worlds --seed"},
    {"free-approach", "pose-free thesis 6.9, 6.10: straight to where walls meet",
     &ExperimentCommand::freeApproach, "--worlds --seed --every"},
    {"free-log", "pose-free thesis 6.12, 6.13: the scans of --log", &ExperimentCommand::freeLog,
     "--log --every"}};

bool takes(const Experiment &experiment, const std::string &option) {
    return (std::string(experiment.takes) + ' ').find(option + ' ') != std::string::npos;
}

/// The names of the experiments that take an option.
std::string takersOf(const std::string &option) {
    std::string names;
    for (const Experiment &e : experiments)
        if (takes(e, option))
            names += (names.empty() ? "" : ", ") + std::string(e.name);
    return names;
}

} // namespace

void ExperimentCommand::refuseUnused(const CLI::App &sub) const {
    const Experiment &own = *std::find_if(std::begin(experiments), std::end(experiments),
                                          [this](const Experiment &e) { return name == e.name; });
    for (const CLI::Option *option : sub.get_options()) {
        const std::string takers = takersOf(option->get_name());
        if (option->count() > 0 && !takers.empty() && !takes(own, option->get_name()))
            throw CLI::ValidationError(option->get_name(), "the experiment " + name +
                                                               " takes no such option; taken by: " + takers);
    }
    if (others.size() > 1 && name != "pose-trust")
        throw CLI::ValidationError("--other", "found " + std::to_string(others.size()) +
                                                  " logs, the experiment " + name + " takes one");
    if (every.size() > std::max<std::size_t>(1, logs.size()))
        throw CLI::ValidationError("--every", "found " + std::to_string(every.size()) +
                                                  ", expected one for each --log at most");
}

void ExperimentCommand::run() {
    OutputSet files(force);
    files.makeFolder(folder);
    std::optional<Progress> progress; // once the work has begun: reading tells its own
    if (!options.progress)
        options.progress = [&](std::size_t done, std::size_t all) {
            if (!progress)
                progress.emplace(name + ", step");
            progress->update(double(done), double(all));
        };
    pairOptions.progress = options.progress;
    pairOptions.every = every[0];
    std::ostream &csv = open(files, ".csv"); // first: that it exists is told before the work is done
    for (const Experiment &experiment : experiments)
        if (name == experiment.name) {
            options.runs = runs.value_or(experiment.runs);
            (this->*experiment.run)(files, csv);
        }
    files.commit();
}

void addExperimentCommand(CLI::App &app) {
    auto command = std::make_shared<ExperimentCommand>();
    CLI::App *sub = app.add_subcommand(
        "experiment", "Repeat an experiment of the documents behind Hermes: CSV, SVG and LaTeX");
    std::string list = "Which one:";
    std::vector<std::string> names;
    for (const Experiment &e : experiments) {
        names.emplace_back(e.name);
        list += std::string("\n  ") + e.name + ": " + e.what;
    }
    sub->add_option("NAME", command->name, list)->required()->check(CLI::IsMember(names));
    addOption(*sub, "--out FOLDER", command->folder, "Folder for the files; made when missing")
        ->capture_default_str();
    addOption(*sub, "--log FILE", command->logs,
              "CARMEN log for log, pairs, places and free-log; CARMEN log or capture of an HDL-32E or VLP-16 "
              "for empty-room, corridor, laboratory and real-segmentation; several logs for calibration, "
              "baseline, place-trust and pose-trust")
        ->allow_extra_args(false);
    addOption(*sub, "--other FILE", command->others,
              "places, place-trust: search the scans of this CARMEN log of another building, which are to be "
              "refused; pose-trust: a log, or several, that nothing is fitted to")
        ->allow_extra_args(false);
    command->sensor.addTo(*sub);
    addOption(*sub, "--every N", command->every, wholeNumber(1, 1e9),
              "pairs, calibration, baseline, free-log, free-approach: only every N-th scan, and its next "
              "N-th one; of several logs the first N for the first, the last for all that follow")
        ->allow_extra_args(false)
        ->capture_default_str();
    addOption(*sub, "--first N", command->pairOptions.first, wholeNumber(1, 1e9),
              "pairs, calibration, baseline: only the first N pairs");
    sub->add_flag("--no-guess", command->noGuess,
                  "pairs: match by the two scans alone, without odometry or any other estimate");
    sub->add_option_function<std::string>(
           "--half",
           [command](const std::string &half) {
               command->pairOptions.half = half == "1" ? PairHalf::First : PairHalf::Second;
           },
           "pairs, calibration: only the first or the second half, blocks of 50 pairs in turn: to choose "
           "parameters on one and judge them on the other")
        ->check(CLI::IsMember({"1", "2"}))
        ->type_name("1|2");
    addOption(*sub, "--draw N", command->pictures, wholeNumber(0, 10000),
              "pairs: draw the first N pairs that are not within 10 cm and 2 degrees")
        ->capture_default_str();
    addOption(*sub, "--worlds FOLDER", command->worlds,
              "Folder of cutsquare.json, oblique.json, pillars.json, home.json, corner.json, quadratic.json, "
              "laboratory.json and corridor.json instead of those installed with the program");
    addOption(*sub, "--runs N", command->runs, wholeNumber(1, 10000),
              "Scans for each number of points (and each pose); floor plans of drawn-places and place-trust; "
              "drawn drives of pose-trust (20; 100 for accuracy, registration-bias, dispersion, weighting "
              "and reliability, as published)");
    sub->add_flag("--known-edges", command->knownEdges,
                  "accuracy, dispersion, weighting, reliability: a line for each run of rays on one edge, "
                  "instead of segmentation and vectorization of the scan");
    addOption(*sub, "--max-points N", command->options.maxPoints, wholeNumber(20, 1e6),
              "Leave out larger clouds")
        ->capture_default_str();
    addOption(*sub, "--noise M", command->options.noise, between(0, 1),
              "Of the range, standard deviation, metres")
        ->capture_default_str();
    addOption(*sub, "--seed I", command->options.seed, "Of the noise; the same seed gives the same scans")
        ->capture_default_str();
    sub->add_flag("--force", command->force, "Overwrite files that exist");
    sub->footer(example("hermes-experiments experiment corners --out results"));
    sub->callback([command, sub] {
        command->refuseUnused(*sub);
        command->run();
        command->drawFigures();
    });
}

} // namespace hermes::experiments
