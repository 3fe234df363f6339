#pragma once

#include "common/progress/Progress.h"

#include <cmath>
#include <cstddef>
#include <string>

namespace hermes::vector {

/// The progress of building a map: tracking the scans, and then what follows the last one, as one work whose
/// steps take about the same time each.
class MapProgress {
public:
    explicit MapProgress(bool isFinished)
        : finishShare_(isFinished ? 0.3 : 0) {}

    /// total: 0 when it is not known. Then reading the scans tells how far it is, and tracking does not.
    void track(std::size_t scans, std::size_t total) {
        tracking_ = double(total);
        if (total > 0) // in a map that grows a scan takes longer and longer
            tell(double(scans) * std::sqrt(double(scans) / double(total)));
    }
    void begin(const std::string &stage) { progress_.rename(stage + ", step"); }
    void finish(std::size_t done, std::size_t all) {
        if (tracking_ == 0)
            progress_.update(double(done), double(all));
        else
            tell(tracking_ * (1 + finishShare_ * double(done) / double(all)));
    }

private:
    void tell(double done) { progress_.update(std::floor(done), std::floor(tracking_ * (1 + finishShare_))); }

    double tracking_ = 0;      // steps, as many as scans
    const double finishShare_; // of the time of tracking, about
    Progress progress_{"tracking, step"};
};

} // namespace hermes::vector
