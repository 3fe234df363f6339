#include "common/daemon/SignalWatcher.h"

#include <mutex>
#include <windows.h>

namespace hermes {
namespace {

std::mutex mutex; // the system calls handlers in a thread of their own
SignalWatcher *watcher = nullptr;

BOOL WINAPI handle(DWORD event) {
    const std::lock_guard<std::mutex> lock(mutex);
    if (!watcher)
        return FALSE;
    const bool isKey = event == CTRL_C_EVENT || event == CTRL_BREAK_EVENT;
    const QString name = isKey ? QStringLiteral("SIGINT") : QStringLiteral("SIGHUP");
    QMetaObject::invokeMethod(
        watcher, [who = watcher, name] { Q_EMIT who->received(name); }, Qt::QueuedConnection);
    return TRUE;
}

} // namespace

SignalWatcher::SignalWatcher(QObject *parent)
    : QObject(parent) {
    {
        const std::lock_guard<std::mutex> lock(mutex);
        watcher = this;
    }
    ::SetConsoleCtrlHandler(handle, TRUE);
}

SignalWatcher::~SignalWatcher() {
    ::SetConsoleCtrlHandler(handle, FALSE);
    const std::lock_guard<std::mutex> lock(mutex);
    watcher = nullptr;
}

} // namespace hermes
