#include "daemons/softwaretrigger/Watch.h"

#include "common/Time.h"
#include "daemons/softwaretrigger/DayAlarm.h"
#include "daemons/softwaretrigger/TopicWatch.h"

#include <cmath>

namespace hermes::softwaretrigger {
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
