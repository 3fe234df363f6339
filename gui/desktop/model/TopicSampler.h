#pragma once

#include "gui/desktop/model/Fleet.h"

#include <QPointF>
#include <deque>
#include <map>
#include <set>

namespace hermes::desktop {

/// One number in the messages of a topic, e.g. {"127.0.0.1:7410", "odometry", "pose.x"}.
struct FieldId {
    QString address, topic, path;

    bool operator<(const FieldId &other) const {
        return std::tie(address, topic, path) < std::tie(other.address, other.topic, other.path);
    }
};

/// The dotted paths of the numbers in a message, those in short lists too ("current_a.0"); no more than so
/// many.
QStringList numericPaths(const QJsonValue &message, int most);
/// The value at such a path; undefined where there is none.
QJsonValue fieldAt(const QJsonValue &message, const QString &path);

/// Keeps the last minutes of the chosen fields. A topic is subscribed to while a field of it is chosen.
class TopicSampler : public QObject {
    Q_OBJECT
public:
    static constexpr double keep_s = 600;
    static constexpr double maxRate_hz = 20;
    static constexpr std::size_t mostSamples = std::size_t(2 * keep_s * maxRate_hz);
    /// Beyond it a value is not kept: no axis can show it.
    static constexpr double largest = 1e15;

    using QObject::QObject;
    ~TopicSampler() override;

    void add(DaemonLink *daemon, const FieldId &field);
    void remove(const FieldId &field);
    /// {stamp, value}, oldest first.
    const std::deque<QPointF> &samples(const FieldId &field) const;
    const std::map<FieldId, std::deque<QPointF>> &all() const { return fields_; }
    /// Values or stamps beyond `largest`, and messages without a number at a chosen field.
    quint64 unusable() const { return unusable_; }

private:
    struct Source {
        QPointer<DaemonLink> daemon;
        int handle = 0;
    };
    using TopicId = std::pair<QString, QString>; // address, topic

    void take(const TopicId &topic, const TopicUpdate &update);

    std::map<FieldId, std::deque<QPointF>> fields_;
    std::map<TopicId, Source> sources_;
    quint64 unusable_ = 0;
};

} // namespace hermes::desktop
