#include "daemons/softwaretrigger/Watch.h"
#include "common/Time.h"
#include "daemons/softwaretrigger/TopicWatch.h"
#include "protocol/wire/Fields.h"

#include <QJsonArray>
#include <QJsonObject>

#include <algorithm>
#include <utility>

namespace hermes::softwaretrigger {

namespace {

constexpr double noise = 1e-3;     // m or rad
constexpr double allowance = 0.05; // m or rad that a step may exceed what the speed explains

} // namespace

Fields<TravelPoint> fieldsOf(Of<TravelPoint>) {
    return Fields<TravelPoint>()
        .add("pose", &TravelPoint::pose, "As in odometry")
        .add("twist", &TravelPoint::twist, "As in odometry")
        .add("mono", &TravelPoint::mono, "As in odometry", "s");
}

Result<std::optional<Travel::Passed>> Travel::add(WireView message) {
    ReadReport report;
    const auto now = readMessage<TravelPoint>(message, report);
    if (!now)
        return Error(ErrorCode::InvalidParams, "no odometry: " + report.text());
    if (last_) {
        const double fastest = std::max(speed(*last_), speed(*now));
        const double explained = 2 * fastest * (now->mono - last_->mono) + allowance;
        if (now->mono <= last_->mono || between(*last_, *now) > explained) {
            ++jumps_;
            last_.reset();
        }
    }
    if (!last_) {
        sum_ += pending_;
        anchor_ = now;
    }
    last_ = now;
    pending_ = between(*anchor_, *now);
    if (pending_ >= noise) {
        sum_ += pending_;
        pending_ = 0;
        anchor_ = now;
    }
    // One part in 1e9: the sum of many small steps may fall short by rounding.
    const auto reached = quint64(std::floor(total() / step_ * (1 + 1e-9)));
    if (reached <= passed_)
        return std::optional<Passed>();
    const Passed result{reached, reached - passed_ - 1, now->pose};
    passed_ = reached;
    return std::optional<Passed>(result);
}

QJsonValue lookUp(QJsonValue data, const QString &path) {
    if (path.isEmpty())
        return data;
    for (const QString &key : path.split('.')) {
        if (!data.isArray()) {
            data = data.toObject().value(key);
            continue;
        }
        bool isNumber = false;
        const int index = key.toInt(&isNumber);
        const QJsonArray array = data.toArray();
        data = isNumber && index >= 0 && index < array.size() ? array.at(index)
                                                              : QJsonValue(QJsonValue::Undefined);
    }
    return data;
}

std::optional<bool> Condition::holds(const QJsonValue &value) const {
    if (value.isUndefined())
        return std::nullopt;
    if (op_ == "==")
        return value == limit_;
    if (op_ == "!=")
        return value != limit_;
    if (!value.isDouble())
        return std::nullopt;
    const double number = value.toDouble(), limit = limit_.toDouble();
    if (op_ == "<")
        return number < limit;
    if (op_ == "<=")
        return number <= limit;
    return op_ == ">" ? number > limit : number >= limit;
}

std::optional<bool> Condition::becomesTrue(const QJsonValue &data) {
    const auto now = holds(lookUp(data, path_));
    if (!now)
        return std::nullopt;
    return !std::exchange(held_, *now) && *now;
}

namespace {

class PeriodWatch : public Watch {
public:
    PeriodWatch(Schedule &schedule, double period_s, const Listener &listener)
        : schedule_(schedule)
        , key_(schedule.add(
              std::chrono::nanoseconds(std::llround(period_s * 1e9)), [listener](const Schedule::Due &due) {
                  const double time = std::chrono::duration<double>(due.time.time_since_epoch()).count();
                  FiringCause cause;
                  cause.n = due.n;
                  cause.dueMono = time;
                  listener.fire({time, {}, due.missed, cause});
              })) {}
    ~PeriodWatch() override { schedule_.remove(key_); }

private:
    Schedule &schedule_;
    quint64 key_;
};

class TimeOfDayWatch : public Watch {
public:
    TimeOfDayWatch(const QTime &at, bool utc, const Listener &listener)
        : alarm_(DayTime(at, utc, stampNow()), [this, listener](const DayTime::Verdict &verdict) {
            if (!verdict.fires) {
                ++missed_;
                return listener.missed();
            }
            FiringCause cause;
            cause.due = verdict.due;
            listener.fire({{}, verdict.due, std::exchange(missed_, 0), cause});
        }) {}

private:
    quint64 missed_ = 0;
    DayAlarm alarm_;
};

} // namespace

std::unique_ptr<Watch> Watch::make(const TriggerDefinition &definition, Schedule &schedule, Targets &targets,
                                   const Listener &listener) {
    switch (definition.cause()) {
    case Cause::Period:
        return std::make_unique<PeriodWatch>(schedule, definition.number("period_s"), listener);
    case Cause::TimeOfDay:
        return std::make_unique<TimeOfDayWatch>(timeOfDay(definition.text("at")),
                                                definition.text("zone") == "utc", listener);
    case Cause::Distance:
    case Cause::Angle:
        return std::make_unique<TravelWatch>(definition, targets.client(watchedDaemon(definition)), listener);
    case Cause::Condition:
        return std::make_unique<ConditionWatch>(definition, targets.client(watchedDaemon(definition)),
                                                listener);
    case Cause::Trigger:
    case Cause::Command:
        break;
    }
    return nullptr;
}

QString watchedDaemon(const TriggerDefinition &definition) {
    return definition.text("daemon"); // only the causes that watch a topic have it
}

} // namespace hermes::softwaretrigger
