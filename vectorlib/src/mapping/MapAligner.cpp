#include "vectorlib/mapping/MapAligner.h"
#include "vectorlib/geometry/SmallMatrix.h"

#include <cstdint>
#include <set>

namespace vectorlib {

VECTORLIB_BODY void mergeMap(VectorMap &map, const std::vector<MapEdge> &added,
                             const Transformation2D &motion, double distance) {
    for (const MapEdge &edge : added) {
        const EdgeRaw2D moved = motion * static_cast<const EdgeRaw2D &>(edge);
        const LineSegment2D<double> &wall = moved.segment;
        int best = -1;
        double longest = 0;
        for (const int number : map.near(wall, distance)) {
            const LineSegment2D<double> &known = map.slots()[std::size_t(number)].segment;
            const double overlap = known.overlap(wall);
            if (known.direction().dot(wall.direction()) > 0.95 && overlap > longest &&
                known.meanSquareAcross(wall) <= distance * distance) {
                best = number;
                longest = overlap;
            }
        }
        if (best < 0 || !map.merge(best, moved, edge.observations))
            best = map.add(moved, edge.observations);
        map.consolidate(best);
    }
}

VECTORLIB_BODY MapOverlap MapRegistration::operator()(VectorMap &fixed, const std::vector<MapEdge> &moving,
                                                      Transformation2D motion) {
    MapOverlap overlap;
    for (int step = 0; step <= steps; ++step) {
        const double share = std::min(1.0, 2.0 * step / steps);
        collect(fixed, moving, motion, firstGate + share * (lastGate - firstGate),
                firstTurn + share * (lastTurn - firstTurn));
        overlap = judge(motion);
        if (step < steps && overlap.reliability > 0)
            motion = improved(motion);
    }
    return overlap;
}

VECTORLIB_BODY void MapRegistration::collect(VectorMap &fixed, const std::vector<MapEdge> &moving,
                                             const Transformation2D &motion, double gate, double turn) {
    pairs_.clear();
    for (const MapEdge &edge : moving) {
        const LineSegment2D<double> wall = motion * edge.segment;
        const std::size_t first = pairs_.size();
        double covered = 0;
        for (const int number : fixed.near(wall, gate)) {
            const LineSegment2D<double> &known = fixed.slots()[std::size_t(number)].segment;
            const double overlap = known.overlap(wall);
            const bool isAlike = known.direction().dot(wall.direction()) > std::cos(turn);
            if (isAlike && overlap >= leastOverlap && apart(known, wall) <= gate * gate) {
                pairs_.push_back({known, wall, overlap});
                covered += overlap;
            }
        }
        for (std::size_t i = first; i < pairs_.size(); ++i) // those that lie beside each other share it
            pairs_[i].weight *= std::min(1.0, wall.length() / covered);
    }
}

VECTORLIB_BODY LineSegmentRegistration MapRegistration::registration(Vector2D<double> middle) const {
    const Transformation2D toMiddle(-middle.x, -middle.y, 0);
    LineSegmentRegistration all;
    for (const SegmentPair &pair : pairs_)
        all.add(toMiddle * pair.fixed, toMiddle * pair.moving, pair.weight);
    return all;
}

VECTORLIB_BODY Vector2D<double> MapRegistration::middle() const {
    Vector2D<double> sum;
    double weight = 0;
    for (const SegmentPair &pair : pairs_) {
        sum += pair.moving.middle() * pair.weight;
        weight += pair.weight;
    }
    return weight > 0 ? sum * (1 / weight) : sum;
}

VECTORLIB_BODY MapOverlap MapRegistration::judge(const Transformation2D &motion) const {
    MapOverlap overlap{motion, 0, 0, registration(middle()).reliability()};
    double squares = 0;
    for (const SegmentPair &pair : pairs_) {
        overlap.length += pair.weight;
        squares += pair.weight * apart(pair.fixed, pair.moving);
    }
    overlap.rms = overlap.length > 0 ? std::sqrt(squares / overlap.length) : 0;
    return overlap;
}

VECTORLIB_BODY MapAlignment MapAligner::operator()(VectorMap &fixed, const std::vector<MapEdge> &moving) {
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

VECTORLIB_BODY MapAlignment MapAligner::confirm(VectorMap &fixed, const std::vector<MapEdge> &moving,
                                                const Transformation2D &told) {
    MapAlignment result;
    findPlaces(moving);
    result.places = places_.size();
    result.overlap = registration(fixed, moving, told);
    inFixed_.index().follow(fixed.slots());
    forEachFit(result.overlap.motion, [&](const PlaceFit &fit) {
        result.agree += fit.explainedShare() >= leastAlike && fit.hiddenShare() <= maxHidden;
        result.against += isAgainst(fit);
    });
    if (result.against > 0 && 2 * result.against >= result.agree)
        result.outcome = MapAlignment::Outcome::Contradicted;
    else if (result.agree >= 3 * leastAgree)
        result.outcome = MapAlignment::Outcome::Found;
    return result;
}

VECTORLIB_BODY void MapAligner::findPlaces(const std::vector<MapEdge> &map) {
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
    if (places_.size() <= maxPlaces)
        return;
    for (std::size_t i = 0; i < maxPlaces; ++i)
        places_[i] = places_[i * places_.size() / maxPlaces];
    places_.resize(maxPlaces);
}

VECTORLIB_BODY double MapAligner::see(const std::vector<LineSegment2D<double>> &walls, PlaceOfMap &place) {
    observe_.maxRange = reach;
    double seen = 0;
    for (const VisiblePart<double> &part : observe_(walls, place.pose))
        if (part.segment.length() >= 0.1) {
            seen += part.segment.length();
            place.edges.emplace_back(TlsSums(), part.segment, 0);
        }
    return seen;
}

VECTORLIB_BODY void MapAligner::findVotes(VectorMap &fixed, const std::vector<MapEdge> &moving) {
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

VECTORLIB_BODY const Relocalized &MapAligner::search(PlaceSearch &search, const std::vector<MapEdge> &map,
                                                     const PlaceOfMap &place) {
    search.maxSeconds = 1e6; // the result is always the same
    return search(map, place.edges, {});
}

VECTORLIB_BODY std::size_t MapAligner::bestVote(MapAlignment &result) const {
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

VECTORLIB_BODY Transformation2D MapAligner::motionOfAll(const Vote &best) const {
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

} // namespace vectorlib
