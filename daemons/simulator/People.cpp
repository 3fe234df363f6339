#include "daemons/simulator/People.h"

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
            if (person.waiting > patience) {
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

} // namespace hermes::simulator
