#include "common/world/World.h"
#include "gui/vector/Failure.h"
#include "gui/vector/Input.h"
#include "gui/vector/Options.h"
#include "vectorlib/io/Csv.h"
#include "vectorlib/io/CsvPoints.h"
#include "vectorlib/io/Svg.h"
#include "vectorlib/observation/Observer.h"
#include "vectorlib/observation/SimulatedScanner.h"

namespace hermes::vector {

namespace {

using Point = vectorlib::Vector2D<double>;
using Segment = vectorlib::LineSegment2D<double>;

struct ObserveCommand {
    std::string in;
    std::string pose;
    int rays = 0; ///< 0: the exact view instead of a scan
    double noise = 0;
    double angleNoise = 0;    ///< degrees
    double fieldOfView = 360; ///< degrees
    double outliers = 0;
    std::uint64_t seed = 1;
    OutputOptions output;

    void run() const {
        Outputs files(output);
        const std::vector<Segment> world = loadWorld();
        const vectorlib::Pose2D at = parsePose(pose);
        const std::vector<Segment> view = observe(world, at);
        std::vector<Point> scan;
        if (rays > 0) {
            scan = simulate(world, at);
            vectorlib::writeCsvPoints(files.out, scan);
        } else {
            vectorlib::writeCsvSegments(files.out, view);
        }
        files.draw([&] { return pictureOf(world, at, view, scan); });
        files.commit();
    }

    std::vector<Segment> loadWorld() const {
        Input input(worldFile(in));
        const World world = valueOrFail(parseWorld(input.readAll(), input.name()));
        std::vector<Segment> edges;
        for (const World::Edge &e : world.edges)
            edges.emplace_back(Point(e.x1, e.y1), Point(e.x2, e.y2));
        return edges;
    }
    double radians() const {
        return fieldOfView == 360 ? 2 * vectorlib::pi : fieldOfView * vectorlib::pi / 180;
    }

    std::vector<Segment> observe(const std::vector<Segment> &world, const vectorlib::Pose2D &at) const {
        vectorlib::Observer<double> observer;
        observer.fieldOfView = radians();
        std::vector<Segment> view;
        for (const auto &part : observer(world, at))
            view.push_back(part.segment);
        return view;
    }
    std::vector<Point> simulate(const std::vector<Segment> &world, const vectorlib::Pose2D &at) const {
        vectorlib::SimulatedScanner<double> scanner(seed);
        scanner.rays = rays;
        scanner.fieldOfView = radians();
        scanner.sigma = noise;
        scanner.angleSigma = angleNoise * vectorlib::pi / 180;
        scanner.outliers = outliers;
        return scanner(world, at);
    }
    static vectorlib::SvgPicture pictureOf(const std::vector<Segment> &world, const vectorlib::Pose2D &at,
                                           const std::vector<Segment> &view, const std::vector<Point> &scan) {
        std::vector<Segment> around;
        for (const Segment &s : world)
            around.push_back(vectorlib::Transformation2D(at).inverse() * s);
        vectorlib::SvgPicture picture("What a sensor sees, in its own frame");
        picture.segments({vectorlib::colour::points, 1.2, "world"}, around);
        picture.segments({vectorlib::colour::estimate, 3, "expected view"}, view);
        if (!scan.empty())
            picture.points({vectorlib::colour::reference, 3, "simulated scan"}, scan);
        picture.pose({vectorlib::colour::map, 2, "sensor"}, {}, 0);
        return picture;
    }
};

} // namespace

void addObserveCommand(CLI::App &app) {
    const auto [sub, command] =
        addCommand<ObserveCommand>(app, "observe",
                                   "What a sensor sees of a world: the exact view (CSV x1,y1,x2,y2) or a "
                                   "simulated scan (CSV x,y), in the sensor's frame",
                                   "hermes-vector observe pillars --pose 1,1,0.5 --scan 720 --noise 0.01");
    sub->add_option("WORLD", command->in,
                    "World: JSON with edges, or the name of one that came with the program")
        ->required();
    addOption(*sub, "--pose X,Y,THETA", command->pose, poseText(), "Where the sensor is: metres, radians")
        ->required();
    CLI::Option *scan =
        addOption(*sub, "--scan N", command->rays, wholeNumber(1, 1e7), "Simulate a scan of so many rays");
    addOption(*sub, "--fov DEG", command->fieldOfView, between(0.001, 360),
              "Field of view, half of it to each side of the heading, degrees")
        ->capture_default_str();
    addOption(*sub, "--noise M", command->noise, between(0, 1e6), "Standard deviation of the range, metres")
        ->needs(scan)
        ->capture_default_str();
    addOption(*sub, "--angle-noise DEG", command->angleNoise, between(0, 180),
              "Standard deviation of the rays' directions, which the points do not tell, degrees")
        ->needs(scan)
        ->capture_default_str();
    addOption(*sub, "--outliers F", command->outliers, between(0, 1),
              "Share of rays, 0 to 1, that stop before the wall")
        ->needs(scan)
        ->capture_default_str();
    addOption(*sub, "--seed I", command->seed, "The same seed gives the same scan")
        ->needs(scan)
        ->capture_default_str();
    command->output.addTo(*sub, true);
}

} // namespace hermes::vector
