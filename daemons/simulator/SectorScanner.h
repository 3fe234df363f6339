#pragma once

#include "daemons/simulator/ScannerEmulator.h"

namespace hermes::simulator {

/// A scanner whose head turns counter-clockwise and begins at the rear, where the time of a scan is taken.
/// Its steps are counted from there; it measures some of them.
class SectorScanner : public ScannerEmulator {
protected:
    using ScannerEmulator::ScannerEmulator;

    void setSector(int first, int last) {
        first_ = first;
        last_ = last;
    }
    int steps() const { return steps_; } ///< a turn
    /// The head has passed this step of a turn that was measured from its beginning on.
    virtual void pass(int step) = 0;
    /// Of this turn, millimetres; 0: none.
    const std::vector<int> &ranges() const { return ranges_; }
    std::int64_t begin_us() const { return begin_us_; } ///< of this turn, by the scanner's clock

private:
    void sample() final {
        const int step = int(stepOf(steps_));
        if (step == 0) {
            begin_us_ = clock_us();
            ranges_.clear();
        }
        ranges_.push_back(step >= first_ && step <= last_ ? range_mm(turn() - 0.5) : 0);
        if (int(ranges_.size()) == step + 1)
            pass(step);
    }

    const int steps_ = int(std::lround(model().points_hz / model().turns_hz));
    int first_ = 0, last_ = 0;
    std::vector<int> ranges_;
    std::int64_t begin_us_ = 0;
};

} // namespace hermes::simulator
