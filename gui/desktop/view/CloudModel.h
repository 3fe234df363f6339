#pragma once

#include "gui/desktop/model/Freshness.h"
#include "gui/desktop/model/TopicFeed.h"
#include "protocol/messages/Turns.h"

#include <QTimer>
#include <vector>

namespace hermes::desktop {

/// A point that a lidar has measured: metres in the sensor's frame (x ahead, y left, z up), and how much of
/// the light came back.
struct CloudPoint {
    float x, y, z;
    quint8 intensity;
};

/// The last turn of the chosen robot's lidar, as the topic `cloud` tells it. It is subscribed to only while
/// somebody looks. Nothing that comes is trusted to make sense.
class CloudModel : public QObject {
    Q_OBJECT
public:
    static constexpr std::size_t maxPoints = 100000;
    static constexpr double maxRate_hz = 20; // lidars turn no faster
    /// No lidar sees farther (m).
    static constexpr float farthest_m = 1000;

    explicit CloudModel(Fleet &fleet, QObject *parent = nullptr);

    /// Switched off it costs nothing on the link; what was shown is forgotten.
    void setEnabled(bool isEnabled);
    bool isEnabled() const { return isEnabled_; }
    void take(const CloudMessage &cloud);

    const std::vector<CloudPoint> &points() const { return points_; }
    /// Between these heights lie nearly all points (m), and from the sensor nearly all of them to this
    /// distance on the level. They follow the cloud with a little play, so that colours stand still.
    float lowest_m() const { return lowest_m_; }
    float highest_m() const { return highest_m_; }
    float reach_m() const { return reach_m_; }
    /// "HDL-32E: 8012 points of 69440 beams"; empty before the first turn.
    QString summary() const;
    const Freshness &age() const { return age_; }
    /// Values that are no numbers or farther than any lidar sees, and messages that are no clouds.
    quint64 ignored() const { return ignored_; }
    /// Who sends it; null: nobody has the topic.
    DaemonLink *source() const { return feed_.source(); }

Q_SIGNALS:
    void changed();

private:
    void forget();
    void measure();

    std::vector<CloudPoint> points_;
    std::vector<float> sample_; // of measure(), kept for the next turn
    float lowest_m_ = -1, highest_m_ = 1, reach_m_ = 10;
    QString lidar_;
    quint64 beams_ = 0; // of the whole turn; 0: not told
    bool isReplayed_ = false, isEnabled_ = false;
    Freshness age_;
    Freshness::State shownAge_ = Freshness::State::None;
    QTimer ageing_; // shows that nothing comes
    quint64 ignored_ = 0;
    TopicFeed feed_;
};

} // namespace hermes::desktop
