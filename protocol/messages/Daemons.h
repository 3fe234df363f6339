#pragma once

#include "protocol/wire/FieldsOf.h"

#include <QJsonObject>
#include <QStringList>
#include <vector>

namespace hermes {

/// What daemon.info gives.
struct DaemonInfo {
    QString name, title, version, protocol;
    QString descriptionHash; ///< changes when anything in the description changes
    QString host;
    qint64 pid = 0;
    QStringList listen;
    double started = 0, uptime_s = 0;
    QString role; ///< of who asks
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

const Fields<DaemonInfo> &fieldsOf(Of<DaemonInfo>);
const Fields<HealthItem> &fieldsOf(Of<HealthItem>);
const Fields<DaemonStatus> &fieldsOf(Of<DaemonStatus>);
const Fields<LogMessage> &fieldsOf(Of<LogMessage>);
const Fields<SettingsChange> &fieldsOf(Of<SettingsChange>);
const Fields<SavedSettings> &fieldsOf(Of<SavedSettings>);
const Fields<TopicDescription> &fieldsOf(Of<TopicDescription>);
const Fields<SubscriptionAnswer> &fieldsOf(Of<SubscriptionAnswer>);

} // namespace hermes
