#include "gui/desktop/view/ValueAxis.h"

#include <algorithm>
#include <cmath>

namespace hermes::desktop {
namespace {

constexpr double largestRange = 1e16; // of a range

/// How often a step fits between two values, counted from 0.
double countOf(double least, double most, double step) {
    return std::floor(most / step + 1e-9) - std::ceil(least / step - 1e-9) + 1;
}

/// The finest of 1, 2 or 5 times a power of ten that gives no more than so many ticks.
double roundStep(double least, double most, int count) {
    double power = std::pow(10, std::floor(std::log10((most - least) / count)) - 1);
    for (int i = 0; i < 4; ++i, power *= 10)
        for (const double factor : {1, 2, 5})
            if (countOf(least, most, factor * power) <= count)
                return factor * power;
    return power;
}

} // namespace

void ValueAxis::fit(double least, double most) {
    if (!isAutomatic_ || !(least <= most))
        return;
    const double margin = std::max(0.06 * (most - least), 1e-3 * std::max(1.0, std::abs(most)));
    least_ = least - margin;
    most_ = most + margin;
}

void ValueAxis::zoom(double factor, double share) {
    const double fixed = least_ + share * (most_ - least_);
    // No finer than numbers are, no wider than they are kept.
    const double finest = 1e-12 * std::max({std::abs(least_), std::abs(most_), 1e-6});
    const double range = std::clamp((most_ - least_) / factor, finest, largestRange);
    least_ = fixed - share * range;
    most_ = least_ + range;
    isAutomatic_ = false;
}

void ValueAxis::pan(double share) {
    const double way = share * (most_ - least_);
    if (std::abs(least_ + way) > largestRange || std::abs(most_ + way) > largestRange)
        return;
    least_ += way;
    most_ += way;
    isAutomatic_ = false;
}

std::vector<Tick> ticks(double least, double most, int count) {
    std::vector<Tick> found;
    const double range = most - least;
    if (!(range > 0) || !std::isfinite(range) || count < 1)
        return found;
    const double step = roundStep(least, most, count);
    const bool isShort = std::max(std::abs(least), std::abs(most)) < 1e6 && step >= 1e-6;
    const int decimals = std::max(0, int(std::ceil(-std::log10(step) - 1e-9)));
    for (double i = std::ceil(least / step - 1e-9); i * step <= most + 1e-9 * range; ++i) {
        if (int(found.size()) >= count)
            break; // the step is below what numbers of this size can tell apart
        const double value = i == 0 ? 0 : i * step;
        const int digits = std::clamp(int(std::ceil(std::log10(std::abs(value) / step + 1))), 1, 12);
        found.push_back(
            {value, isShort ? QString::number(value, 'f', decimals) : QString::number(value, 'g', digits)});
    }
    return found;
}

} // namespace hermes::desktop
