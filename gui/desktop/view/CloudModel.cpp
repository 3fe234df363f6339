#include "gui/desktop/view/CloudModel.h"

#include "gui/desktop/widgets/ForeignText.h"
#include "protocol/wire/Fields.h"

#include <algorithm>
#include <cmath>

namespace hermes::desktop {
namespace {

constexpr int longestModel = 20;

/// The shown value, until the new one is off by more than the play.
float followed(float shown, float now, float play) {
    return std::abs(now - shown) > play ? now : shown;
}

/// The value that so many of them (0 to 1) lie below; changes their order.
float quantile(std::vector<float> &values, double part) {
    const auto at = values.begin() + std::ptrdiff_t(part * double(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

} // namespace

CloudModel::CloudModel(Fleet &fleet, QObject *parent)
    : QObject(parent)
    , feed_(
          fleet, "cloud", {{"max_rate_hz", maxRate_hz}},
          [this](const TopicUpdate &update) {
              ReadReport report;
              if (const auto message = readMessage<CloudMessage>(update.data, report))
                  return take(*message);
              ++ignored_;
              Q_EMIT changed();
          },
          this) {
    feed_.setEnabled(false);
    connect(&feed_, &TopicFeed::sourceChanged, this, &CloudModel::forget);
    ageing_.setInterval(100);
    connect(&ageing_, &QTimer::timeout, this, [this] {
        if (std::exchange(shownAge_, age_.state()) != age_.state())
            Q_EMIT changed();
    });
}

void CloudModel::setEnabled(bool isEnabled) {
    isEnabled_ = isEnabled;
    feed_.setEnabled(isEnabled);
    isEnabled ? ageing_.start() : ageing_.stop();
}

void CloudModel::forget() {
    points_.clear();
    age_.forget();
    lidar_.clear();
    beams_ = ignored_ = 0;
    Q_EMIT changed();
}

void CloudModel::take(const CloudMessage &cloud) {
    const std::size_t count = std::min({cloud.x.size(), cloud.y.size(), cloud.z.size(), maxPoints});
    const std::size_t most = std::max({cloud.x.size(), cloud.y.size(), cloud.z.size()});
    const auto isSeen = [](float value) { return std::abs(value) <= farthest_m; }; // NaN is not
    points_.clear();
    points_.reserve(count);
    int lasers = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const quint8 intensity = i < cloud.intensity.size() ? cloud.intensity[i] : quint8(0);
        if (isSeen(cloud.x[i]) && isSeen(cloud.y[i]) && isSeen(cloud.z[i]))
            points_.push_back({cloud.x[i], cloud.y[i], cloud.z[i], intensity});
        if (i < cloud.laser.size())
            lasers = std::max(lasers, cloud.laser[i] + 1);
    }
    ignored_ += most - points_.size();
    lidar_ = shortLine(cloud.model, longestModel);
    beams_ = cloud.header.rays.value_or(0) * quint64(lasers);
    isReplayed_ = cloud.header.replayed;
    age_.heard(feed_.source());
    measure();
    Q_EMIT changed();
}

void CloudModel::measure() {
    constexpr std::size_t enough = 2000;
    if (points_.empty())
        return;
    // Odd, for points come in rounds of 16 or 32 lasers, of which all are to be looked at.
    const std::size_t step = (points_.size() / enough) | 1;
    const auto sampled = [&](const auto &value) -> std::vector<float> & {
        sample_.clear();
        for (std::size_t i = 0; i < points_.size(); i += step)
            sample_.push_back(value(points_[i]));
        return sample_;
    };
    auto &heights = sampled([](const CloudPoint &p) { return p.z; });
    constexpr float play_m = 0.3F, least_m = 0.5F;
    lowest_m_ = followed(lowest_m_, quantile(heights, 0.02), play_m);
    highest_m_ = std::max(followed(highest_m_, quantile(heights, 0.98), play_m), lowest_m_ + least_m);
    reach_m_ = followed(reach_m_,
                        quantile(sampled([](const CloudPoint &p) { return std::hypot(p.x, p.y); }), 0.9), 1);
}

QString CloudModel::summary() const {
    if (age_.state() == Freshness::State::None)
        return {};
    const QString points = beams_ > points_.size()
                               ? tr("%1 points of %2 beams").arg(points_.size()).arg(beams_)
                               : tr("%1 points").arg(points_.size());
    return lidar_ + ": " + points + (isReplayed_ ? tr(", replayed") : QString()) +
           (ignored_ > 0 ? tr(", %1 impossible values are not shown").arg(ignored_) : QString());
}

} // namespace hermes::desktop
