#include "gui/desktop/widgets/Quantities.h"

#include "gui/desktop/widgets/ForeignText.h"

#include <QObject>

namespace hermes::desktop {

QString sizeText(double bytes) {
    const char *const units[]{"B", "KiB", "MiB", "GiB", "TiB"};
    int unit = 0;
    for (; bytes >= 1023.95 && unit < 4; ++unit)
        bytes /= 1024;
    return shortNumber(bytes, unit == 0 ? 0 : 1) + ' ' + units[unit];
}

QString durationText(double seconds) {
    constexpr double century_s = 3.2e9;
    if (!(seconds >= 0 && seconds < century_s))
        return QObject::tr("%1 s").arg(shortNumber(seconds, 0));
    const qint64 s = qint64(seconds);
    if (s >= 3600)
        return QObject::tr("%1 h %2 min").arg(s / 3600).arg(s / 60 % 60);
    return s >= 60 ? QObject::tr("%1 min %2 s").arg(s / 60).arg(s % 60) : QObject::tr("%1 s").arg(s);
}

QString roughDurationText(double seconds) {
    if (!(seconds >= 60 && seconds < 3600))
        return seconds >= 0 && seconds < 60 ? QObject::tr("under 1 min") : durationText(seconds);
    return QObject::tr("%1 min").arg(int(seconds) / 60);
}

} // namespace hermes::desktop
