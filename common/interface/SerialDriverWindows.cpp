#include "common/interface/SerialDriver.h"

#include <windows.h>

namespace hermes {

// serial:///COM3: a path of the URL begins with a slash.
QString serialDevice(const QString &path) {
    return path.startsWith(QLatin1Char('/')) ? path.mid(1) : path;
}

QMap<QString, quint64> serialErrors(SerialHandle) {
    return {};
}

qint64 serialBytesWaiting(SerialHandle port) {
    COMSTAT state{};
    return ::ClearCommError(port, nullptr, &state) ? qint64(state.cbOutQue) : 0;
}

QString setSerialLine(SerialHandle port, SerialLine line, bool on) {
    const DWORD what = line == SerialLine::Rts ? (on ? SETRTS : CLRRTS) : (on ? SETDTR : CLRDTR);
    return ::EscapeCommFunction(port, what) ? QString() : qt_error_string();
}

} // namespace hermes
