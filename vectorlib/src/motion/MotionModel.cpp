#include "vectorlib/motion/MotionModel.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace vectorlib {

VECTORLIB_BODY TwistCorrection::Result
TwistCorrection::operator()(PointSpan<float> points, const std::vector<float> &seconds, float reference,
                            const std::vector<LineSegment2D<double>> &known) {
    const std::size_t count = std::min(points.size(), seconds.size()), step = count / maxPoints + 1;
    const double xy = std::pow(deviation / deviationXY, 2), alpha = std::pow(deviation / deviationAlpha, 2);
    edges_.assign(known.begin(), known.end());
    findNear(points, count, step);
    Result result;
    Twist2D &twist = result.twist, pose; // the pose as a motion of one second
    reach_ = gate;
    for (int i = 0; i < iterations; ++i) {
        sums_.setZero();
        g_ << 0, 0, 0, xy * twist.vx, xy * twist.vy, alpha * twist.omega;
        result.bend = 0;
        const Transformation2D placed(pose.motion(1));
        for (std::size_t k = 0, n = 0; k < count; k += step, ++n) {
            const Vector2D<double> point(points[k]);
            const double t = double(seconds[k] - reference);
            const Vector2D<double> moved = Transformation2D(twist, t) * point, now = placed * moved;
            const bool isFar = (now - point).norm() > gate - reach_;
            if (isFar ? add(edges_.data(), edges_.data() + edges_.size(), now, t)
                      : add(near_.data() + starts_[n], near_.data() + starts_[n + 1], now, t))
                result.bend = std::max(result.bend, (moved - point).norm());
        }
        Eigen::Matrix<double, 6, 6> h;
        h << sum(0), sum(1), sum(1), sum(2);
        h.diagonal() += (Vector6() << 1e-6, 1e-6, 1e-6, xy, xy, alpha).finished();
        const Vector6 d = h.ldlt().solve(-g_);
        if (!d.allFinite())
            return {};
        pose = {pose.vx + d(0), pose.vy + d(1), pose.omega + d(2)};
        twist = {twist.vx + d(3), twist.vy + d(4), twist.omega + d(5)};
        reach_ = std::max(lastGate, reach_ * gateFactor);
    }
    return result;
}

VECTORLIB_BODY TwistCorrection::Edge::Edge(const LineSegment2D<double> &edge)
    : normal(edge.normal())
    , direction(edge.direction())
    , distance(normal.dot(edge.begin()))
    , from(direction.dot(edge.begin()))
    , to(from + edge.length()) {}

VECTORLIB_BODY void TwistCorrection::findNear(PointSpan<float> points, std::size_t count, std::size_t step) {
    near_.clear();
    starts_.assign(1, 0);
    for (std::size_t k = 0; k < count; k += step) {
        const Vector2D<double> point(points[k]);
        for (const Edge &edge : edges_)
            if (std::abs(edge.across(point)) <= gate) {
                const double along = edge.direction.dot(point);
                if (along >= edge.from - gate && along <= edge.to + gate)
                    near_.push_back(edge);
            }
        starts_.push_back(near_.size());
    }
}

VECTORLIB_BODY bool TwistCorrection::add(const Edge *edge, const Edge *end, Vector2D<double> point,
                                         double t) {
    const Edge *nearest = nullptr;
    double r = reach_;
    for (; edge != end; ++edge) {
        const double across = edge->across(point);
        if (!(std::abs(across) < std::abs(r)))
            continue;
        const double along = edge->direction.dot(point);
        if (along >= edge->from && along <= edge->to) {
            nearest = edge;
            r = across;
        }
    }
    if (!nearest)
        return false;
    const Vector2D<double> n = nearest->normal;
    const double u = point.cross(n), s = 3 * r / reach_, q = 1 / (1 + s * s), w = q * q;
    const Eigen::Vector3d m(n.x, n.y, u);
    Vector6 products;
    products << m(0) * m, m(1) * m.tail<2>(), m(2) * m(2);
    sums_.noalias() += products * Eigen::RowVector3d(w, w * t, w * t * t);
    g_.head<3>() += (w * r) * m;
    g_.tail<3>() += (w * r * t) * m;
    return true;
}

VECTORLIB_BODY Eigen::Matrix3d TwistCorrection::sum(int k) const {
    const auto p = sums_.col(k);
    return (Eigen::Matrix3d() << p(0), p(1), p(2), p(1), p(3), p(4), p(2), p(4), p(5)).finished();
}

VECTORLIB_BODY float middleTime(const std::vector<float> &seconds) {
    if (seconds.empty())
        return 0;
    const auto [first, last] = std::minmax_element(seconds.begin(), seconds.end());
    return (*first + *last) / 2;
}

VECTORLIB_BODY void compensateMotion(std::vector<Vector2D<float>> &points, const std::vector<float> &seconds,
                                     float reference, const Twist2D &twist) {
    for (std::size_t i = 0; i < points.size() && i < seconds.size(); ++i)
        points[i] = Transformation2D(twist, seconds[i] - reference) * points[i];
}

VECTORLIB_BODY void MotionModel::update(const Pose2D &pose, double stamp) {
    const double seconds = stamp - stamp_;
    if (!known_ || !(seconds > 0) || seconds > maxGap) {
        twist_ = Twist2D();
        velocityKnown_ = false;
    } else if (const Twist2D last = Twist2D::between(pose_.inverse() * pose, seconds);
               seconds >= minGap && std::hypot(last.vx, last.vy) <= fastest_mps &&
               std::abs(last.omega) <= fastest_radps) {
        const double k = velocityKnown_ ? lastStepShare : 1;
        twist_ = {twist_.vx + k * (last.vx - twist_.vx), twist_.vy + k * (last.vy - twist_.vy),
                  twist_.omega + k * (last.omega - twist_.omega)};
        velocityKnown_ = true;
    }
    pose_ = pose;
    stamp_ = stamp;
    known_ = true;
}

VECTORLIB_BODY void MotionModel::reset(const Pose2D &pose) {
    pose_ = pose;
    twist_ = Twist2D();
    known_ = velocityKnown_ = false;
}

VECTORLIB_BODY Pose2D MotionModel::predict(double stamp) const {
    const double seconds = stamp - stamp_;
    if (!known_ || !(seconds > 0) || seconds > maxGap)
        return pose_;
    return pose_ * twist_.motion(seconds);
}

} // namespace vectorlib
