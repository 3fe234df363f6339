#pragma once

#include <algorithm>
#include <cmath>

namespace vectorlib {

/// How probable places are: a multinomial logistic model of what is right, one of the places or none. It was
/// learned from scans of real and made-up buildings in maps of the same and of other buildings. Leads are
/// those of PlaceFit::leadOver: what one object alone says counts for nothing.
struct PlaceTrust {
    double constant = -22.3, score = 24.6, ahead = 101; ///< of the best place against none
    double rival = 70;                                  ///< of the best place against another
    double mostLead = 0.1;                              ///< a greater one says no more

    /// Odds that no place is right, to those of the best place: its score, and its lead over the next.
    double oddsOfNone(double bestScore, double lead) const {
        return std::exp(-constant - score * bestScore - ahead * clamped(lead));
    }
    /// Odds of another place, over which the best place has this lead, to those of the best place.
    double oddsOfRival(double lead) const { return std::exp(-rival * clamped(lead)); }

private:
    double clamped(double lead) const { return std::clamp(lead, 0.0, mostLead); }
};

} // namespace vectorlib
