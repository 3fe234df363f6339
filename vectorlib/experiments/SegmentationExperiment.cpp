#include "vectorlib/experiments/SegmentationExperiment.h"

#include "vectorlib/observation/SimulatedScanner.h"
#include "vectorlib/segmentation/EarSegmenter.h"

#include <algorithm>

namespace hermes::experiments {

namespace {

constexpr int scanRays = 2000;
constexpr double reach = 20; // of the scanner; metres

bool isOutlier(const Scene &scene, vectorlib::Vector2D<float> point, double sigma) {
    for (const auto &edge : scene.edges)
        if (edge.distance(point) <= 4 * sigma)
            return false;
    return true;
}

// A scan without noise and outliers tells how many clusters there are.
SegmentationPanel measure(const Scene &scene, double noise, double outlierShare, std::uint64_t seed,
                          const vectorlib::EarSettings &settings) {
    vectorlib::SimulatedScanner<float> scan(seed);
    scan.rays = scanRays;
    scan.sigma = noise;
    scan.outliers = outlierShare;
    scan.maxRange = reach;
    vectorlib::EarSegmenter<float> segment;
    segment.settings = settings;

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

constexpr const char *panelColumns =
    "noise,outlier_share,points,clusters_true,clusters,outliers_true,outliers_found,points_lost";

std::ostream &operator<<(std::ostream &out, const SegmentationPanel &p) {
    using vectorlib::Number;
    return out << Number(p.noise) << ',' << Number(p.outlierShare) << ',' << p.points << ',' << p.clustersTrue
               << ',' << p.clusters << ',' << p.outliersTrue << ',' << p.outliersFound << ',' << p.pointsLost;
}

vectorlib::EarSettings thesisSettings() {
    vectorlib::EarSettings settings;
    settings.nominalPoints = scanRays;
    return settings;
}

// Thesis figure 5.3: walls 20 cm from the scanner, where the threshold is 6 mm.
Scene nearWalls() {
    Scene scene{"near", "walls 20 cm away", {}};
    scene.edges = {vectorlib::LineSegment2D<float>({-0.5f, -0.2f}, {0.5f, -0.2f}),
                   vectorlib::LineSegment2D<float>({0.5f, 0.2f}, {-0.5f, 0.2f})};
    return scene;
}

// Thesis figure 5.4: a near wall to the left; to the right, 16 m away, posts 40 cm before another, where the
// threshold is 50 cm.
Scene farPosts() {
    Scene scene{"far", "a wall 16 m away with posts before it", {}};
    scene.edges = {vectorlib::LineSegment2D<float>({16, -11}, {16, 11}),
                   vectorlib::LineSegment2D<float>({-2, 2}, {-2, -2})};
    for (const float y : {-7.5f, -2.5f, 2.5f, 7.5f})
        scene.edges.emplace_back(vectorlib::Vector2D<float>(15.6f, y - 0.5f),
                                 vectorlib::Vector2D<float>(15.6f, y + 0.5f));
    return scene;
}

} // namespace

std::vector<SegmentationPanel> segmentationExperiment(const Scene &scene, std::uint64_t seed) {
    const std::size_t clustersTrue = measure(scene, 0, 0, seed, thesisSettings()).clusters;
    std::vector<SegmentationPanel> panels;
    for (const double noise : {0.01, 0.03, 0.06})
        for (const double outliers : {0.0, 0.1, 0.2}) {
            panels.push_back(measure(scene, noise, outliers, seed, thesisSettings()));
            panels.back().clustersTrue = clustersTrue;
        }
    return panels;
}

std::vector<AdaptiveThresholdPanel> adaptiveThresholdExperiment(std::uint64_t seed) {
    const vectorlib::EarSettings bounded = thesisSettings();
    vectorlib::EarSettings noLower = bounded, noUpper = bounded;
    noLower.minThreshold = 0;
    noUpper.maxThreshold = 1e6;
    std::vector<AdaptiveThresholdPanel> panels{
        {"near-unbounded", "threshold without lower bound", nearWalls(), noLower, {}},
        {"near-bounded", "threshold of at least 5 cm", nearWalls(), bounded, {}},
        {"far-unbounded", "threshold without upper bound", farPosts(), noUpper, {}},
        {"far-bounded", "threshold of at most 20 cm", farPosts(), bounded, {}}};
    for (AdaptiveThresholdPanel &p : panels) {
        p.panel = measure(p.scene, 0.01, p.scene.name == "far" ? 0.1 : 0, seed, p.settings);
        p.panel.clustersTrue = measure(p.scene, 0, 0, seed, bounded).clusters;
    }
    return panels;
}

void writeCsv(std::ostream &out, const std::vector<SegmentationPanel> &panels) {
    out << panelColumns << '\n';
    for (const SegmentationPanel &p : panels)
        out << p << '\n';
}

void writeCsv(std::ostream &out, const std::vector<AdaptiveThresholdPanel> &panels) {
    out << "case," << panelColumns << '\n';
    for (const AdaptiveThresholdPanel &p : panels)
        out << p.name << ',' << p.panel << '\n';
}

static vectorlib::SvgPicture pictureOf(const std::string &what, const Scene &scene,
                                       const SegmentationPanel &panel) {
    vectorlib::SvgPicture picture(what + ", noise " + std::to_string(std::lround(100 * panel.noise)) +
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
    picture.pose({vectorlib::colour::map, 2, "scanner"}, {}, 0);
    return picture;
}

vectorlib::SvgPicture pictureOf(const Scene &scene, const SegmentationPanel &panel) {
    return pictureOf(scene.title, scene, panel);
}

vectorlib::SvgPicture pictureOf(const AdaptiveThresholdPanel &panel) {
    return pictureOf(panel.scene.title + ", " + panel.title, panel.scene, panel.panel);
}

} // namespace hermes::experiments
