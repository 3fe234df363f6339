#include "daemons/simulator/RobotBody.h"

#include <algorithm>

namespace hermes::simulator {

namespace {

using Vector = People::Vector;

double lengthOf(const std::vector<Vector> &way) {
    double length = 0;
    for (std::size_t i = 1; i < way.size(); ++i)
        length += (way[i] - way[i - 1]).norm();
    return length;
}

Vector pointAt(const std::vector<Vector> &way, double progress) {
    for (std::size_t i = 1; i < way.size(); ++i) {
        const Vector leg = way[i] - way[i - 1];
        const double length = leg.norm();
        if (progress <= length)
            return way[i - 1] + leg * (progress / length);
        progress -= length;
    }
    return way.back();
}

} // namespace

People::People(const std::vector<World::Person> &walks, double robotRadius)
    : nearest_(robotRadius + distance + radius) {
    for (const World::Person &walk : walks)
        people_.push_back({walk, lengthOf(walk.way), walk.way.front()});
}

void People::advance(double seconds, Vector robot) {
    for (Person &person : people_) {
        const double step = person.walk.speed * seconds;
        const double progress =
            std::clamp(person.progress + (person.forward ? step : -step), 0.0, person.length);
        const Vector next = pointAt(person.walk.way, progress);
        const double gap = (next - robot).norm();
        if (gap < nearest_ && gap < (person.position - robot).norm()) {
            person.waiting += seconds;
            if (person.waiting > longestWait) {
                person.forward = !person.forward;
                person.waiting = 0;
            }
            continue;
        }
        person.position = next;
        person.progress = progress;
        person.waiting = 0;
        if (progress == 0 || progress == person.length)
            person.forward = progress == 0;
    }
}

namespace {

using Vector = vectorlib::Vector2D<double>;

} // namespace

Pose2D RobotBody::move(const Pose2D &from, const Twist2D &twist, double seconds, const People &people) {
    const Pose2D to = from * twist.motion(seconds);
    Vector position(to.x, to.y);
    touching_ = false;
    for (const auto &wall : walls_) {
        if (wall.distance(position) >= radius_)
            continue;
        const Vector nearest =
            wall.begin() + wall.direction() * std::clamp(wall.along(position), 0.0, wall.length());
        const Vector outward = (position - nearest).normalized();
        position = nearest + (outward == Vector() ? wall.normal() : outward) * radius_;
        touching_ = true;
    }
    for (const People::Person &person : people.all()) {
        const Vector outward = position - person.position;
        if (outward.norm() >= radius_ + People::radius || outward == Vector())
            continue;
        position = person.position + outward.normalized() * (radius_ + People::radius);
        touching_ = true;
    }
    if (touching_ && enters(position, people)) // a corner narrower than the robot: it stays where it was
        position = {from.x, from.y};
    return {position.x, position.y, to.theta};
}

bool RobotBody::enters(Vector position, const People &people) const {
    const auto &persons = people.all();
    return std::any_of(walls_.begin(), walls_.end(),
                       [&](const auto &wall) { return wall.distance(position) < radius_ - 1e-9; }) ||
           std::any_of(persons.begin(), persons.end(), [&](const People::Person &person) {
               return (person.position - position).norm() < radius_ + People::radius - 1e-9;
           });
}

} // namespace hermes::simulator
