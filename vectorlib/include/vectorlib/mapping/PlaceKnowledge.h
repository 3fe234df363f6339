#pragma once

#include "vectorlib/geometry/Transformation2D.h"

#include <optional>

namespace vectorlib {

/// What is known of a sensor's place in its map.
enum class PlaceState {
    Known,
    Found, ///< by a search: a second one, some way on, makes it known; nearby, the next scan that agrees
    Told,  ///< by somebody
    Sought
};

/// How the place of a sensor in its map becomes known, and is lost. Poses are in the map's frame.
class PlaceKnowledge {
public:
    PlaceState state() const { return state_; }
    bool isKnown() const { return state_ == PlaceState::Known; }
    bool isSought() const { return state_ == PlaceState::Sought; }

    /// The sensor was put somewhere for sure.
    void place() {
        state_ = PlaceState::Known;
        agreed_ = 0;
        isBent_ = false;
    }
    /// The place may be wrong: five scans in a row have to agree with it, where that matters.
    void doubt(bool matters) {
        agreed_ = 0;
        if (isKnown() && matters)
            state_ = PlaceState::Told;
    }
    /// The place is not known: it is sought everywhere.
    void seek() {
        state_ = PlaceState::Sought;
        isBent_ = false;
    }
    /// The map does not go on: the place is sought, and may be nearby, where a growing map is bent.
    void breakOff() {
        seek();
        isBent_ = true;
    }
    /// A search found the place at a pose, where another one was expected.
    void find(const Transformation2D &found, const Transformation2D &expected) {
        state_ = PlaceState::Found;
        agreed_ = 0;
        searchedAt_ = found;
        isBent_ = isBent_ && !(expected.inverse() * found).exceeds(bend_m, bend_rad);
    }
    /// Takes whether a scan agrees with the place: one that was told, or found nearby, becomes known.
    void settle(bool agrees) {
        agreed_ = agrees ? agreed_ + 1 : 0;
        if ((state_ == PlaceState::Told && agreed_ >= enoughToAgree) ||
            (state_ == PlaceState::Found && isBent_ && agreed_ > 0))
            place();
    }
    /// What is found in a map that is not complete may lie outside of it. A second search decides: whether
    /// the sensor is far enough from the first for one.
    bool wantsToConfirm(const Transformation2D &pose) const {
        return state_ == PlaceState::Found && agreed_ > 0 &&
               (searchedAt_.inverse() * pose).exceeds(confirmed_m, confirmed_rad);
    }
    /// The second search was made at a pose, and found the place there, elsewhere, or nowhere.
    void confirm(const Transformation2D &pose, const std::optional<Transformation2D> &found) {
        searchedAt_ = pose;
        if (!found)
            return;
        if ((pose.inverse() * *found).exceeds(same_m, same_rad))
            seek();
        else
            place();
    }
    /// The map was made anew: what was in it lies elsewhere.
    void move(const Transformation2D &moved) { searchedAt_ = moved * searchedAt_; }

private:
    static constexpr int enoughToAgree = 5; // scans
    // Between the searches that make a place known, and how well they must agree.
    static constexpr double confirmed_m = 1, confirmed_rad = 0.6, same_m = 0.5, same_rad = 0.17;
    static constexpr double bend_m = 2, bend_rad = 0.5; // so far a growing map may bend

    PlaceState state_ = PlaceState::Known;
    bool isBent_ = false; // what contradicts the place may be the growing map itself: it is found nearby
    int agreed_ = 0;      // scans in a row
    Transformation2D searchedAt_; // last
};

} // namespace vectorlib
