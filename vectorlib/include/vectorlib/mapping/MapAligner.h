#pragma once

#include "vectorlib/mapping/MapRegistration.h"
#include "vectorlib/observation/Observer.h"
#include "vectorlib/places/PlaceSearch.h"

#include <cstdint>
#include <functional>
#include <set>

namespace vectorlib {

/// How the search of one map in another ended.
struct MapAlignment {
    enum class Outcome {
        Found,       ///< places agree, and nothing speaks against them
        Nowhere,     ///< too few places of the second map were found in the first
        Ambiguous,   ///< places agree on different motions
        Contradicted ///< walls of the first map stand where the second one is seen through
    };
    Outcome outcome = Outcome::Nowhere;
    MapOverlap overlap;
    std::size_t places = 0;  ///< of the second map, from which much is seen
    std::size_t found = 0;   ///< of them, that are found in the first map and have no twin in the second
    std::size_t agree = 0;   ///< of these, with the motion
    std::size_t rival = 0;   ///< with the next best one
    std::size_t against = 0; ///< places where the first map shows something else
};

/// Finds how one map lies in another without any estimate: what would be seen of the second map from many
/// places is sought in the whole first map, and several places must agree on one motion. A place that looks
/// like another one of its own map does not count: rooms that are alike fold no map.
class MapAligner {
public:
    double spacing = 2;           ///< between places; metres
    std::size_t mostPlaces = 150; ///< spread evenly
    double reach = 10;            ///< of what is seen from a place; metres
    double leastSeen = 6;         ///< of walls from a place; metres
    std::size_t leastAgree = 3;   ///< places
    /// Two places agree when one leads to the other within this, and so much of the way between them.
    double same = 0.4, bent = 0.03;
    double sameAlpha = 0.1; ///< radians
    MapRegistration registration;
    std::function<void(std::size_t done, std::size_t all)> progress; ///< counts places that were sought

    /// Seeks the second map (`moving`) in the first (`fixed`), each in its own frame; metres. The motion
    /// takes the second into the frame of the first. `fixed` is not changed; its search keeps buffers.
    MapAlignment operator()(VectorMap &fixed, const std::vector<MapEdge> &moving) {
        MapAlignment result;
        findPlaces(moving);
        result.places = places_.size();
        findVotes(fixed, moving);
        result.found = votes_.size();
        const std::size_t best = bestVote(result);
        if (result.agree < leastAgree)
            return result;
        result.outcome = MapAlignment::Outcome::Ambiguous;
        if (2 * result.rival >= result.agree)
            return result;
        result.overlap = registration(fixed, moving, motionOfAll(votes_[best]));
        result.against = countContradictions(result.overlap.motion);
        const bool isContradicted = 2 * result.against >= result.agree;
        result.outcome = isContradicted ? MapAlignment::Outcome::Contradicted : MapAlignment::Outcome::Found;
        return result;
    }

    /// The same for a motion that is told. As it may be chosen by what a few places show, three times as many
    /// must agree as where it is found; Nowhere means that too few do, and nothing more.
    MapAlignment confirm(VectorMap &fixed, const std::vector<MapEdge> &moving, const Transformation2D &told) {
        MapAlignment result;
        findPlaces(moving);
        result.places = places_.size();
        result.overlap = registration(fixed, moving, told);
        inFixed_.index().follow(fixed.slots());
        forEachFit(result.overlap.motion, [&](const PlaceFit &fit) {
            result.agree += fit.explainedShare() >= leastAlike && fit.hiddenShare() <= mostHidden;
            result.against += isAgainst(fit);
        });
        if (result.against > 0 && 2 * result.against >= result.agree)
            result.outcome = MapAlignment::Outcome::Contradicted;
        else if (result.agree >= 3 * leastAgree)
            result.outcome = MapAlignment::Outcome::Found;
        return result;
    }

private:
    static constexpr double mostHidden = 0.25, leastAlike = 0.5; // shares of what is seen from a place

    struct PlaceOfMap {
        Pose2D pose;                  // in the second map
        std::vector<EdgeRaw2D> edges; // seen from there
    };
    struct Vote {
        Pose2D pose;             // in the second map
        Transformation2D motion; // that the place tells
    };

