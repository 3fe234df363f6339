#pragma once

#include "daemons/softwaretrigger/Definition.h"
#include "daemons/softwaretrigger/GpioLines.h"
#include "daemons/softwaretrigger/Pulses.h"
#include "daemons/softwaretrigger/SerialLines.h"
#include "daemons/softwaretrigger/Targets.h"

namespace hermes::softwaretrigger {

/// Does what triggers do. No action waits for another.
class ActionRunner : public QObject {
    Q_OBJECT
public:
    using Done = std::function<void(const Result<QJsonValue> &)>;

    explicit ActionRunner(QObject *parent);

    /// Connects to the daemons and opens the lines that these name, and ends what they do not name.
    void use(const std::vector<TriggerDefinition> &definitions);
    /// done is called once, within the time that the action allows.
    void run(const ActionDefinition &action, const Done &done);

    Targets &targets() { return targets_; }
    const Targets &targets() const { return targets_; }
    const SerialLines &serialLines() const { return serialLines_; }

private:
    Targets targets_;
    SerialLines serialLines_;
    GpioLines gpioLines_;
    Pulses pulses_;
};

} // namespace hermes::softwaretrigger
