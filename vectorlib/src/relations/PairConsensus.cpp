#include "vectorlib/relations/PairConsensus.h"
#include "vectorlib/observation/Observer.h"
#include "vectorlib/relations/RelationMatcher.h"
#include "vectorlib/tls/TlsFit.h"

namespace vectorlib {

VECTORLIB_BODY int PairConsensus::propose(const std::vector<CorrespondencePair> &pairs,
                                          const Segments &reference, const Segments &current, int most) {
    count_ = 0;
    most_ = std::min(most, static_cast<int>(proposals_.size()));
    const auto consider = [&](const Transformation2D &guess) {
        choose(pairs, reference, current, guess);
        enter({guess, length_});
    };
    Transformation2D guess;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        for (std::size_t j = i + 1; j < pairs.size(); ++j)
            if (poseOf(pairs[i], pairs[j], reference, current, guess))
                consider(guess);
        for (const bool atEnd : {false, true})
            if (poseByEnd(at(reference, pairs[i].fixed), at(current, pairs[i].moving), atEnd, guess))
                consider(guess);
    }
    return count_;
}

VECTORLIB_BODY Transformation2D PairConsensus::settle(int proposal, const Segments &reference,
                                                      const Segments &current) {
    Transformation2D pose = proposals_[static_cast<std::size_t>(proposal)].pose;
    for (int i = 0; i < rounds; ++i) {
        chooseAll(reference, current, pose);
        pose = refinement(reference, current, pose) * pose;
    }
    chooseAll(reference, current, pose);
    enterPairs(reference, current, pose);
    deviation_ = chosen_.empty() ? noHit : deviationOf(pose);
    return pose;
}

VECTORLIB_BODY void PairConsensus::choose(const std::vector<CorrespondencePair> &pairs,
                                          const Segments &reference, const Segments &current,
                                          const Transformation2D &pose) {
    chosen_.clear();
    length_ = 0;
    for (const CorrespondencePair &p : pairs)
        if (apart(at(reference, p.fixed).segment, pose * at(current, p.moving).segment) <= distance) {
            chosen_.push_back(p);
            length_ +=
                std::min(at(reference, p.fixed).segment.length(), at(current, p.moving).segment.length());
        }
}

VECTORLIB_BODY void PairConsensus::chooseAll(const Segments &reference, const Segments &current,
                                             const Transformation2D &pose) {
    chosen_.clear();
    length_ = 0;
    for (std::size_t j = 0; j < current.size(); ++j) {
        const LineSegment2D<double> c = pose * current[j].segment;
        double least = distance, length = 0;
        int nearest = -1;
        for (std::size_t i = 0; i < reference.size(); ++i) {
            const LineSegment2D<double> &r = reference[i].segment;
            const double d = apart(r, c), shorter = std::min(r.length(), c.length());
            if (d <= least && r.overlap(c) >= overlap * shorter) {
                least = d;
                nearest = static_cast<int>(i);
                length = shorter;
            }
        }
        if (nearest >= 0) {
            chosen_.push_back({nearest, static_cast<int>(j)});
            length_ += length;
        }
    }
}

VECTORLIB_BODY Transformation2D PairConsensus::refinement(const Segments &reference, const Segments &current,
                                                          const Transformation2D &pose) {
    refine_.start(1e-6, 1e-6);
    for (const CorrespondencePair &p : chosen_) {
        const TypedSegment &r = at(reference, p.fixed), &c = at(current, p.moving);
        if (c.segment.length() < r.segment.length())
            refine_.add(lineOf(r), pose * sumsOf(c), 1);
        else
            refine_.addStatic(pose * lineOf(c), sumsOf(r), 1);
    }
    if (!(deviationOf(pose) <= linesSuffice))
        for (const CorrespondencePair &p : chosen_)
            for (const bool atEnd : {false, true})
                addCommonEnd(at(reference, p.fixed), at(current, p.moving), atEnd, pose);
    return refine_.step();
}

VECTORLIB_BODY void PairConsensus::addCommonEnd(const TypedSegment &r, const TypedSegment &c, bool atEnd,
                                                const Transformation2D &pose) {
    Vector2D<double> there, here;
    if (!commonEnd(r, c, atEnd, there, here))
        return;
    const Vector2D<double> v = r.segment.direction(), across(v.y, -v.x), moved = pose * here;
    const double a = (atEnd ? r.end : r.begin).slack, b = (atEnd ? c.end : c.begin).slack;
    if (std::abs(v.dot(moved - there)) > distance + a + b)
        return;
    TlsSums point;
    point.n = 1;
    point.mean = moved;
    // Ends are spread evenly over their slack; a corner of lines is about as sure as a few points.
    const double variance = 2 * noise * noise + (a * a + b * b) / 3;
    refine_.add(LineSegment2D<double>(there, there + across, across), point, noise * noise / variance);
}

