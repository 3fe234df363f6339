#include "daemons/supervisor/ProcessFamily.h"

#include <QDir>
#include <csignal>

namespace hermes::supervisor {
namespace {

constexpr int mostPasses = 10; // a member may start another one meanwhile

/// As the system shows it: of other users' processes nothing.
bool isMember(const QString &pid, const QByteArray &assignment) {
    QFile environment("/proc/" + pid + "/environ");
    return environment.open(QIODevice::ReadOnly) && environment.readAll().split('\0').contains(assignment);
}

} // namespace

void ProcessFamily::end(const QString &name) {
    const QByteArray assignment = QByteArray(variable) + '=' + name.toUtf8();
    for (int pass = 0; pass < mostPasses; ++pass) {
        int found = 0;
        for (const QString &pid : QDir("/proc").entryList({"[0-9]*"}, QDir::Dirs))
            if (isMember(pid, assignment)) // a process that has ended has no environment
                found += ::kill(pid.toInt(), SIGKILL) == 0;
        if (found == 0)
            return;
    }
}

} // namespace hermes::supervisor