    // In front of walls, one a square of the grid, from where enough is seen.
    void findPlaces(const std::vector<MapEdge> &map) {
        places_.clear();
        std::vector<LineSegment2D<double>> walls;
        for (const MapEdge &edge : map)
            walls.push_back(edge.segment);
        std::set<std::pair<std::int64_t, std::int64_t>> taken;
        for (const LineSegment2D<double> &wall : walls)
            for (double t = std::min(0.5 * wall.length(), 0.5 * spacing); t < wall.length(); t += spacing) {
                const Vector2D<double> p = wall.begin() + wall.direction() * t + wall.normal() * 0.8;
                const std::pair<std::int64_t, std::int64_t> square(std::floor(p.x / spacing),
                                                                   std::floor(p.y / spacing));
                if (wall.length() < 0.5 || taken.count(square) > 0)
                    continue;
                PlaceOfMap place{{p.x, p.y, 0}, {}};
                if (see(walls, place) < leastSeen)
                    continue;
                taken.insert(square);
                places_.push_back(place);
            }
        if (places_.size() <= mostPlaces)
            return;
        for (std::size_t i = 0; i < mostPlaces; ++i)
            places_[i] = places_[i * places_.size() / mostPlaces];
        places_.resize(mostPlaces);
    }
    double see(const std::vector<LineSegment2D<double>> &walls, PlaceOfMap &place) {
        observe_.maxRange = reach;
        double seen = 0;
        for (const VisiblePart<double> &part : observe_(walls, place.pose))
            if (part.segment.length() >= 0.1) {
                seen += part.segment.length();
                place.edges.emplace_back(TlsSums(), part.segment, 0);
            }
        return seen;
    }
    void findVotes(VectorMap &fixed, const std::vector<MapEdge> &moving) {
        votes_.clear();
        std::size_t done = 0;
        for (const PlaceOfMap &place : places_) {
            const Relocalized &found = search(inFixed_, fixed.slots(), place);
            if (found.isFound()) {
                const Transformation2D motion =
                    Transformation2D(found.places.front().pose) * Transformation2D(place.pose).inverse();
                const Relocalized &own = search(inMoving_, moving, place);
                if (own.isFound() && isNear(Transformation2D(own.places.front().pose), place.pose, 0))
                    votes_.push_back({place.pose, motion});
            }
            if (progress)
                progress(++done, places_.size());
        }
    }
    static const Relocalized &search(PlaceSearch &search, const std::vector<MapEdge> &map,
                                     const PlaceOfMap &place) {
        search.maxSeconds = 1e6; // the result is always the same
        return search(map, place.edges, {});
    }
    bool isNear(const Transformation2D &a, const Pose2D &b, double way) const {
        const Transformation2D off = a.inverse() * Transformation2D(b);
        return off.translation().norm() <= same + bent * way && std::abs(off.alpha()) <= sameAlpha;
    }
    bool agree(const Vote &a, const Vote &b) const {
        const Transformation2D there = a.motion * Transformation2D(b.pose);
        const Transformation2D found = b.motion * Transformation2D(b.pose);
        return isNear(there, found.pose(), std::hypot(a.pose.x - b.pose.x, a.pose.y - b.pose.y));
    }
    // The one that most agree with; and how many agree with each other, and not with it.
    std::size_t bestVote(MapAlignment &result) const {
        std::size_t best = 0;
        const auto count = [this](const Vote &vote, const Vote *without) {
            return std::size_t(std::count_if(votes_.begin(), votes_.end(), [&](const Vote &other) {
                return agree(vote, other) && !(without && agree(*without, other));
            }));
        };
        for (std::size_t i = 0; i < votes_.size(); ++i)
            if (const std::size_t n = count(votes_[i], nullptr); n > result.agree) {
                result.agree = n;
                best = i;
            }
        for (const Vote &vote : votes_)
            if (!agree(votes_[best], vote))
                result.rival = std::max(result.rival, count(vote, &votes_[best]));
        return best;
    }
    // Least squares over the places that agree with one: they lie apart, and tell the angle better than each.
    Transformation2D motionOfAll(const Vote &best) const {
        Vector2D<double> from, to;
        double count = 0, sine = 0, cosine = 0;
        const auto forEach = [&](auto take) {
            for (const Vote &vote : votes_)
                if (const Vector2D<double> p(vote.pose.x, vote.pose.y); agree(best, vote))
                    take(p, vote.motion * p);
        };
        forEach([&](Vector2D<double> p, Vector2D<double> q) {
            from += p;
            to += q;
            ++count;
        });
        from = from * (1 / count);
        to = to * (1 / count);
        forEach([&](Vector2D<double> p, Vector2D<double> q) {
            sine += (p - from).cross(q - to);
            cosine += (p - from).dot(q - to);
        });
        return Transformation2D(to.x, to.y, std::atan2(sine, cosine)) * Transformation2D(-from.x, -from.y, 0);
    }
    // Places where the first map shows something else, and walls that would be looked through. Doors and
    // furniture move: places that agree, or where most is alike, are none.
    std::size_t countContradictions(const Transformation2D &motion) {
        std::size_t against = 0;
        forEachFit(motion, [&](const PlaceFit &fit) { against += isAgainst(fit); });
        return against;
    }
    static bool isAgainst(const PlaceFit &fit) {
        return fit.hiddenShare() > mostHidden && fit.explainedShare() < leastAlike;
    }
    template <typename Take>
    void forEachFit(const Transformation2D &motion, Take take) {
        for (const PlaceOfMap &place : places_) {
            inFixed_.scan.take(place.edges, {});
            take(inFixed_.fit.judge(inFixed_.index().tiles(), inFixed_.scan.points(),
                                    motion * Transformation2D(place.pose), 1, true,
                                    inFixed_.scan.wallOfPoint()));
        }
    }

    Observer<double> observe_;
    PlaceSearch inFixed_, inMoving_;
    std::vector<PlaceOfMap> places_;
    std::vector<Vote> votes_;
};

} // namespace vectorlib
