#include "gui/hermesctl/DriveKeys.h"

#include <algorithm>
#include <utility>

namespace hermes::ctl {
namespace {

constexpr double slowest = 0.05, fastest = 1, factor = 1.25; // m/s
constexpr double remembered_s = 1;                           // that a car went back
constexpr double turnOfSpeed = 2.5;                          // rad/s for each m/s
constexpr char escape = 0x1b, endOfInput = 0x04;

} // namespace

DriveKeys::Action DriveKeys::take(const QByteArray &bytes, double now) {
    Action action = Action::None;
    for (const char key : bytes)
        action = std::max(action, takeOne(key, now));
    const bool endsInEscape = sequence_.size() == 1; // the key of that name: arrows come whole
    return endsInEscape ? std::max(action, stop()) : action;
}

DriveKeys::Action DriveKeys::takeOne(char key, double now) {
    if (key == escape) {
        sequence_ = QByteArray(1, key);
        return Action::None;
    }
    if (sequence_.size() == 1 && (key == '[' || key == 'O')) {
        sequence_ += key;
        return Action::None;
    }
    if (std::exchange(sequence_, {}).size() == 2) {
        const int arrow = QByteArray("ABCD").indexOf(key); // up, down, right, left
        if (arrow < 0)
            return stop();
        key = "wsda"[arrow];
    }
    switch (key) {
    case 'w':
    case 'W':
        return press(way_, 1, now);
    case 's':
    case 'S':
        return press(way_, -1, now);
    case 'a':
    case 'A':
        return turn(1, now);
    case 'd':
    case 'D':
        return turn(-1, now);
    case '+':
        speed_ = std::min(speed_ * factor, fastest);
        return Action::None;
    case '-':
        speed_ = std::max(speed_ / factor, slowest);
        return Action::None;
    case 'q':
    case 'Q':
    case endOfInput:
        stop();
        return Action::Quit;
    default:
        return stop();
    }
}

DriveKeys::Action DriveKeys::press(Axis &axis, double sign, double now) {
    axis = {sign, now + held_s};
    return Action::None;
}

DriveKeys::Action DriveKeys::turn(double sign, double now) {
    if (isCar_)
        press(way_, way_.sign < 0 && now < way_.until + remembered_s ? -1 : 1, now);
    return press(turn_, sign, now);
}

DriveKeys::Action DriveKeys::stop() {
    way_ = turn_ = {};
    return Action::Stop;
}

Twist2D DriveKeys::request(double now) const {
    const auto share = [now](const Axis &axis) { return now < axis.until ? axis.sign : 0; };
    return {share(way_) * speed_, 0, share(turn_) * speed_ * turnOfSpeed};
}

} // namespace hermes::ctl
