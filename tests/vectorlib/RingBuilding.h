#pragma once

#include "tests/vectorlib/DrawnBuilding.h"

/// A building drawn at random in which much looks alike: a corridor around a block, with rooms of one size
/// and shape along its outer side, some of them furnished; metres. The same state of the generator gives the
/// same building.
class RingBuilding : public DrawnBuilding {
public:
    explicit RingBuilding(std::mt19937 &random)
        : DrawnBuilding(random)
        , width_(between(1.8, 2.6))
        , pitch_(between(3, 4.5))
        , depth_(between(3, 4.5))
        , door_(between(0.4, pitch_ - 1.6))
        , a_(pitch_ * double(4 + any(3)) - 2 * width_)
        , b_(pitch_ * double(2 + any(3)) - 2 * width_ + pitch_) {
        box({0, 0}, {a_, b_});
        const Point corners[] = {
            {-width_, -width_}, {a_ + width_, -width_}, {a_ + width_, b_ + width_}, {-width_, b_ + width_}};
        for (int i = 0; i < 4; ++i)
            roomsAlong(corners[i], corners[(i + 1) % 4]);
    }

    /// Around the corridor, counter-clockwise, as often as asked for, into a room now and then; a pose about
    /// every 30 cm.
    std::vector<vectorlib::Pose2D> drive(int rounds) {
        const double m = width_ / 2;
        const Point corners[] = {{-m, -m}, {a_ + m, -m}, {a_ + m, b_ + m}, {-m, b_ + m}};
        DriveWay way({-m, -m, 0}, 0.3);
        for (int side = 0; side < 4 * rounds; ++side) {
            const Point to = corners[(side + 1) % 4];
            for (const Door &door : doors_[std::size_t(side % 4)])
                if (any(4) == 0)
                    visit(door, way);
            way.goTo(to);
        }
        return way.poses();
    }

private:
    // Outside of the wall from one corner of the corridor to the next.
    void roomsAlong(Point from, Point to) {
        const Point along = (to - from) * (1 / (to - from).norm()), out(along.y, -along.x);
        const int rooms = int((to - from).norm() / pitch_);
        doors_.emplace_back();
        wall(from + along * (pitch_ * rooms), to);
        for (int i = 0; i <= rooms; ++i)
            wall(from + along * (pitch_ * i), from + along * (pitch_ * i) + out * depth_);
        for (int i = 0; i < rooms; ++i) {
            const Point corner = from + along * (pitch_ * i);
            const auto at = [&](double x, double y) { return corner + along * x + out * y; };
            constexpr double gap = 1;
            wall(at(0, 0), at(door_, 0));
            wall(at(door_ + gap, 0), at(pitch_, 0));
            wall(at(0, depth_), at(pitch_, depth_));
            doors_.back().push_back({at(door_ + gap / 2, -width_ / 2), at(door_ + gap / 2, depth_ / 2)});
            if (any(3) == 0) {
                const double x = between(0.2, pitch_ - 0.9), y = depth_ - between(0.1, 0.6);
                wall(at(x, y), at(x + 0.6, y));
                wall(at(x, y), at(x, y - 0.4));
                wall(at(x + 0.6, y), at(x + 0.6, y - 0.4));
                wall(at(x, y - 0.4), at(x + 0.6, y - 0.4));
            }
        }
    }

    double width_, pitch_, depth_, door_;  // of the corridor, the rooms, and a door's place in its room
    double a_, b_;                         // sides of the block
    std::vector<std::vector<Door>> doors_; // of each side
};
