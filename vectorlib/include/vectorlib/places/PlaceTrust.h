#pragma once

#include <algorithm>
#include <cmath>

namespace vectorlib {

/// How probable places are: a multinomial logistic model of what is right, one of the places or none. It was
/// learned from scans of real and made-up buildings in maps of the same and of other buildings. Leads are
/// those of PlaceFit::leadOver: what one object alone says counts for little.
struct PlaceTrust {
    double constant = -22.3, score = 24.6, ahead = 101; ///< of the best place against none
    double rival = 17;                                  ///< of the best place against another
    double mostLead = 0.1;                              ///< a greater one says no more
    double unexplained = 0.1, mostRelativeLead = 0.5;   ///< see relativeLead

    /// Odds that no place is right, to those of the best place: its score, and its lead over the next.
    double oddsOfNone(double bestScore, double lead) const {
        return std::exp(-constant - score * bestScore - ahead * clampedLead(lead));
    }
    /// Odds of another place, over which the best place has this lead, to those of the best place.
    double oddsOfRival(double bestScore, double lead) const {
        return std::exp(-rival * relativeLead(bestScore, lead));
    }
    /// A lead within 0 and `mostLead`.
    double clampedLead(double lead) const { return std::clamp(lead, 0.0, mostLead); }
    /// A lead to what the best place leaves unexplained: where map and scan agree in all else, a small one
    /// tells as much as a great one where they do not.
    double relativeLead(double bestScore, double lead) const {
        return std::clamp(lead / (std::max(0.0, 1 - bestScore) + unexplained), 0.0, mostRelativeLead);
    }
};

} // namespace vectorlib
