#pragma once

#include "protocol/wire/FieldsOf.h"

#include <QJsonObject>
#include <QStringList>

#include <optional>
#include <vector>

namespace hermes {

/// What a process is started with: an element of the supervisor's setting `processes`.
struct ProcessEntry {
    QString name;
    QString program; ///< a path, or a name that is looked for beside the supervisor and then in PATH
    QStringList arguments;
    quint16 port = 0; ///< where its commands are accepted, for those who look for it; 0: none
    bool autostart = false;

    bool operator==(const ProcessEntry &other) const {
        return name == other.name && program == other.program && arguments == other.arguments &&
               port == other.port && autostart == other.autostart;
    }
};

/// A process and how it is.
struct ProcessStatus {
    ProcessEntry entry;
    QString state;
    qint64 pid = 0; ///< 0: it does not run
    int restarts = 0;
    QString lastExit;
    std::optional<double> nextStart_s, uptime_s, cpu;
    std::optional<qint64> memory_bytes;
};

/// The topic `processes`, and what process.list gives.
struct ProcessesMessage {
    QString robot;
    std::vector<ProcessStatus> processes;
};

Fields<ProcessEntry> fieldsOf(Of<ProcessEntry>);
Fields<ProcessStatus> fieldsOf(Of<ProcessStatus>);
Fields<ProcessesMessage> fieldsOf(Of<ProcessesMessage>);

/// What tells a robot from all others: its id, a UUID, whatever people call it.
struct RobotIdentity {
    QString id, name;
};

/// What daemon.info gives.
struct DaemonInfo {
    QString name, title, version, protocol;
    QString descriptionHash; ///< changes when anything in the description changes
    QString host;
    qint64 pid = 0;
    QStringList listen;
    double started = 0, uptime_s = 0;
    QString role;                       ///< of who asks
    std::optional<RobotIdentity> robot; ///< of which it is; none: it was not told
};

/// One thing of a daemon that is well or not.
struct HealthItem {
    QString name, level, message;
    QJsonObject values; ///< what stands behind the message
    double age_s = 0;
};

/// The topic `status`, and what daemon.status gives.
struct DaemonStatus {
    QString state;
    std::vector<HealthItem> health;
    QStringList restartFor;
};

/// The topic `log`, and of what log.tail gives a list.
struct LogMessage {
    double stamp = 0;
    QString level, source, text;
};

/// The topic `commands`, and a line of the audit: a command that was carried out or refused, or several of
/// them summed up.
struct CommandMessage {
    double stamp = 0;
    QString client, role, method;
    std::optional<QJsonValue> params;
    std::optional<int> error;
    std::optional<QString> message;
    std::optional<int> calls;
};

/// What settings.set and settings.reset give: dotted paths.
struct SettingsChange {
    QStringList changed, restart;
};

/// What settings.save gives.
struct SavedSettings {
    QString path;
};

/// Of what topics.list gives a list.
struct TopicDescription {
    QString name, summary;
    QJsonObject schema;
    bool snapshot = false;
};

/// What topics.subscribe gives.
struct SubscriptionAnswer {
    quint64 subscription = 0;
};

Fields<RobotIdentity> fieldsOf(Of<RobotIdentity>);
Fields<DaemonInfo> fieldsOf(Of<DaemonInfo>);
Fields<HealthItem> fieldsOf(Of<HealthItem>);
Fields<DaemonStatus> fieldsOf(Of<DaemonStatus>);
Fields<LogMessage> fieldsOf(Of<LogMessage>);
Fields<CommandMessage> fieldsOf(Of<CommandMessage>);
Fields<SettingsChange> fieldsOf(Of<SettingsChange>);
Fields<SavedSettings> fieldsOf(Of<SavedSettings>);
Fields<TopicDescription> fieldsOf(Of<TopicDescription>);
Fields<SubscriptionAnswer> fieldsOf(Of<SubscriptionAnswer>);

} // namespace hermes
