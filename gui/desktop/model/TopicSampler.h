#pragma once

#include "gui/desktop/model/Fleet.h"
#include "gui/desktop/model/Freshness.h"
#include "gui/desktop/model/TopicFields.h"

#include <QPointF>
#include <deque>
#include <map>

namespace hermes::desktop {

/// {stamp, value}, oldest first.
using Samples = std::deque<QPointF>;

/// Keeps the last minutes of the chosen fields. A topic is subscribed to while a field of it is chosen and
/// its daemon is known.
class TopicSampler : public QObject {
    Q_OBJECT
public:
    static constexpr double keep_s = 600;
    static constexpr double maxRate_hz = 20;
    static constexpr std::size_t maxSamples = std::size_t(2 * keep_s * maxRate_hz);
    /// Beyond it a value is not kept: no axis can show it.
    static constexpr double largest = 1e15;
    /// A stamp that is older than the one before by no more than this came late, and is left out; else the
    /// topic begins anew: a replay went back, or a clock was set.
    static constexpr double late_s = 0.5;
    /// Stamps that lie further from now are of a recording, or of a robot whose clock is wrong.
    static constexpr double recorded_s = 60;

    explicit TopicSampler(Fleet &fleet, QObject *parent = nullptr);

    void add(const FieldId &field);
    void remove(const FieldId &field);
    const Samples &samples(const FieldId &field) const;
    const std::map<FieldId, Samples> &all() const { return fields_; }
    /// How old the newest message of its topic is.
    const Freshness &freshness(const FieldId &field) const { return source(field).freshness; }
    /// Which topics have the same clock: those of one host, apart the ones of now and of a recording. Empty:
    /// nothing has come.
    QString clock(const FieldId &field) const { return source(field).clock; }
    bool isRecorded(const FieldId &field) const { return source(field).isRecorded; }
    /// What time it is on a clock. That of now goes on by itself, that of a recording stands with it.
    double now(const QString &clock) const;
    /// Values beyond `largest`, and messages without a number at a chosen field.
    quint64 unusable() const { return unusable_; }

private:
    struct Source {
        QPointer<DaemonLink> daemon;
        Subscription subscription;
        Freshness freshness;
        QString clock;      ///< empty: nothing has come
        double newest = 0;  ///< stamp
        double arrived = 0; ///< of that, on this computer's clock that never jumps
        bool isRecorded = false;
    };
    using TopicId = std::pair<QString, QString>; // address, topic

    void followAll();
    void take(const TopicId &topic, const TopicUpdate &update);
    void keep(Samples &samples, const QPointF &sample);
    const Source &source(const FieldId &field) const;

    Fleet &fleet_;
    std::map<FieldId, Samples> fields_;
    std::map<TopicId, Source> sources_;
    quint64 unusable_ = 0;
};

} // namespace hermes::desktop
