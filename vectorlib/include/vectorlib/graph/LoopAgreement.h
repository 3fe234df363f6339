#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/graph/PoseConstraint.h"

#include <optional>
#include <vector>

namespace vectorlib {

/// Settings of LoopAgreement: when two loops tell the same. A way is that of the drive.
struct LoopAgreementSettings {
    double within = 30;                    ///< way on which loops are asked, at both of their ends; metres
    double along = 15;                     ///< least way on which they agree; metres
    double apart = 1;                      ///< least way between two that count; metres
    double missXY = 0.3, missAlpha = 0.06; ///< by how much two may miss each other; metres, radians
    double missPart = 0.03;                ///< and by so much of the ways between them
};

/// Loops that are not believed before others, found on the same stretch of the drive, tell the same.
class LoopAgreement {
public:
    LoopAgreementSettings settings;

    /// An end of a loop, as the drive alone led there.
    struct End {
        Transformation2D pose;
        double way; ///< since the start of the drive; metres
    };
    /// A loop that waits for others, and its two ends.
    struct Waiting {
        PoseConstraint loop;
        End from, to;
    };

    /// Takes the next loop. Where it and those that agree with it are at least `enough` they are given, and
    /// forgotten; else nothing is.
    std::vector<PoseConstraint> add(const PoseConstraint &loop, const End &from, const End &to,
                                    std::size_t enough);
    /// The last one that waits, where the drive went on for no more than `within` since.
    std::optional<Waiting> newest(double way) const;
    void clear() { waiting_.clear(); }

private:
    // Whether both lead from the first one's begin to the second one's end alike.
    bool agree(const Waiting &a, const Waiting &b) const;

    std::vector<Waiting> waiting_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/graph/LoopAgreement.cpp")
