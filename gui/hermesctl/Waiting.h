#pragma once

#include "common/progress/Progress.h"

#include <QElapsedTimer>
#include <QTimer>
#include <chrono>

namespace hermes::ctl {

/// Tells, while event loops run, how long something takes already, and how long it will take at most. Of one
/// within another only the outer one is told.
class Waiting {
public:
    /// For an answer, or until the time-out (0: none); it is told to people alone.
    explicit Waiting(std::chrono::milliseconds most);
    /// For work that takes so long. most: 0 when it has no limit; what: as of Progress, seconds are counted.
    Waiting(std::chrono::milliseconds most, const char *what);
    ~Waiting();
    Waiting(const Waiting &) = delete;
    Waiting &operator=(const Waiting &) = delete;

private:
    static int count;

    Progress progress_;
    QElapsedTimer since_;
    QTimer timer_;
};

} // namespace hermes::ctl
