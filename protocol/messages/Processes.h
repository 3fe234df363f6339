#pragma once

#include "protocol/wire/FieldsOf.h"

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

const Fields<ProcessEntry> &fieldsOf(Of<ProcessEntry>);
const Fields<ProcessStatus> &fieldsOf(Of<ProcessStatus>);
const Fields<ProcessesMessage> &fieldsOf(Of<ProcessesMessage>);

} // namespace hermes
