#include "common/daemon/SignalWatcher.h"

#include <mutex>
#include <windows.h>

namespace hermes {
namespace {

// For this program to end in order. Windows waits for 5 s itself where a console is closed.
constexpr DWORD longestEnd_ms = 10000;

std::mutex mutex; // the system calls handlers in threads of their own
SignalWatcher *watcher = nullptr;

bool tell(const QString &name) {
    const std::lock_guard<std::mutex> lock(mutex);
    return watcher &&
           QMetaObject::invokeMethod(
               watcher, [who = watcher, name] { Q_EMIT who->received(name); }, Qt::QueuedConnection);
}

BOOL WINAPI handle(DWORD event) {
    const bool isKey = event == CTRL_C_EVENT || event == CTRL_BREAK_EVENT;
    if (!tell(isKey ? QStringLiteral("SIGINT") : QStringLiteral("SIGHUP")))
        return FALSE;
    // The console was closed, or its user logs off: when this returns Windows ends the program, which may
    // have to stop a robot before. Its own end ends this thread, too.
    if (!isKey)
        ::Sleep(longestEnd_ms);
    return TRUE;
}

} // namespace

SignalWatcher::SignalWatcher(QObject *parent)
    : QObject(parent) {
    {
        const std::lock_guard<std::mutex> lock(mutex);
        watcher = this;
    }
    // For good: taking it away could wait for a handler that sleeps.
    static const BOOL isSet = ::SetConsoleCtrlHandler(handle, TRUE);
    Q_UNUSED(isSet)
}

SignalWatcher::~SignalWatcher() {
    const std::lock_guard<std::mutex> lock(mutex);
    watcher = nullptr;
}

} // namespace hermes
