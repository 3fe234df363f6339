#pragma once

#include "gui/desktop/model/Fleet.h"
#include "gui/desktop/model/Freshness.h"

namespace hermes::desktop {

/// How often a topic is published, and how old its newest message is, from a few of its messages: they are
/// numbered.
class TopicMeter {
public:
    /// At so few messages of a topic a second; fewer of one that may be large.
    static constexpr double rate_hz = 2, heavyRate_hz = 0.5;

    /// `see` gets the messages.
    TopicMeter(DaemonLink *daemon, const QString &topic, double maxRate_hz, Client::TopicCallback see);
    TopicMeter(const TopicMeter &) = delete;
    TopicMeter &operator=(const TopicMeter &) = delete;

    const Freshness &freshness() const { return freshness_; }
    /// "50 Hz, 0.2 s", or "no data for 3 s"; empty: nothing has come.
    QString text() const;

private:
    void take(const TopicUpdate &update);

    QPointer<DaemonLink> daemon_;
    Subscription subscription_;
    const Client::TopicCallback see_;
    Freshness freshness_;
    double measured_hz_ = -1; ///< not known as yet
    double since_ = 0;        ///< on this computer's clock that never jumps: when the count began
    quint64 first_ = 0;
};

/// "50 Hz", "2.5 Hz", "0.1 Hz".
QString rateText(double rate_hz);
/// "0.2 s", "3 min 20 s".
QString ageText(double age_s);

} // namespace hermes::desktop
