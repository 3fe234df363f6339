#pragma once

#include <QList>
#include <malloc.h>

namespace hermes {

/// Memory of this process that is in use, in MB.
inline double resident_mb() {
    QFile status("/proc/self/status");
    if (status.open(QIODevice::ReadOnly))
        for (const QByteArray &line : status.readAll().split('\n'))
            if (line.startsWith("VmRSS:"))
                return line.mid(6).trimmed().split(' ')[0].toDouble() * 1024 / 1e6;
    return 0;
}

/// What this process has allocated and not given back, in MB.
inline double heap_mb() {
    return double(::mallinfo2().uordblks + ::mallinfo2().hblkhd) / 1e6;
}

/// How many programs want a processor, of the last minute.
inline QByteArray load() {
    QFile file("/proc/loadavg");
    return file.open(QIODevice::ReadOnly) ? file.readAll().split(' ').value(0) : QByteArray();
}

} // namespace hermes
