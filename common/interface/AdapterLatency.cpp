#include "common/interface/AdapterLatency.h"

#include <QFile>
#include <QFileInfo>

namespace hermes {
namespace {

int timerIn(QFile &file) {
    if (!file.open(QIODevice::ReadOnly))
        return 0;
    const int milliseconds = file.readAll().trimmed().toInt();
    file.close();
    return milliseconds;
}

} // namespace

// Of the Linux driver ftdi_sio: device/latency_timer, 1 to 255 ms.
AdapterLatency AdapterLatency::lower(const QString &device, const QString &system) {
    const QString port = QFileInfo(QFileInfo(device).canonicalFilePath()).fileName();
    QFile timer(QString("%1/class/tty/%2/device/latency_timer").arg(system, port));
    AdapterLatency latency;
    latency.milliseconds = port.isEmpty() ? 0 : timerIn(timer);
    if (latency.milliseconds <= 1)
        return latency;
    const bool written = timer.open(QIODevice::WriteOnly | QIODevice::Unbuffered) && timer.write("1\n") == 2;
    const QString failure = timer.errorString();
    timer.close();
    latency.milliseconds = timerIn(timer);
    if (latency.milliseconds > 1)
        latency.advice = QString("its adapter delays bytes by up to %1 ms, and this program may not "
                                 "write 1 to %2 (%3): do so as root, or by a udev rule")
                             .arg(latency.milliseconds)
                             .arg(timer.fileName(), written ? "it stays as it is" : failure);
    return latency;
}

} // namespace hermes
