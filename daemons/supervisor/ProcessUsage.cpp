#include "daemons/supervisor/ProcessUsage.h"

#include <QFile>
#include <QList>
#include <unistd.h>

namespace hermes::supervisor {

std::optional<ProcessUsage> ProcessUsage::of(qint64 pid) {
    QFile stat(QString("/proc/%1/stat").arg(pid));
    if (pid <= 0 || !stat.open(QIODevice::ReadOnly))
        return std::nullopt;
    // The second field is the name in parentheses, which may hold blanks and parentheses itself.
    const QByteArray line = stat.readAll();
    const QList<QByteArray> fields = line.mid(line.lastIndexOf(')') + 2).split(' ');
    constexpr int userTime = 14 - 3, systemTime = 15 - 3,
                  residentPages = 24 - 3; // numbered as in proc(5), from 3
    if (fields.size() <= residentPages)
        return std::nullopt;
    ProcessUsage usage;
    usage.cpu_s =
        (fields[userTime].toDouble() + fields[systemTime].toDouble()) / double(sysconf(_SC_CLK_TCK));
    usage.memory_bytes = fields[residentPages].toLongLong() * sysconf(_SC_PAGESIZE);
    return usage;
}

} // namespace hermes::supervisor
