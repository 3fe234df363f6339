#include "vectorlib/experiments/CloudPicture.h"

#include "vectorlib/observation/SimulatedScanner.h"

#include <algorithm>

namespace hermes::experiments {

namespace {

constexpr std::size_t semicirclePoints = 100;
constexpr std::size_t scenePoints = 1000;

} // namespace

vectorlib::SvgPicture pictureOfSemicircle() {
    vectorlib::SvgPicture picture("a semicircle of radius 1 m, " + std::to_string(semicirclePoints) +
                                  " points");
    picture.points({vectorlib::colour::map, 4, "points"}, semicircle(semicirclePoints));
    return picture;
}

vectorlib::SvgPicture pictureOfCloud(const Scene &scene, const ExperimentOptions &options) {
    vectorlib::SimulatedScanner<float> scan(options.seed);
    scan.rays = static_cast<int>(std::min(scenePoints, options.maxPoints));
    scan.sigma = options.noise;
    std::ostringstream noise;
    noise << 1000 * options.noise;
    vectorlib::SvgPicture picture(scene.title + ", " + std::to_string(scan.rays) + " rays, noise " +
                                  noise.str() + " mm");
    picture.segments({vectorlib::colour::reference, 1.5, "visible parts of edges"}, scene.visible());
    picture.points({vectorlib::colour::map, 3, "points"}, scan(scene.edges, {}));
    picture.pose({vectorlib::colour::estimate, 2, "scanner"}, {}, 0);
    return picture;
}

} // namespace hermes::experiments
