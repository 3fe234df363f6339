#pragma once

#include "daemons/softwaretrigger/DayTime.h"

#include <QSocketNotifier>
#include <functional>
#include <memory>

namespace hermes::softwaretrigger {

/// Calls a function at a time of each day, by the clock of the system, which tells when it is set.
class DayAlarm : public QObject {
    Q_OBJECT
public:
    using Function = std::function<void(const DayTime::Verdict &)>;

    DayAlarm(const DayTime &time, Function function);
    ~DayAlarm() override;

private:
    void arm();
    void awake();

    DayTime time_;
    Function function_;
    int descriptor_;
    std::unique_ptr<QSocketNotifier> notifier_;
};

} // namespace hermes::softwaretrigger
