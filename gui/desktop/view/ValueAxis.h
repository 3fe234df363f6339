#pragma once

#include <QString>
#include <vector>

namespace hermes::desktop {

/// The range of values that a chart shows: that of its curves, until somebody zooms.
class ValueAxis {
public:
    double least() const { return least_; }
    double most() const { return most_; }
    bool isAutomatic() const { return isAutomatic_; }

    /// Shows these with a margin; does nothing after zoom() and pan(), until automate().
    void fit(double least, double most);
    /// By a factor about the value at this share of the height, from below.
    void zoom(double factor, double share);
    /// By a share of the height.
    void pan(double share);
    void automate() { isAutomatic_ = true; }

private:
    double least_ = 0, most_ = 1;
    bool isAutomatic_ = true;
};

/// Round values within the range with their texts, no more than so many.
struct Tick {
    double value;
    QString text;
};
std::vector<Tick> ticks(double least, double most, int count);

} // namespace hermes::desktop
