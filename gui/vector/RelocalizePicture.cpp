#include "gui/vector/RelocalizePicture.h"

#include "gui/vector/DrawnNumber.h"
#include "vectorlib/geometry/Transformation2D.h"

#include <algorithm>
#include <cstdio>

namespace hermes::vector {

namespace {

using Outcome = vectorlib::Relocalized::Outcome;
using Point = vectorlib::Vector2D<double>;
using vectorlib::SvgPicture;

std::string titleOf(const vectorlib::Relocalized &result) {
    const std::string text = result.text();
    return result.isFound() ? "Found" : "Not found: " + text;
}

/// Of a place: "scan and sensor, 0.31 probable at 2.00, 0.99, 29 degrees".
std::string wordsOf(const vectorlib::Place &place) {
    char text[96];
    std::snprintf(text, sizeof text, "scan and sensor, %.2f probable at %.2f, %.2f, %.0f degrees",
                  place.probability, place.pose.x, place.pose.y, place.pose.theta * 180 / vectorlib::pi);
    return text;
}

/// The larger side of the box around a map; metres.
double sizeOf(const SegmentSet &map) {
    Point low, high;
    bool isFirst = true;
    for (const vectorlib::LineSegment2D<double> &s : map.segments())
        for (const Point p : {s.begin(), s.end()}) {
            low = isFirst ? p : Point(std::min(low.x, p.x), std::min(low.y, p.y));
            high = isFirst ? p : Point(std::max(high.x, p.x), std::max(high.y, p.y));
            isFirst = false;
        }
    return std::max(high.x - low.x, high.y - low.y);
}

/// The scan at a place: its points, or the segments where it has none.
void drawScan(SvgPicture &picture, const SegmentSet &scan, const vectorlib::Transformation2D &pose,
              const SvgPicture::Style &style) {
    std::vector<Point> points;
    for (const vectorlib::Vector2D<float> &p : scan.points)
        points.push_back(pose * Point(p));
    std::vector<vectorlib::LineSegment2D<double>> segments;
    for (const vectorlib::LineSegment2D<double> &s : scan.segments())
        segments.push_back(pose * s);
    if (points.empty())
        picture.segments(style, segments);
    else
        picture.points(style, points);
}

} // namespace

SvgPicture pictureOf(const SegmentSet &map, const SegmentSet &scan, const vectorlib::Relocalized &result) {
    SvgPicture picture(titleOf(result));
    picture.segments({vectorlib::colour::map, 1.5, "map"}, map.segments());
    const bool isAmbiguous = result.outcome == Outcome::Ambiguous;
    const std::size_t shown = std::min(result.places.size(), isAmbiguous ? result.alike : std::size_t(1));
    const double height = 0.02 * sizeOf(map);
    for (std::size_t i = 0; i < shown; ++i) {
        const vectorlib::Place &place = result.places[i];
        const vectorlib::Transformation2D pose(place.pose);
        const std::string colour = isAmbiguous        ? vectorlib::colour::distinct(i)
                                   : result.isFound() ? vectorlib::colour::estimate
                                                      : vectorlib::colour::outliers;
        drawScan(picture, scan, pose, {colour, 4, ""});
        const std::string number = isAmbiguous ? std::to_string(i + 1) + ": " : "";
        picture.pose(
            {colour, 2, number + (result.isFound() || isAmbiguous ? "" : "refused: ") + wordsOf(place)},
            pose.translation(), pose.alpha());
        if (isAmbiguous) {
            const auto strokes = drawnNumber(i + 1, pose.translation() + Point(height, height) * 0.9, height);
            picture.segments({"#ffffff", 6, ""}, strokes);
            picture.segments({colour, 2.5, ""}, strokes);
        }
    }
    return picture;
}

} // namespace hermes::vector
