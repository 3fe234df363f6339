#include "vectorlib/graph/PoseGraph.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vectorlib {

VECTORLIB_BODY void DriveUncertainty::add(const Pose2D &pose, double varianceXY, double varianceAlpha) {
    if (sums_.empty())
        origin_ = {pose.x, pose.y};
    Sums s = sums_.empty() ? Sums() : sums_.back();
    const Eigen::Vector2d p = Eigen::Vector2d(pose.x, pose.y) - origin_; // squares stay small
    s.place = p;
    s.xy += varianceXY;
    s.alpha += varianceAlpha;
    s.first += varianceAlpha * p;
    s.second += varianceAlpha * p * p.transpose();
    sums_.push_back(s);
}

VECTORLIB_BODY Eigen::Matrix3d DriveUncertainty::between(std::size_t from, std::size_t to) const {
    const Sums &a = sums_[from], &b = sums_[to];
    const double alpha = b.alpha - a.alpha;
    const Eigen::Vector2d p = b.place, first = b.first - a.first;
    const Eigen::Matrix2d arms = b.second - a.second - first * p.transpose() - p * first.transpose() +
                                 alpha * p * p.transpose(); // squares of the ways from there to `to`
    const Eigen::Vector2d arm = alpha * p - first;
    Eigen::Matrix3d c;
    c << arms(1, 1) + b.xy - a.xy, -arms(0, 1), -arm.y(), //
        -arms(0, 1), arms(0, 0) + b.xy - a.xy, arm.x(),   //
        -arm.y(), arm.x(), alpha;
    return c;
}

/// The normal equations of a step.
struct PoseGraph::Equations {
    using Sparse = Eigen::SparseMatrix<double>;
    std::vector<Eigen::Triplet<double, int>> entries; // of the lower half
    Eigen::VectorXd gradient;
    Eigen::SimplicialLDLT<Sparse> solver;
    bool isAnalysed = false;

    void addBlock(int row, int column, const Eigen::Matrix3d &block) {
        for (int c = 0; c < 3; ++c)
            for (int r = row == column ? c : 0; r < 3; ++r)
                entries.emplace_back(row + r, column + c, block(r, c));
    }
};

VECTORLIB_BODY bool
PoseGraph::optimise(const std::function<void(std::size_t done, std::size_t all)> &progress) {
    if (poses.size() < 2 || constraints.empty())
        return true;
    const std::vector<Pose2D> before = poses;
    Equations equations;
    const double widths = std::ceil(std::log(startWidth()) / std::log(settings.narrowing));
    const auto most = static_cast<std::size_t>(2 * widths + settings.steps);
    std::size_t done = 0;
    for (double width = startWidth();; width = std::max(1.0, width / settings.narrowing)) {
        const bool isLast = !(width > 1);
        for (int i = 0; i < (isLast ? settings.steps : 2); ++i) {
            weigh(width * settings.doubt);
            const std::optional<double> moved = step(equations);
            if (!moved) {
                poses = before;
                return false;
            }
            if (progress)
                progress(std::min(++done, most), most);
            if (*moved < settings.enough)
                break;
        }
        if (isLast)
            break;
    }
    weigh(settings.doubt);
    return true;
}

VECTORLIB_BODY double PoseGraph::startWidth() const {
    double worst = 0;
    for (const PoseConstraint &c : constraints)
        if (c.mayBeWrong && !c.isRefused())
            worst = std::max(worst, squaredErrorOf(c));
    return std::max(1.0, 2 * worst / settings.doubt);
}

VECTORLIB_BODY void PoseGraph::weigh(double scale) {
    for (PoseConstraint &c : constraints)
        if (c.mayBeWrong) {
            const double part = scale / (scale + squaredErrorOf(c));
            c.weight = part * part;
        }
}

VECTORLIB_BODY std::optional<double> PoseGraph::step(Equations &e) {
    const auto size = static_cast<int>(3 * poses.size());
    e.entries.clear();
    e.gradient.setZero(size);
    for (const PoseConstraint &c : constraints)
        add(c, e);
    constexpr double fixed = 1e12, loose = 1e-9; // the first pose, and what nothing holds
    for (int i = 0; i < size; ++i)
        e.entries.emplace_back(i, i, i < 3 ? fixed : loose);
    Equations::Sparse h(size, size);
    h.setFromTriplets(e.entries.begin(), e.entries.end());
    if (!std::exchange(e.isAnalysed, true))
        e.solver.analyzePattern(h);
    e.solver.factorize(h);
    if (e.solver.info() != Eigen::Success)
        return std::nullopt;
    const Eigen::VectorXd by = e.solver.solve(e.gradient);
    return by.allFinite() ? std::optional(moveBy(by)) : std::nullopt;
}

VECTORLIB_BODY double PoseGraph::moveBy(const Eigen::VectorXd &by) {
    double farthest = 0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const auto k = static_cast<Eigen::Index>(3 * i);
        Pose2D &p = poses[i];
        p = {p.x + by[k], p.y + by[k + 1], std::remainder(p.theta + by[k + 2], 2 * pi)};
        farthest = std::max({farthest, std::hypot(by[k], by[k + 1]), std::abs(by[k + 2])});
    }
    return farthest;
}

VECTORLIB_BODY void PoseGraph::add(const PoseConstraint &c, Equations &e) const {
    const Pose2D &a = poses[c.from], &b = poses[c.to];
    const double cosA = std::cos(a.theta), sinA = std::sin(a.theta), x = b.x - a.x, y = b.y - a.y;
    Eigen::Matrix3d byTo = Eigen::Matrix3d::Identity();
    byTo.topLeftCorner<2, 2>() << cosA, sinA, -sinA, cosA;
    Eigen::Matrix3d byFrom = -byTo;
    byFrom(0, 2) = cosA * y - sinA * x;
    byFrom(1, 2) = -cosA * x - sinA * y;
    const Eigen::Matrix3d information = c.weight * c.information;
    const Eigen::Matrix3d fromI = byFrom.transpose() * information, toI = byTo.transpose() * information;
    const Eigen::Vector3d error = errorOf(c);
    const auto i = static_cast<int>(3 * c.from), k = static_cast<int>(3 * c.to);
    e.gradient.segment<3>(i) -= fromI * error;
    e.gradient.segment<3>(k) -= toI * error;
    e.addBlock(i, i, fromI * byFrom);
    e.addBlock(k, k, toI * byTo);
    if (k > i)
        e.addBlock(k, i, toI * byFrom);
    else
        e.addBlock(i, k, fromI * byTo);
}

} // namespace vectorlib
