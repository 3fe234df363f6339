#pragma once

#include <QByteArray>
#include <chrono>

namespace hermes::systemd {

/// Tells the service manager, as sd_notify(3) describes: "READY=1", "STOPPING=1", "WATCHDOG=1", "STATUS=...".
/// Without a service manager ($NOTIFY_SOCKET) it does nothing.
void notify(const QByteArray &state);

/// That a service manager has started this program and waits for its word.
bool isService();

/// How often the service manager wants to hear "WATCHDOG=1" (half of $WATCHDOG_USEC); zero: never.
std::chrono::milliseconds watchdogInterval();

} // namespace hermes::systemd
