#pragma once

#include "vectorlib/geometry/Pose2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/mapping/PlaceKnowledge.h"
#include "vectorlib/mapping/VectorMap.h"

#include <QString>

#include <optional>
#include <vector>

namespace hermes::scanmatcher {

/// What map.undo brings back, and carries out again: a step for each command that replaced the map or put the
/// sensor elsewhere.
class MapHistory {
public:
    static constexpr std::size_t maxSteps = 8;

    /// What a command did away with.
    struct Step {
        QString command;
        std::optional<vectorlib::VectorMap> map; ///< none: it is still the same
        bool isPose = false;                     ///< the sensor was put elsewhere
        vectorlib::Pose2D before;                ///< of the sensor, in the frame of that map
        vectorlib::Pose2D told;                  ///< instead of it, in the frame of the map of now
        vectorlib::PlaceState place = vectorlib::PlaceState::Known; ///< what was known of it before
    };

    /// A command was carried out: what was undone cannot be carried out again. Returns how many maps are gone
    /// by that, or as there are too many steps.
    std::size_t add(Step step);
    /// The same of a map that a replay has made; what was undone before can still be carried out again.
    std::size_t addReplay(vectorlib::VectorMap map);
    /// Something will be mapped from where the sensor was put last: the map as it is comes back by undoing
    /// that.
    void keepMap(const vectorlib::VectorMap &map);
    /// The map of now was corrected; `moved` tells where in it a pose lies.
    void move(const vectorlib::Transformation2D &moved);

    /// The command of the next step to be undone, or carried out again; empty: none.
    QString next(bool again) const {
        const std::vector<Step> &steps = again ? redone_ : undone_;
        return steps.empty() ? QString() : steps.back().command;
    }
    /// Takes that step; `put` gives what reverses it.
    std::optional<Step> take(bool again);
    void put(Step back, bool again);

private:
    std::vector<Step> undone_, redone_; // that can be; the last is the next
};

} // namespace hermes::scanmatcher
