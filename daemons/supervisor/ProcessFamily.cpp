#include "daemons/supervisor/ProcessFamily.h"

#include <QDir>
#include <QFile>
#include <QSet>
#include <csignal>
#include <sys/syscall.h>
#include <unistd.h>

namespace hermes::supervisor {
namespace {

constexpr int maxPasses = 10; // a member may start another one meanwhile

/// As the system shows it: of other users' processes nothing.
bool isMember(const QString &pid, const QByteArray &assignment) {
    QFile environment("/proc/" + pid + "/environ");
    return environment.open(QIODevice::ReadOnly) && environment.readAll().split('\0').contains(assignment);
}

/// Whether it was a member; then it is killed, and no other that gets its number meanwhile.
bool killMember(const QString &pid, const QByteArray &assignment) {
    const auto process = int(::syscall(SYS_pidfd_open, pid.toInt(), 0));
    const bool found = process >= 0 && isMember(pid, assignment);
    if (found)
        ::syscall(SYS_pidfd_send_signal, process, SIGKILL, nullptr, 0);
    if (process >= 0)
        ::close(process);
    return found;
}

} // namespace

void ProcessFamily::end(const QString &name) {
    const QByteArray assignment = QByteArray(variable) + '=' + name.toUtf8();
    QSet<QString> killed; // some may take a while
    for (int pass = 0; pass < maxPasses; ++pass) {
        const auto before = killed.size();
        for (const QString &pid : QDir("/proc").entryList({"[0-9]*"}, QDir::Dirs))
            if (!killed.contains(pid) && killMember(pid, assignment))
                killed.insert(pid);
        if (killed.size() == before)
            return;
    }
}

} // namespace hermes::supervisor
