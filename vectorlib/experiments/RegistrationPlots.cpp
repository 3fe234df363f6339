#include "vectorlib/experiments/RegistrationExperiment.h"
#include "vectorlib/experiments/Shapes.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/io/Number.h"
#include "vectorlib/io/Svg.h"

#include <Eigen/Eigenvalues>

#include <map>
#include <set>
#include <sstream>

namespace hermes::experiments {

namespace {

using Point = vectorlib::Vector2D<double>;

Curve wallsOf(const World &world) {
    Curve curve{"walls", vectorlib::colour::map, {}};
    for (const World::Edge &e : world.edges)
        addSegment(curve, {e.x1, e.y1}, {e.x2, e.y2});
    return curve;
}

std::string number(double value) {
    std::ostringstream text;
    text << value;
    return text.str();
}

} // namespace

std::vector<Plot> accuracyPlots(const std::vector<RegistrationRow> &rows) {
    using S = RegistrationStatistics;
    std::vector<Plot> plots;
    const auto add = [&](const char *name, const char *axis, const char *ambiguity, double S::*a,
                         const char *error, double S::*d) {
        std::map<double, std::map<int, std::pair<double, double>>> sums; // by noise and points, of A and D
        for (const RegistrationRow &row : rows)
            if (!row.weighted) {
                auto &sum = sums[row.sigma][row.points];
                sum.first += row.result.*a;
                sum.second += row.result.*d;
            }
        double poses = 0;
        for (const RegistrationRow &row : rows)
            poses = std::max(poses, static_cast<double>(row.pose + 1));
        Plot plot{name, "registration without weights", "points", axis, true, true, {}};
        const char *greens[] = {"#004d38", "#009e73", "#5fd3b0"},
                   *greys[] = {"#3d4657", "#8d99ae", "#c4cbd8"};
        for (const auto &[sigma, byPoints] : sums) {
            const std::string noise = ", " + number(100 * sigma) + " cm";
            const std::size_t shade = plot.curves.size() / 2 % 3;
            Curve green{ambiguity + noise, greens[shade], {}}, grey{error + noise, greys[shade], {}};
            for (const auto &[points, sum] : byPoints) {
                green.points.emplace_back(points, sum.first / poses);
                grey.points.emplace_back(points, sum.second / poses);
            }
            plot.curves.push_back(std::move(green));
            plot.curves.push_back(std::move(grey));
        }
        plots.push_back(std::move(plot));
    };
    add("position", "m^2", "ambiguity", &S::ambiguityXY, "squared error", &S::errorXY);
    add("heading", "rad^2", "ambiguity", &S::ambiguityAlpha, "squared error", &S::errorAlpha);
    return plots;
}

Plot dispersionPlot(const World &world, const std::vector<RegistrationRow> &rows, const std::string &name,
                    double scale) {
    constexpr double radius = 0.35; // of a pie; metres
    const std::string times = scale == 1 ? "" : ", enlarged " + number(scale) + " times";
    Curve path{"true poses", vectorlib::colour::points, {}},
        ellipses{"two sigma of the position" + times, "#009e73", {}},
        pies{"two sigma of the heading" + times, vectorlib::colour::estimate, {}};
    for (const RegistrationRow &row : rows) {
        const RegistrationStatistics &r = row.result;
        const vectorlib::Transformation2D pose(row.at.x, row.at.y, row.at.theta);
        const Point middle = pose * (Point(r.mean(0), r.mean(1)) * scale);
        addPoint(path, {row.at.x, row.at.y});
        Eigen::Matrix2d turn;
        turn << pose.cos(), -pose.sin(), pose.sin(), pose.cos();
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(r.spread.topLeftCorner<2, 2>());
        const Eigen::Matrix2d shape =
            2 * scale * turn * eigen.eigenvectors() *
            Eigen::Matrix2d(eigen.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal());
        addEllipse(ellipses, middle, shape);
        const double half = std::min(vectorlib::pi, 2 * scale * std::sqrt(std::max(0.0, r.spread(2, 2))));
        addPoint(pies, middle);
        for (int i = -4; i <= 4; ++i) {
            const double angle = row.at.theta + scale * r.mean(2) + half * i / 4;
            addPoint(pies, middle + Point(std::cos(angle), std::sin(angle)) * radius);
        }
        addPoint(pies, middle);
        lineBreak(pies);
    }
    Plot plot{name, world.name, "x [m]", "y [m]", false, false, {wallsOf(world), path, ellipses, pies}, true};
    if (!rows.empty())
        plot.title += ": P = " + std::to_string(rows[0].points) + ", sigma = " + number(100 * rows[0].sigma) +
                      " cm, " + (rows[0].weighted ? "weighted" : "no weights") +
                      (scale == 1 ? ", to scale" : times);
    return plot;
}

Plot reliabilityPlot(const World &world, const std::vector<RegistrationRow> &rows) {
    constexpr double radius = 0.3, unsolvedRadius = 0.05; // metres
    const auto circle = [](Curve &curve, const RegistrationRow &row, double size) {
        addEllipse(curve, {row.at.x, row.at.y}, Eigen::Matrix2d::Identity() * size);
    };
    Curve whole{"R = 1", vectorlib::colour::map, {}}, each{"R of each scan", vectorlib::colour::points, {}},
        unsolved{"", vectorlib::colour::outliers, {}}, lowest{"", vectorlib::colour::estimate, {}};
    const RegistrationRow *lowestAt = nullptr;
    double least = 1;
    int failed = 0;
    for (const RegistrationRow &row : rows) {
        std::set<double> seen; // circles that look the same are drawn once
        for (const double reliability : row.result.reliabilities) {
            seen.insert(std::round(reliability * 100) / 100);
            if (reliability > 0 && reliability < least) {
                least = reliability;
                lowestAt = &row;
            }
        }
        for (const double reliability : seen)
            circle(each, row, radius * std::sqrt(reliability));
        circle(whole, row, radius);
        failed += row.result.unsolved;
        if (row.result.unsolved > 0)
            circle(unsolved, row, unsolvedRadius);
    }
    Plot plot{"circles",
              world.name + ": area of the circles by reliability",
              "x [m]",
              "y [m]",
              false,
              false,
              {wallsOf(world), each, whole},
              true};
    if (failed > 0) {
        unsolved.label = std::to_string(failed) + " scans without solution, R = 0";
        plot.curves.push_back(unsolved);
    }
    if (lowestAt) {
        circle(lowest, *lowestAt, radius * std::sqrt(least));
        lowest.label = "lowest single scan, R = " + number(std::round(least * 100) / 100);
        plot.curves.push_back(lowest);
    }
    return plot;
}

} // namespace hermes::experiments
