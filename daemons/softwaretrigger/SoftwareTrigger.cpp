#include "daemons/softwaretrigger/SoftwareTrigger.h"
#include "common/settings/SettingsTable.h"
#include "protocol/wire/Fields.h"

namespace hermes::softwaretrigger {

SoftwareTrigger::SoftwareTrigger()
    : Daemon({"softwaretrigger", "Software trigger",
              "Fires triggers by period, distance, time of day, a condition on any topic, or command; each "
              "calls commands of daemons, writes to serial lines or pulses lines"}) {
    declareSettings();
    addTopic(Topic("fired", "Each firing, when its last action has ended").carries<FiringMessage>());
    declareCommands();
}

SoftwareTrigger::~SoftwareTrigger() {
    stop();
}

void SoftwareTrigger::declareSettings() {
    SettingsTable table;
    table.group("Triggers");
    table.defineList("triggers", "The definitions; trigger.define adds and changes one", triggerSchema())
        .with("maxItems", 100);
    table.group("Log of firings", SettingsTable::Applies::OnRestart);
    table.define("firings.folder", "", "Folder of the CSV log of all firings; empty: none");
    table.define("firings.file_bytes", 1e8, "Size at which the log goes on in a new file", "B", 1000, 1e12);
    table.declareIn(settings());
    settings().addRule(checkTriggers);
}

Result<void> SoftwareTrigger::start() {
    engine_ = new TriggerEngine(settings().text("firings.folder"), settings().number("firings.file_bytes"));
    const auto publishIt = [this](const FiringMessage &firing) {
        const auto inMainThread = [this, firing] { publish("fired", firing, firing.stamp); };
        QMetaObject::invokeMethod(this, inMainThread, Qt::QueuedConnection);
    };
    connect(engine_, &TriggerEngine::fired, engine_, publishIt);
    engine_->moveToThread(&thread_);
    connect(&thread_, &QThread::finished, engine_, &QObject::deleteLater);
    thread_.setObjectName("triggers");
    thread_.start();
    inEngine([](TriggerEngine &engine) { engine.start(); });
    settingsChanged({"triggers"});
    provideHealth();
    setState(DaemonState::Running);
    return {};
}

void SoftwareTrigger::stop() {
    if (!engine_)
        return;
    for (const QString &item : TriggerEngine::healthItems())
        health().remove(item);
    inEngine([](TriggerEngine &engine) { engine.stop(); });
    engine_ = nullptr;
    thread_.quit();
    thread_.wait();
}

void SoftwareTrigger::settingsChanged(const QStringList &paths) {
    if (paths.contains("triggers"))
        inEngine(
            [wanted = definitions(settings().values())](TriggerEngine &engine) { engine.apply(wanted); });
}

void SoftwareTrigger::provideHealth() {
    for (const QString &item : TriggerEngine::healthItems()) {
        health().provide(item, [this, item] {
            EngineHealth report;
            inEngine([&](TriggerEngine &engine) { report = engine.health(item); });
            health().set(item, report.level, report.message, report.values);
        });
    }
}

} // namespace hermes::softwaretrigger
