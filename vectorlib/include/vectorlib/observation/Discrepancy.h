#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Angle.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/observation/Observer.h"

#include <vector>

namespace vectorlib {

/// The border between what a view has explored and what it has not: from the end of each visible part to the
/// begin of the next. Behind it lies the shadow of the nearer of the two. Directions in which nothing was
/// seen under more than `widestGap` are unexplored down to the sensor. Thesis 7.4.2, third rule.
///
/// `view` is that of an Observer with a full turn; the frontier is in its frame, counter-clockwise. An empty
/// view has explored nothing and has no frontier.
class Frontier {
public:
    double widestGap = pi / 6; ///< radians

    /// The frontier of a view; valid until the next call.
    const std::vector<LineSegment2D<double>> &operator()(const std::vector<VisiblePart<double>> &view);

private:
    void close(Vector2D<double> end, Vector2D<double> begin);

    std::vector<LineSegment2D<double>> segments_;
};

/// What two views from one pose share and where they differ. Thesis 7.4.2.
struct ViewComparison {
    double discrepancy = 0; ///< area between the two views over the directions that both see; m^2
    double common = 0;      ///< area in front of both over these directions; m^2
    double angle = 0;       ///< of these directions; radians. 0: nothing can be said
};

/// Over a sector of directions: from right to left what either view sees there. They do not cross inside.
struct SharedSector {
    /// The points that the two views see at the ends of the sector; sensor frame, metres.
    Vector2D<double> expectedRight, expectedLeft, observedRight, observedLeft;
};

/// Compares two views from one pose, exactly: over every direction that both see, the area between them.
/// Segments that cross are split at the crossing. Linear in the parts; keeps its buffers.
class Discrepancy {
public:
    /// Both as an Observer gives them, in one sensor frame.
    ViewComparison operator()(const std::vector<VisiblePart<double>> &expected,
                              const std::vector<VisiblePart<double>> &observed);
    /// The sectors of the last comparison, counter-clockwise; for pictures.
    const std::vector<SharedSector> &sectors() const { return shared_; }

private:
    struct View {
        std::vector<SightLine> lines;
        std::vector<Sector> sectors;
    };

    static void read(const std::vector<VisiblePart<double>> &parts, View &view);
    void compare(const SightLine &a, const SightLine &b, Vector2D<double> right, Vector2D<double> left);
    void measure(const SightLine &a, const SightLine &b, Vector2D<double> right, Vector2D<double> left);

    View expected_, observed_;
    std::vector<SharedSector> shared_;
    ViewComparison result_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/observation/Discrepancy.cpp")
