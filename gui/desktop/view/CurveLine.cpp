#include "gui/desktop/view/CurveLine.h"

#include <algorithm>
#include <cmath>

namespace hermes::desktop {
namespace {

Samples::const_iterator firstFrom(const Samples &samples, double stamp) {
    return std::lower_bound(samples.begin(), samples.end(), stamp,
                            [](const QPointF &sample, double before) { return sample.x() < before; });
}

/// The time between two samples beyond which some are missing.
double gap_s(const Samples &samples) {
    if (samples.size() < 3)
        return TopicSampler::keep_s;
    const double usual = (samples.back().x() - samples.front().x()) / double(samples.size() - 1);
    return std::max(1.0, 5 * usual);
}

/// On the line from one sample to another.
QPointF between(const QPointF &one, const QPointF &other, double stamp) {
    const double share = (stamp - one.x()) / (other.x() - one.x());
    return {stamp, one.y() + share * (other.y() - one.y())};
}

/// The samples in one column of pixels.
class PixelColumn {
public:
    void take(const QPointF &point) {
        if (count_ == 0)
            first_ = lowest_ = highest_ = point;
        last_ = point;
        lowest_ = point.y() < lowest_.y() ? point : lowest_;
        highest_ = point.y() > highest_.y() ? point : highest_;
        ++count_;
    }
    bool holds(double column) const { return count_ > 0 && std::floor(first_.x()) == column; }
    void moveTo(QPolygonF &line) {
        if (count_ > 0)
            line.append(first_);
        if (count_ > 3) {
            line.append(lowest_.x() < highest_.x() ? lowest_ : highest_);
            line.append(lowest_.x() < highest_.x() ? highest_ : lowest_);
        } else if (count_ == 3) {
            line.append(lowest_ != first_ && lowest_ != last_ ? lowest_ : highest_);
        }
        if (count_ > 1)
            line.append(last_);
        count_ = 0;
    }

private:
    int count_ = 0;
    QPointF first_, last_, lowest_, highest_;
};

} // namespace

// Not further than a painter counts.
double ChartFrame::y(double value) const {
    constexpr double furthest = 20000;
    const double place = chart.bottom() - (value - least) / (most - least) * chart.height();
    return std::clamp(place, -furthest, furthest);
}

QVector<QPolygonF> curveLines(const Samples &samples, const ChartFrame &frame) {
    QVector<QPolygonF> lines(1);
    PixelColumn column;
    const auto take = [&](const QPointF &sample) {
        const QPointF point(frame.x(sample.x()), frame.y(sample.y()));
        if (!column.holds(std::floor(point.x())))
            column.moveTo(lines.last());
        column.take(point);
    };
    const double gap = gap_s(samples);
    auto sample = firstFrom(samples, frame.from);
    if (sample != samples.begin())
        --sample; // from which the line comes in
    for (auto before = sample; sample != samples.end(); before = sample++) {
        if (sample->x() - before->x() > gap) {
            column.moveTo(lines.last());
            lines.append(QPolygonF());
        } else if (before->x() < frame.from && sample->x() > frame.from) {
            take(between(*before, *sample, frame.from));
        }
        if (sample->x() >= frame.from && sample->x() <= frame.to)
            take(*sample);
        if (sample->x() <= frame.to)
            continue;
        if (before->x() < frame.to && sample->x() - before->x() <= gap)
            take(between(*before, *sample, frame.to));
        break;
    }
    column.moveTo(lines.last());
    return lines;
}

std::optional<QPointF> nearest(const Samples &samples, double stamp, double span_s) {
    constexpr double near = 0.02; // of the window
    const auto after = firstFrom(samples, stamp);
    if (samples.empty())
        return std::nullopt;
    const QPointF left = after == samples.begin() ? *after : *std::prev(after);
    const QPointF right = after == samples.end() ? left : *after;
    const QPointF found = std::abs(stamp - left.x()) < std::abs(right.x() - stamp) ? left : right;
    const bool isOnLine = left.x() <= stamp && stamp <= right.x() && right.x() - left.x() <= gap_s(samples);
    if (!isOnLine && std::abs(found.x() - stamp) > near * span_s)
        return std::nullopt;
    return found;
}

std::optional<std::pair<double, double>> extremes(const Samples &samples, double from, double to) {
    std::optional<std::pair<double, double>> found;
    for (auto sample = firstFrom(samples, from); sample != samples.end() && sample->x() <= to; ++sample) {
        if (!found)
            found = {sample->y(), sample->y()};
        found->first = std::min(found->first, sample->y());
        found->second = std::max(found->second, sample->y());
    }
    return found;
}

} // namespace hermes::desktop
