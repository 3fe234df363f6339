#include "gui/vector/experiment/SegmentationExperiment.h"

#include "vectorlib/io/Svg.h"
#include "vectorlib/observation/SimulatedScanner.h"
#include "vectorlib/segmentation/EarSegmenter.h"

#include <algorithm>

namespace hermes::vector {

namespace {

constexpr int scanRays = 2000;

bool isOutlier(const Scene &scene, vectorlib::Vector2D<float> point, double sigma) {
    for (const auto &edge : scene.edges)
        if (edge.distance(point) <= 4 * sigma)
            return false;
    return true;
}

SegmentationPanel measure(const Scene &scene, double noise, double outlierShare, std::uint64_t seed) {
    vectorlib::SimulatedScanner<float> scan(seed);
    scan.rays = scanRays;
    scan.sigma = noise;
    scan.outliers = outlierShare;
    vectorlib::EarSegmenter<float> segment;
    segment.settings.nominalPoints = scanRays;

    SegmentationPanel panel;
    panel.noise = noise;
    panel.outlierShare = outlierShare;
    panel.scan = scan(scene.edges, {});
    panel.points = panel.scan.size();
    const vectorlib::Segmentation &found = segment(panel.scan);
    panel.labels = found.labels;
    panel.clusters = found.size();
    for (std::size_t i = 0; i < panel.points; ++i) {
        const bool truly = isOutlier(scene, panel.scan[i], std::max(noise, 0.001));
        panel.outliersTrue += truly;
        panel.outliersFound += truly && panel.labels[i] < 0;
        panel.pointsLost += !truly && panel.labels[i] < 0;
    }
    return panel;
}

} // namespace

std::vector<SegmentationPanel> segmentationExperiment(const Scene &scene, std::uint64_t seed) {
    const std::size_t clustersTrue = measure(scene, 0, 0, seed).clusters;
    std::vector<SegmentationPanel> panels;
    for (const double noise : {0.01, 0.03, 0.06})
        for (const double outliers : {0.0, 0.1, 0.2}) {
            panels.push_back(measure(scene, noise, outliers, seed));
            panels.back().clustersTrue = clustersTrue;
        }
    return panels;
}

void writeCsv(std::ostream &out, const std::vector<SegmentationPanel> &panels) {
    using vectorlib::Number;
    out << "noise,outlier_share,points,clusters_true,clusters,outliers_true,outliers_found,points_lost\n";
    for (const SegmentationPanel &p : panels)
        out << Number(p.noise) << ',' << Number(p.outlierShare) << ',' << p.points << ',' << p.clustersTrue
            << ',' << p.clusters << ',' << p.outliersTrue << ',' << p.outliersFound << ',' << p.pointsLost
            << '\n';
}

void draw(std::ostream &svg, const Scene &scene, const SegmentationPanel &panel) {
    vectorlib::SvgPicture picture(scene.title + ", noise " + std::to_string(std::lround(100 * panel.noise)) +
                                  " cm, " + std::to_string(std::lround(100 * panel.outlierShare)) +
                                  " % outliers: " + std::to_string(panel.clusters) + " clusters, " +
                                  std::to_string(panel.clustersTrue) + " without noise");
    picture.segments({vectorlib::colour::points, 1, "true edges"}, scene.edges);
    std::vector<std::vector<vectorlib::Vector2D<float>>> clusters(panel.clusters);
    std::vector<vectorlib::Vector2D<float>> outliers;
    for (std::size_t i = 0; i < panel.scan.size(); ++i)
        (panel.labels[i] < 0 ? outliers : clusters[static_cast<std::size_t>(panel.labels[i])])
            .push_back(panel.scan[i]);
    for (std::size_t c = 0; c < clusters.size(); ++c)
        picture.points({vectorlib::colour::distinct(c), 3, c == 0 ? "clusters" : ""}, clusters[c]);
    picture.points({vectorlib::colour::outliers, 3, "outliers"}, outliers);
    picture.write(svg);
}

} // namespace hermes::vector
