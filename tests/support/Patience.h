#pragma once

#include <QtTest>

/// How many times slower this program is than those for which limits of time are written: 5 under sanitizers,
/// which look for errors, not for delays; $HERMES_SLOWNESS, which the build sets where an emulator runs the
/// tests, and system/timing.py on a slow machine; otherwise 1.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline const int slowness = 5;
#else
inline const int slowness = std::max(1, qEnvironmentVariableIntValue("HERMES_SLOWNESS"));
#endif

/// How many times longer a wait for a condition lasts before it is given up: tests that run beside others,
/// all but those of the tier timing, have a part of the machine only ($HERMES_PATIENCE,
/// tests/CMakeLists.txt).
inline const int patience = std::max(slowness, qEnvironmentVariableIntValue("HERMES_PATIENCE"));

// QTRY_VERIFY and its kin wait so many times longer.
#undef QTRY_IMPL
#define QTRY_IMPL(expr, timeout)                                                                             \
    const int qt_test_step = (timeout) < 350 ? (timeout) / 7 + 1 : 50;                                       \
    const int qt_test_timeoutValue = patience * (timeout);                                                   \
    { QTRY_LOOP_IMPL((expr), qt_test_timeoutValue, qt_test_step); }                                          \
    QTRY_TIMEOUT_DEBUG_IMPL((expr), qt_test_timeoutValue, qt_test_step)

inline QElapsedTimer runningTimer() {
    QElapsedTimer timer;
    timer.start();
    return timer;
}
