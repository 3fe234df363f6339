#pragma once

#include "gui/vector/Input.h"
#include "gui/vector/LidarCapture.h"
#include "gui/vector/Output.h"
#include "vectorlib/experiments/OverviewExperiment.h"
#include "vectorlib/experiments/PairsExperiment.h"
#include "vectorlib/experiments/QualityExperiment.h"
#include "vectorlib/experiments/RealScanExperiment.h"
#include "vectorlib/experiments/RegistrationExperiment.h"
#include "vectorlib/experiments/RelationScans.h"
#include "vectorlib/experiments/Scene.h"
#include "vectorlib/experiments/VectorizationExperiment.h"
#include "vectorlib/io/CarmenLog.h"
#include "vectorlib/io/Svg.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <optional>

namespace hermes::experiments {

using vector::installedWorlds;
using vector::OutputSet;
using vector::SensorOptions;

/// hermes-vector experiment: its options, and a function for each experiment, in ExperimentScenes.cpp,
/// ExperimentSearch.cpp, ExperimentOverview.cpp, ExperimentRegistration.cpp, ExperimentMatches.cpp and
/// ExperimentRelations.cpp. Each writes its table to csv and opens what else it leaves.
struct ExperimentCommand {
    std::string name;
    std::string folder = ".";
    std::vector<std::string> logs;
    std::vector<std::size_t> every{1};
    std::vector<std::string> others;
    std::string worlds = installedWorlds().u8string();
    ExperimentOptions options;
    std::optional<int> runs;
    bool knownEdges = false;
    PairsOptions pairOptions;
    SensorOptions sensor;
    bool noGuess = false;
    std::size_t pictures = 0;
    bool force = false;

    /// Throws CLI::ValidationError when an option was given that the experiment does not take.
    void refuseUnused(const CLI::App &sub) const;
    void run();
    /// Lets plot.py, which lies with the program, draw the figures that run() left; comes back where that is
    /// not possible, or there are none.
    void drawFigures() const;

    template <Scene (*scene)()>
    void segmentation(OutputSet &files, std::ostream &csv) const {
        segment(files, csv, scene());
    }
    void adaptiveThreshold(OutputSet &files, std::ostream &csv) const;
    void realSegmentation(OutputSet &files, std::ostream &csv) const;
    void threshold(OutputSet &files, std::ostream &csv) const;
    void semicircle(OutputSet &files, std::ostream &csv) const;
    template <Scene (*scene)()>
    void vectorization(OutputSet &files, std::ostream &csv) const {
        vectorize(files, csv, scene());
    }
    template <RealScanKind kind>
    void realScan(OutputSet &files, std::ostream &csv) const {
        realScan(files, csv, kind);
    }
    void polygons(OutputSet &files, std::ostream &csv) const;
    void ofLog(OutputSet &files, std::ostream &csv) const;
    void criterion(OutputSet &files, std::ostream &csv) const;
    void criterionTime(OutputSet &files, std::ostream &csv) const;
    void potentialPairs(OutputSet &files, std::ostream &csv) const;
    void hausdorffCriteria(OutputSet &files, std::ostream &csv) const;

    void overviewSteps(OutputSet &files, std::ostream &csv) const;
    void overviewLoop(OutputSet &files, std::ostream &csv) const;
    void baseline(OutputSet &files, std::ostream &csv) const;

    void accuracy(OutputSet &files, std::ostream &csv) const;
    void dispersion(OutputSet &files, std::ostream &csv) const;
    void weighting(OutputSet &files, std::ostream &csv) const;
    void reliability(OutputSet &files, std::ostream &csv) const;
    void registrationSpace(OutputSet &files, std::ostream &csv) const;
    void registrationBias(OutputSet &files, std::ostream &csv) const;
    void rotation(OutputSet &files, std::ostream &csv) const;

    /// Pictures are of pairs that are not near the reference.
    void pairs(OutputSet &files, std::ostream &csv) const;
    void calibration(OutputSet &files, std::ostream &csv) const;
    void places(OutputSet &files, std::ostream &csv) const;
    void drawnPlaces(OutputSet &files, std::ostream &csv) const;
    void placeTrust(OutputSet &files, std::ostream &csv) const;
    void poseTrust(OutputSet &files, std::ostream &csv) const;

    void freeHome(OutputSet &files, std::ostream &csv) const;
    void freeLeaps(OutputSet &files, std::ostream &csv) const;
    void freeLog(OutputSet &files, std::ostream &csv) const;
    void freeCopy(OutputSet &files, std::ostream &csv) const;
    void freeApproach(OutputSet &files, std::ostream &csv) const;

private:
    // Paper 4: 100 ... 3000 points, noise of 1, 3 and 10 cm.
    const std::vector<int> manyPoints{100, 200, 300, 500, 1000, 2000, 3000};
    const std::vector<double> sigmas{0.01, 0.03, 0.1};

    void segment(OutputSet &files, std::ostream &csv, const Scene &scene) const;
    void quality(OutputSet &files, std::ostream &csv, const std::string &title,
                 const std::vector<QualityRow> &rows) const;
    RealScanChoice chooseScans(const std::vector<RealScanKind> &kinds) const;
    void realScan(OutputSet &files, std::ostream &csv, RealScanKind kind) const;
    void vectorize(OutputSet &files, std::ostream &csv, const Scene &scene) const;
    RegistrationCase scansOf(std::vector<int> points, std::vector<double> noises, double minLength = 0) const;
    static std::vector<RegistrationRow> select(const std::vector<RegistrationRow> &rows, int points,
                                               double sigma, bool weighted);
    template <typename Result, typename Pose>
    void pairs(OutputSet &files, std::ostream &csv, const vectorlib::CarmenLog &read,
               const std::vector<Result> &results, Pose found) const;
    void overview(OutputSet &files, std::ostream &csv, const World &world, const OdometryErrors &errors,
                  const nlohmann::ordered_json &published) const;
    std::vector<PosedScan> homeScans(std::size_t count) const;
    void relation(OutputSet &files, std::ostream &csv, const std::vector<PosedScan> &scans, std::size_t rays,
                  double fieldOfView, const nlohmann::ordered_json &published) const;

    // In ExperimentFiles.cpp. Figures for people: on standard output and beside the table.
    static void tell(std::ostream &json, const nlohmann::ordered_json &summary);
    std::ostream &open(OutputSet &files, const std::string &suffix) const;
    World world(const std::string &place) const;
    std::vector<World> allWorlds() const;
    vectorlib::CarmenLog readLog() const;
    static vectorlib::CarmenLog readLog(const std::string &file);
    /// A log to take pairs of scans from, each N-th with its next N-th. Throws Failure where there is no
    /// pair.
    vectorlib::CarmenLog readPairs(const std::string &file, const PairsOptions &of) const;
    /// What each log is called in tables, pictures and names of files: its own name without endings and with
    /// "-" for all that is no ASCII letter, digit or point. Throws Failure where two are called alike.
    static std::vector<std::string> setNames(const std::vector<std::string> &files);
    using NamedPicture = std::pair<std::string, vectorlib::SvgPicture>; ///< name: in file names
    /// All in one LaTeX document, pictures first; the pictures as SVG, and the figures as JSON, of which
    /// drawFigures() makes what the document shows.
    void draw(OutputSet &files, const Figures &figures, std::vector<NamedPicture> named = {}) const;
};

} // namespace hermes::experiments
