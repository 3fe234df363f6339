#include "vectorlib/experiments/DrawnDrive.h"

#include "vectorlib/observation/FloorPlan.h"

#include <algorithm>
#include <cmath>

namespace hermes::experiments {

using vectorlib::Transformation2D;

DrawnDrive::DrawnDrive(unsigned seed)
    : random_(seed)
    , scanner_(seed)
    , step_(between(0.05, 0.5))
    , pause_(between(0.1, 0.8))
    , slip_(between(-0.02, 0.15))
    , turnError_(between(-0.05, 0.05))
    , hasOdometry_(between(0, 1) < 0.75) {
    drawWalls();
    angle_ = between(-vectorlib::pi, vectorlib::pi);
    const bool isTurn = between(0, 1) < 0.4;
    scanner_.fieldOfView = isTurn ? 2 * vectorlib::pi : vectorlib::pi;
    scanner_.rays = isTurn ? 720 : between(0, 1) < 0.5 ? 181 : 361;
    scanner_.sigma = between(0.005, 0.03);
    scanner_.maxRange = between(0, 1) < 0.5 ? 80 : between(3, 10);
    const int people = between(0, 1) < 0.4 ? 0 : int(between(1, 20));
    for (int i = 0; i < people; ++i)
        people_.push_back(
            {angle_ + between(-4, 4) / std::max(radii_.x, radii_.y), between(-0.5, 1.5), between(0.4, 1.6)});
}

void DrawnDrive::drawWalls() {
    const double kind = between(0, 3);
    kind_ = kind < 1 ? "halls" : kind < 2 ? "corridors" : "plans";
    if (kind_ == "plans") {
        const vectorlib::FloorPlan plan(unsigned(random_()), 10);
        double end = 0;
        for (const auto &wall : plan.walls()) {
            walls_.emplace_back(wall);
            end = std::max(end, wall.begin().x);
        }
        middle_ = {end / 2, 0.8};
        radii_ = {end / 2 - 1, 0.25};
        return;
    }
    const double deep = kind_ == "halls" ? between(3, 8) : between(0.9, 1.5);
    const Point half(kind_ == "halls" ? between(3, 12) : 20, deep);
    block(half * -1, half, true);
    radii_ = kind_ == "halls" ? half * 0.5 : Point(half.x - 1, 0.25);
    for (int pillars = kind_ == "halls" ? int(between(0, 8)) : 0; pillars > 0; --pillars) {
        const double y = between(-half.y, half.y), x = between(-half.x, half.x);
        const double way = std::hypot(x / radii_.x, y / radii_.y), size = between(0.1, 0.5);
        const Point p(x, y);
        if (way < 0.6 || way > 1.4)
            block(p - Point(size, size), p + Point(size, size), false);
    }
}

void DrawnDrive::block(Point low, Point high, bool inside) {
    Point corners[] = {low, {high.x, low.y}, high, {low.x, high.y}};
    if (!inside)
        std::reverse(std::begin(corners), std::end(corners));
    for (int i = 0; i < 4; ++i)
        walls_.emplace_back(vectorlib::LineSegment2D<double>(corners[i], corners[(i + 1) % 4]));
}

DrawnDrive::Point DrawnDrive::at(double angle, double aside) const {
    return middle_ + Point(radii_.x * std::cos(angle), radii_.y * std::sin(angle)) * aside;
}

double DrawnDrive::after(double angle, double way) const {
    const auto heading = [this](double a) {
        return std::atan2(radii_.y * std::cos(a), -radii_.x * std::sin(a));
    };
    double step = 0.5;
    while ((at(angle + step) - at(angle)).norm() > way ||
           std::abs(vectorlib::wrapAngle(heading(angle + step) - heading(angle))) > 0.3)
        step *= 0.9;
    return angle + step;
}

void DrawnDrive::take(vectorlib::TimedScan &scan) {
    const vectorlib::Pose2D before = truth_;
    const double last = angle_;
    angle_ = after(angle_, step_);
    const Point p = at(angle_), ahead = at(angle_ + 1e-6) - p;
    truth_ = {p.x, p.y, std::atan2(ahead.y, ahead.x)};
    stamp_ += pause_;

    const std::size_t walls = walls_.size();
    for (Person &person : people_) {
        person.at += person.speed * (angle_ - last);
        const Point q = middle_ + Point(radii_.x * std::cos(person.at),
                                        std::max(0.8, radii_.y) * person.aside * std::sin(person.at));
        if ((q - p).norm() > 0.5)
            block(q - Point(0.2, 0.2), q + Point(0.2, 0.2), false);
    }
    scan.points = scanner_(walls_, truth_);
    walls_.erase(walls_.begin() + std::ptrdiff_t(walls), walls_.end()); // people walk on
    scan.seconds.clear();
    scan.stamp = stamp_;
    scan.rays = std::size_t(scanner_.rays);
    scan.fieldOfView = scanner_.fieldOfView;
    scan.closed = scanner_.fieldOfView >= 2 * vectorlib::pi;
    tellOdometry(scan, before);
}

void DrawnDrive::tellOdometry(vectorlib::TimedScan &scan, const vectorlib::Pose2D &before) {
    scan.odometry.reset();
    if (!hasOdometry_)
        return;
    const vectorlib::Pose2D way = before.inverse() * truth_;
    told_ = told_ * Transformation2D(way.x * (1 - slip_), way.y * (1 - slip_), way.theta * (1 + turnError_));
    scan.odometry = vectorlib::OdometryTrack(1, {{stamp_, told_.pose(), {}, {}}});
}

} // namespace hermes::experiments
