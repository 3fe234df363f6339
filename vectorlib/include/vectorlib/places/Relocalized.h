#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Pose2D.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace vectorlib {

/// How probable places are: a multinomial logistic model of what is right, one of the places or none. It was
/// learned from scans of real and made-up buildings in maps of the same and of other buildings. Leads are
/// those of PlaceFit::leadOver: what one object alone says counts for little.
struct PlaceTrust {
    double constant = -22.3, score = 24.6, ahead = 101; ///< of the best place against none
    double rival = 17;                                  ///< of the best place against another
    double maxLead = 0.1;                               ///< a greater one says no more
    double unexplained = 0.1, maxRelativeLead = 0.5;    ///< see relativeLead

    /// Odds that no place is right, to those of the best place: its score, and its lead over the next.
    double oddsOfNone(double bestScore, double lead) const {
        return std::exp(-constant - score * bestScore - ahead * clampedLead(lead));
    }
    /// Odds of another place, over which the best place has this lead, to those of the best place.
    double oddsOfRival(double bestScore, double lead) const {
        return std::exp(-rival * relativeLead(bestScore, lead));
    }
    /// A lead within 0 and `maxLead`.
    double clampedLead(double lead) const { return std::clamp(lead, 0.0, maxLead); }
    /// A lead to what the best place leaves unexplained: where map and scan agree in all else, a small one
    /// tells as much as a great one where they do not.
    double relativeLead(double bestScore, double lead) const {
        return std::clamp(lead / (std::max(0.0, 1 - bestScore) + unexplained), 0.0, maxRelativeLead);
    }
};

/// Why a place is not accepted; the first of its faults in this order.
enum class PlaceFault {
    None,         ///< the place is accepted
    Reliability,  ///< the directions of the walls are too much alike to fix the place
    Explained,    ///< too little of the scan lies on walls of the map
    Contradicted, ///< what would be seen from there differs from what was seen
    Doubtful,     ///< too little speaks for it
    Alike         ///< another place fits alike
};

/// The fault in words, for people.
const char *describe(PlaceFault fault);

/// A place in the map where a scan fits, and what speaks for it.
struct Place {
    Pose2D pose;             ///< of the sensor in the map's frame
    double score = 0;        ///< up to 1; places are ranked by it
    double probability = 0;  ///< of being right, if the world is like those it was learned from
    double reliability = 0;  ///< in [0, 1], of the walls' directions: small along a corridor
    double ambiguity = 0;    ///< mean squared distance of the explained points from their walls; m^2
    double discrepancy = 0;  ///< area seen behind walls of the map; m^2
    double matchedShare = 0; ///< of the scan's points, that lie on walls of the map
    double against = 0;      ///< PlaceFit::against
    double lead = 0; ///< of the first place over this one, as PlaceFit::leadOver; of the first its least
    /// Of x, y (metres) and theta (radians); nothing where the walls do not fix the place.
    std::optional<Eigen::Matrix3d> covariance;
    PlaceFault fault = PlaceFault::None; ///< None when the place is accepted
};

/// How a search of the whole map ended.
struct Relocalized {
    enum class Outcome {
        Found,     ///< the first place fits, and no other like it
        NoScan,    ///< there is no scan yet
        NoMap,     ///< the map is empty
        TooLittle, ///< the scan has fewer than two edges
        Nowhere,   ///< no place is accepted
        Ambiguous, ///< several places fit alike
        Unfinished ///< time or a bound ended the search before all of its parts were done
    };
    Outcome outcome = Outcome::NoScan;
    std::vector<Place> places; ///< the best ones, best first
    std::size_t alike = 0;     ///< places that score nearly like the best
    std::size_t parts = 0;     ///< of the search: a wall of the scan on a wall of the map
    std::size_t searched = 0;  ///< of these parts
    double ms = 0;             ///< time that the search took; milliseconds

    bool isFound() const { return outcome == Outcome::Found; }
    /// In words, for people.
    std::string text() const;
};

/// For programs.
const char *name(Relocalized::Outcome outcome);

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/places/Relocalized.cpp")
