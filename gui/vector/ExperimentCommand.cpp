#include "gui/vector/ExperimentCommand.h"

#include "gui/vector/Failure.h"
#include "gui/vector/Options.h"
#include "gui/vector/Progress.h"

#include <filesystem>
#include <map>

namespace hermes::vector {

namespace {

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

} // namespace

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
