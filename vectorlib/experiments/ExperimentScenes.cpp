#include "vectorlib/experiments/ExperimentCommand.h"

#include "gui/vector/Failure.h"
#include "gui/vector/MapSource.h"
#include "vectorlib/experiments/CloudPicture.h"
#include "vectorlib/experiments/CriterionExperiment.h"
#include "vectorlib/experiments/SegmentationExperiment.h"
#include "vectorlib/experiments/ThresholdExperiment.h"

#include <iostream>
#include <map>
#include <sstream>

namespace hermes::experiments {

using vector::Failure;
using vector::MapScan;
using vector::MapSourceOptions;
using vector::MapSourceReport;
using vector::readMapScans;

void ExperimentCommand::adaptiveThreshold(OutputSet &files, std::ostream &csv) const {
    const std::vector<AdaptiveThresholdPanel> panels = adaptiveThresholdExperiment(options.seed);
    writeCsv(csv, panels);
    std::vector<NamedPicture> drawn;
    for (const AdaptiveThresholdPanel &panel : panels)
        drawn.emplace_back(panel.name, pictureOf(panel));
    draw(files, {}, std::move(drawn));
}

void ExperimentCommand::realSegmentation(OutputSet &files, std::ostream &csv) const {
    const RealScanChoice choice =
        chooseScans({RealScanKind::Corridor, RealScanKind::EmptyRoom, RealScanKind::Laboratory});
    csv << "kind,scan,points,clusters,outliers\n";
    std::vector<NamedPicture> drawn;
    std::size_t kind = 0;
    for (const char *title : {"corridor", "empty-room", "laboratory"}) {
        const RealScan &scan = choice.best(kind++);
        csv << title << ',' << scan.number << ',' << scan.points() << ',' << scan.clusters.size() << ','
            << scan.outliers.size() << '\n';
        drawn.emplace_back(title, pictureOfClusters(title, scan));
    }
    draw(files, {}, std::move(drawn));
}

void ExperimentCommand::threshold(OutputSet &files, std::ostream &csv) const {
    const ThresholdExperiment experiment(options.seed);
    experiment.writeCsv(csv);
    tell(open(files, ".json"), experiment.summary());
    draw(files, {{experiment.errorPlot()}, {}, {}},
         {{"clouds", experiment.pictureOfClouds()}, {"lines", experiment.pictureOfLines()}});
}

void ExperimentCommand::semicircle(OutputSet &files, std::ostream &csv) const {
    const std::vector<ResultRow> rows = semicircleExperiment(options);
    writeCsv(csv, rows);
    std::map<double, std::vector<ResultRow>, std::greater<>> bySigma;
    for (const ResultRow &row : rows)
        bySigma[row.sigma].push_back(row);
    Figures figures;
    for (const auto &[sigma, some] : bySigma) {
        std::ostringstream text;
        text << sigma;
        for (Plot &plot : plotsOf("semicircle, sigma " + text.str() + " m", some)) {
            plot.name.insert(0, "sigma" + text.str() + '-');
            figures.plots.push_back(std::move(plot));
        }
    }
    draw(files, figures, {{"cloud", pictureOfSemicircle()}});
}

void ExperimentCommand::polygons(OutputSet &files, std::ostream &csv) const {
    quality(files, csv, "all polygons", polygonExperiment(options));
}

void ExperimentCommand::ofLog(OutputSet &files, std::ostream &csv) const {
    quality(files, csv, "log", logExperiment(readLog().scans, options));
}

void ExperimentCommand::criterion(OutputSet &files, std::ostream &csv) const {
    const std::vector<Surface> surfaces = criterionSurfaces(segmentCriteria().front());
    writeCsv(csv, surfaces, "criterion_m4");
    draw(files, {{}, surfaces, {}});
}

void ExperimentCommand::hausdorffCriteria(OutputSet &files, std::ostream &csv) const {
    std::vector<Surface> all;
    for (const SegmentCriterion &criterion : segmentCriteria())
        for (Surface &surface : criterionSurfaces(criterion)) {
            surface.name.insert(0, std::string(criterion.name) + '-');
            all.push_back(std::move(surface));
        }
    writeCsv(csv, all, "criterion");
    constexpr int trials = 1000;
    const std::vector<CriterionProperty> properties =
        criterionProperties(options.seed, trials, options.progress);
    tell(open(files, ".json"), summaryOf(properties));
    draw(files, {{}, all, {tableOf(properties)}});
}

void ExperimentCommand::criterionTime(OutputSet &files, std::ostream &csv) const {
    std::ostream &json = open(files, ".json");
    const std::vector<CriterionTime> times = criterionTimes(options);
    writeCsv(csv, times);
    tell(json, summaryOf(times));
    draw(files, {plotsOf(times), {}, {}});
}

void ExperimentCommand::segment(OutputSet &files, std::ostream &csv, const Scene &scene) const {
    const std::vector<SegmentationPanel> panels = segmentationExperiment(scene, options.seed);
    writeCsv(csv, panels);
    std::vector<NamedPicture> drawn;
    for (const SegmentationPanel &panel : panels)
        drawn.emplace_back(std::to_string(std::lround(100 * panel.noise)) + "cm-" +
                               std::to_string(std::lround(100 * panel.outlierShare)) + "percent",
                           pictureOf(scene, panel));
    draw(files, {}, std::move(drawn));
}

void ExperimentCommand::quality(OutputSet &files, std::ostream &csv, const std::string &title,
                                const std::vector<QualityRow> &rows) const {
    writeCsv(csv, rows);
    draw(files, {plotsOf(title, rows), {}, {}});
}

RealScanChoice ExperimentCommand::chooseScans(const std::vector<RealScanKind> &kinds) const {
    if (logs.size() != 1)
        throw CLI::ValidationError("--log", "the experiment " + name +
                                                " needs the name of a CARMEN log or of a capture");
    RealScanChoice choice(kinds);
    MapSourceOptions source;
    source.path = logs[0];
    source.sensor = sensor;
    const MapSourceReport report =
        readMapScans(source, [&choice](const MapScan &scan, std::size_t number, std::size_t) {
            if (scan.fault == MapScan::Fault::None)
                choice.take(number, scan);
        });
    report.warn(std::cerr);
    if (choice.best(0).points() == 0)
        throw Failure(logs[0] + ": no whole scan has ten returns in clusters");
    return choice;
}

void ExperimentCommand::realScan(OutputSet &files, std::ostream &csv, RealScanKind kind) const {
    const RealScanResult result = realScanExperiment(chooseScans({kind}).best(0));
    writeCsv(csv, result);
    draw(files, {{}, {}, {tableOf(name, result)}}, {{"", pictureOf(name, result)}});
}

void ExperimentCommand::vectorize(OutputSet &files, std::ostream &csv, const Scene &scene) const {
    const std::vector<ResultRow> rows = sceneExperiment(scene, options);
    writeCsv(csv, rows);
    draw(files, {plotsOf(scene.title, rows), {}, {lineTable(scene.title, rows)}},
         {{"cloud", pictureOfCloud(scene, options)}});
}

} // namespace hermes::experiments