VECTORLIB_BODY double PairConsensus::deviationOf(const Transformation2D &pose) const {
    Eigen::Matrix<double, 2, 3> j;
    j << 1, 0, -pose.y(), 0, 1, pose.x();
    const Eigen::Matrix3d covariance = refine_.information().inverse();
    const double variance = 2 * noise * noise * (j * covariance * j.transpose()).trace();
    return variance > 0 ? std::sqrt(variance) : noHit;
}

VECTORLIB_BODY LineSegment2D<double> PairConsensus::lineOf(const TypedSegment &s) {
    const Line2D line = s.sums.n > 2 ? fitLine(s.sums).line : Line2D();
    if (!line.isValid())
        return s.segment;
    const Vector2D<double> v = line.direction(), mean = s.sums.mean;
    return {mean, mean + v, v};
}

VECTORLIB_BODY TlsSums PairConsensus::sumsOf(const TypedSegment &s) {
    if (s.sums.n > 0)
        return s.sums;
    const double length = s.segment.length(), n = 20 * length, moment = n * length * length / 12;
    const Vector2D<double> v = s.segment.direction();
    TlsSums sums;
    sums.n = n;
    sums.mean = s.segment.middle();
    sums.xx = moment * v.x * v.x;
    sums.xy = moment * v.x * v.y;
    sums.yy = moment * v.y * v.y;
    return sums;
}

VECTORLIB_BODY void PairConsensus::enter(const Proposal &p) {
    if (!(p.length > 0) || most_ == 0)
        return;
    int place = -1;
    for (int i = 0; i < count_ && place < 0; ++i)
        if (isNear(proposals_[static_cast<std::size_t>(i)].pose, p.pose))
            place = i;
    if (place < 0)
        place = count_ < most_ ? addEmpty() : most_ - 1;
    else if (proposals_[static_cast<std::size_t>(place)].length >= p.length)
        return;
    Proposal &kept = proposals_[static_cast<std::size_t>(place)];
    if (kept.length >= p.length)
        return;
    kept = p;
    for (; place > 0; --place) {
        Proposal &better = proposals_[static_cast<std::size_t>(place - 1)];
        if (better.length >= proposals_[static_cast<std::size_t>(place)].length)
            break;
        std::swap(better, proposals_[static_cast<std::size_t>(place)]);
    }
}

VECTORLIB_BODY bool PairConsensus::commonEnd(const TypedSegment &r, const TypedSegment &c, bool atEnd,
                                             Vector2D<double> &there, Vector2D<double> &here) const {
    const SegmentEnd &a = atEnd ? r.end : r.begin, &b = atEnd ? c.end : c.begin;
    there = atEnd ? r.segment.end() : r.segment.begin();
    here = atEnd ? c.segment.end() : c.segment.begin();
    return a.isEdge() && b.isEdge() && a.slack <= distance && b.slack <= distance;
}

VECTORLIB_BODY bool PairConsensus::poseByEnd(const TypedSegment &r, const TypedSegment &c, bool atEnd,
                                             Transformation2D &pose) const {
    Vector2D<double> there, here;
    if (!commonEnd(r, c, atEnd, there, here))
        return false;
    const Vector2D<double> v = r.segment.direction(), d = c.segment.direction();
    const double alpha = std::atan2(d.cross(v), d.dot(v));
    const Transformation2D turn(0, 0, alpha);
    const Vector2D<double> t =
        v * v.dot(there - turn * here) - v.left() * r.segment.across(turn * c.segment.middle());
    pose = Transformation2D(t.x, t.y, alpha);
    return true;
}

VECTORLIB_BODY bool PairConsensus::poseOf(const CorrespondencePair &p, const CorrespondencePair &q,
                                          const Segments &reference, const Segments &current,
                                          Transformation2D &pose) const {
    const LineSegment2D<double> &a = at(reference, p.fixed).segment, &b = at(reference, q.fixed).segment;
    const LineSegment2D<double> &c = at(current, p.moving).segment, &d = at(current, q.moving).segment;
    const double det = a.direction().cross(b.direction());
    if (std::abs(det) < std::sin(leastAngle))
        return false;
    const double wp = precisionValue(a, c), wq = precisionValue(b, d);
    const Vector2D<double> u = a.direction(), v = b.direction(), s = c.direction(), t = d.direction();
    const double alpha = std::atan2(wp * s.cross(u) + wq * t.cross(v), wp * s.dot(u) + wq * t.dot(v));
    const Transformation2D turn(0, 0, alpha);
    const double first = -a.across(turn * c.middle()), second = -b.across(turn * d.middle());
    // n_a . x = first, n_b . x = second
    const Vector2D<double> x = (v * first - u * second) / det;
    pose = Transformation2D(x.x, x.y, alpha);
    return true;
}

VECTORLIB_BODY void PairConsensus::enterPairs(const Segments &reference, const Segments &current,
                                              const Transformation2D &pose) {
    registration_.clear();
    for (const CorrespondencePair &p : chosen_) {
        const LineSegment2D<double> &r = at(reference, p.fixed).segment, &c = at(current, p.moving).segment;
        registration_.add(r, pose * c, std::min(r.length(), c.length()));
    }
}

} // namespace vectorlib
