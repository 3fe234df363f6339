#include "vectorlib/experiments/Scene.h"

#include "vectorlib/observation/Observer.h"

namespace hermes::experiments {

using Segment = vectorlib::LineSegment2D<float>;
using Point = vectorlib::Vector2D<float>;

namespace {

void addChain(Scene &scene, const std::vector<Point> &corners) {
    for (std::size_t i = 1; i < corners.size(); ++i)
        scene.edges.emplace_back(corners[i - 1], corners[i]);
}

// A box from its lower left to its upper right corner; clockwise, so that the free space around it is on the
// left.
void addBox(Scene &scene, float x1, float y1, float x2, float y2) {
    addChain(scene, {{x1, y1}, {x1, y2}, {x2, y2}, {x2, y1}, {x1, y1}});
}

} // namespace

std::vector<Segment> Scene::visible() const {
    vectorlib::Observer<float> observe;
    std::vector<Segment> parts;
    for (const auto &part : observe(edges, {}))
        parts.push_back(part.segment);
    return parts;
}

Scene solitaryEdges() {
    Scene scene{"edges", "four solitary edges", {}};
    scene.edges = {Segment({2, -1.2f}, {2.3f, 1}), Segment({1, 2.5f}, {-1, 2}),
                   Segment({-2, 1}, {-2.5f, -0.8f}), Segment({-1.2f, -2}, {0.8f, -2.2f})};
    return scene;
}

Scene sharpCorners() {
    Scene scene{"corners", "five consecutive edges", {}};
    addChain(scene, {{1.5f, -2}, {3, 0}, {1.6f, 0.9f}, {1.4f, 3}, {-1.5f, 1.8f}, {-2.5f, 0}});
    return scene;
}

Scene furnishedRoom() {
    Scene scene{"room", "a furnished room", {}};
    addChain(scene, {{-4, -3},
                     {3, -3},
                     {3, -1.5f},
                     {5, -1.5f},
                     {5, 3},
                     {1.5f, 3},
                     {1.5f, 2.2f},
                     {-1, 2.2f},
                     {-1, 3},
                     {-4, 3},
                     {-4, -3}});
    addBox(scene, 2, 0.8f, 2.8f, 1.5f);
    addBox(scene, -3, -2, -2.2f, -1.2f);
    addBox(scene, 0.4f, -1.8f, 0.8f, -1.4f);
    return scene;
}

Scene roomWithSmallObjects() {
    Scene scene = furnishedRoom();
    scene.name = "objects";
    scene.title = "a room with small objects";
    for (const Point &p :
         {Point(-1.5f, 1), Point(-2.5f, 1.5f), Point(1, 1), Point(3.6f, -0.6f), Point(-1, -2.2f)})
        addBox(scene, p.x, p.y, p.x + 0.15f, p.y + 0.15f);
    return scene;
}

double errorArea(const std::vector<Segment> &truth, const std::vector<Segment> &extracted) {
    constexpr int rays = 36000;
    constexpr double step = 2 * vectorlib::pi / rays;
    constexpr double sameEdge = 0.5; // metres
    const auto range = [](const std::vector<Segment> &segments, vectorlib::Vector2D<double> direction) {
        double nearest = vectorlib::noHit;
        for (const Segment &s : segments)
            nearest =
                std::min(nearest, vectorlib::rayDistance(direction, vectorlib::Vector2D<double>(s.begin()),
                                                         vectorlib::Vector2D<double>(s.end())));
        return nearest;
    };
    double area = 0;
    for (int i = 0; i < rays; ++i) {
        const vectorlib::Vector2D<double> direction(std::cos((i + 0.5) * step), std::sin((i + 0.5) * step));
        const double a = range(truth, direction), b = range(extracted, direction);
        if (a < vectorlib::noHit && std::abs(a - b) <= sameEdge)
            area += 0.5 * step * std::abs(a * a - b * b);
    }
    return area;
}

} // namespace hermes::experiments
