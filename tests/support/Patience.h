#pragma once

#include <QtTest>

/// How many times slower this build is than those for which limits of time are written. Sanitizers look for
/// errors, not for delays: those are for the release build to show.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr int slowness = 5;

// QTRY_VERIFY and its kin wait so many times longer.
#undef QTRY_IMPL
#define QTRY_IMPL(expr, timeout)                                                                             \
    const int qt_test_step = 50;                                                                             \
    const int qt_test_timeoutValue = slowness * (timeout);                                                   \
    { QTRY_LOOP_IMPL((expr), qt_test_timeoutValue, qt_test_step); }                                          \
    QTRY_TIMEOUT_DEBUG_IMPL((expr), qt_test_timeoutValue, qt_test_step)
#else
constexpr int slowness = 1;
#endif
