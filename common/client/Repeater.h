#pragma once

#include "common/channel/Channel.h"

#include <QHash>
#include <QObject>
#include <QTimer>

namespace hermes {

/// Sends requests again, as they were, while no reply has come over a line that loses some: after a time that
/// follows from how long replies took, then after half as long again each time, up to longestPeriod_s. What
/// is urgent does not wait for that: at first it is sent again as soon as the one before is through.
class Repeater : public QObject {
    Q_OBJECT
public:
    static constexpr double longestPeriod_s = 0.5; ///< and what the line takes

    explicit Repeater(QObject *parent);

    void add(Channel &channel, qint64 id, const Sent &request, Channel::Rank rank);
    /// isAnswered: a reply has come; else nobody wants one any more.
    void end(qint64 id, bool isAnswered);
    void clear();
    quint64 repeats() const { return repeats_; }

private:
    struct Request {
        Sent sent;
        Channel::Rank rank = Channel::Rank::Usual;
        double sentAt = 0, dueAt = 0, period_s = 0;
        int hurried = 0; // repeats to come that wait for no reply; not above 0: none
        bool isRepeated = false;
    };

    double period(int bytes) const;
    double onLine_s(int bytes) const;
    void repeatDue();
    void repeat(Request &request, double now);
    void wakeAt(double due);

    Channel *channel_ = nullptr;
    QHash<qint64, Request> requests_;
    QTimer timer_;
    double wakesAt_ = 0;
    double roundTrip_s_ = 0, deviation_s_ = 0; // of requests that were not repeated; 0: none as yet
    quint64 repeats_ = 0;
};

} // namespace hermes
