#include "vectorlib/mapping/SecondScanner.h"
#include "vectorlib/motion/MotionModel.h"

#include <algorithm>
#include <cmath>

namespace vectorlib {

VECTORLIB_BODY void SecondScanner::setMounts(const Pose2D &first, const Pose2D &second) {
    const Pose2D mount = first.inverse() * second;
    const Transformation2D moved = mount_.inverse() * Transformation2D(mount);
    first_ = first;
    mount_ = Transformation2D(mount);
    if (!moved.exceeds(1e-6, 1e-6))
        return;
    state_ = State::OnTrial;
    off_ = {};
    bad_ = compared_ = closed_ = places_ = failures_ = 0;
    begin_ = -std::numeric_limits<double>::infinity();
    lastPlace_.reset();
    placeEdges_.clear();
}

VECTORLIB_BODY void SecondScanner::bring(const SecondScan &scan, double stamp, const Twist2D &twist,
                                         const EdgeExtractor &first) {
    const Vector2D<double> at = mount_.translation();
    const double vx = twist.vx - twist.omega * at.y, vy = twist.vy + twist.omega * at.x; // of its place
    const double c = mount_.cos(), s = mount_.sin();
    points_ = scan.points;
    seconds_ = scan.seconds;
    seconds_.resize(points_.size()); // at once
    compensateMotion(points_, seconds_, float(stamp - scan.stamp),
                     {c * vx + s * vy, c * vy - s * vx, twist.omega});
    extract_.segment.settings = EarSettings::forScanner(2 * pi, scan.rays);
    extract_.vectorize.settings = first.vectorize.settings;
    edges_ = extract_(points_);
    for (EdgeRaw2D &edge : edges_)
        edge = mount_ * edge;
}

VECTORLIB_BODY void SecondScanner::begin(const SecondScan &scan) {
    const double since = scan.begin() - begin_;
    double swept = 0;
    for (std::size_t i = 1; i < scan.seconds.size(); ++i)
        swept += double(std::abs(scan.seconds[i] - scan.seconds[i - 1]));
    isPlausible_ = since > 0 && scan.end() - scan.begin() < longestTurn * since && swept < mostSwept * since;
    begin_ = scan.begin();
}

VECTORLIB_BODY void SecondScanner::move(const Transformation2D &moved) {
    if (lastPlace_)
        lastPlace_ = moved * *lastPlace_;
    for (LineSegment2D<double> &segment : placeEdges_)
        segment = moved * segment;
}

VECTORLIB_BODY bool SecondScanner::isShown(const MapBuilder &builder) const {
    double seen = 0, shown = 0;
    for (const EdgeRaw2D &edge : builder.beside)
        seen += edge.segment.length();
    for (const CorrespondencePair &pair : builder.match().pairs)
        if (std::size_t(pair.moving) >= builder.own())
            shown += builder.edges()[std::size_t(pair.moving)].segment.length();
    return shown > nearlyAll * seen;
}

VECTORLIB_BODY bool SecondScanner::agrees(const MapBuilder &builder, double contradicted) {
    const Compared compared = compare(builder);
    bool isBad = !isPlausible_ || contradicted > maxContradicted;
    if (!isBad || !isTaken()) // then it may be mounted otherwise
        isBad = !follow(compared) || isBad;
    if (isBad) {
        places_ = 0;
        bad_ = std::min(bad_ + badScan, enoughBad);
        return bad_ < enoughBad ? false : refuse();
    }
    if (!compared.off) // what the map shows of the first alone is to be doubted
        return !compared.byFirst;
    bad_ = std::max(0, bad_ - 1);
    if (Transformation2D(off_).exceeds(most_m, most_rad))
        return refuse();
    if (bad_ == 0 && !isTaken())
        takePlace(Transformation2D(builder.report().pose), compared.isOpen);
    return true;
}

VECTORLIB_BODY void SecondScanner::takePlace(const Transformation2D &place, bool isOpen) {
    state_ = State::OnTrial;
    if (lastPlace_ && !(lastPlace_->inverse() * place).exceeds(apart_m, isOpen ? pi : apart_rad))
        return;
    if (isOpen) { // the map does not tell which way it looks, but its own sight of the last place does
        const Match &own = track_(placeEdges_, edges_, place);
        const bool isAlike = !(place.inverse() * own.pose).exceeds(most_m, most_rad);
        places_ += own.accepted && own.reliability >= openReliability && isAlike;
    } else
        ++places_;
    lastPlace_ = place;
    placeEdges_.clear();
    for (const EdgeRaw2D &edge : edges_)
        placeEdges_.push_back((place * edge).segment);
    if (places_ >= enoughPlaces * (1 + failures_))
        state_ = State::Taken;
}

VECTORLIB_BODY bool SecondScanner::refuse() {
    failures_ += isTaken();
    state_ = State::Contradicted;
    places_ = 0;
    return false;
}

VECTORLIB_BODY bool SecondScanner::follow(const Compared &compared) {
    if (!compared.off)
        return true;
    Pose2D off = *compared.off;
    if (compared.isOpen) {
        off.x = off_.x;
        off.y = off_.y;
    } else if (closed_ == 0) { // the first that tells where it is
        off_.x = off.x;
        off_.y = off.y;
    }
    const auto isFar = [&off](const Pose2D &from) {
        return Transformation2D(from.inverse() * off).exceeds(most_m / 2, most_rad / 2);
    };
    const bool strays = compared_ > 0 && isFar(off_), isAlone = strays && isFar(last_);
    last_ = off;
    if (!isAlone) {
        closed_ += !compared.isOpen;
        const double place = std::max(leastShare, 1.0 / std::max(1, closed_)),
                     turn = std::max(leastShare, 1.0 / ++compared_);
        off_.x += place * (off.x - off_.x);
        off_.y += place * (off.y - off_.y);
        off_.theta += turn * (off.theta - off_.theta);
    }
    return !strays && !Transformation2D(off).exceeds(wild_m, wild_rad);
}

VECTORLIB_BODY SecondScanner::Compared SecondScanner::compare(const MapBuilder &builder) {
    const std::vector<EdgeRaw2D> &all = builder.edges();
    firstEdges_.assign(all.begin(), all.begin() + std::ptrdiff_t(builder.own()));
    const Transformation2D pose(builder.report().pose);
    const Match first = track_(builder.known(), firstEdges_, pose);
    const Match &second = track_(builder.known(), edges_, pose);
    Compared compared;
    compared.byFirst = first.accepted;
    compared.isOpen = std::min(first.reliability, second.reliability) < openReliability;
    if (first.accepted && second.accepted)
        compared.off = (mount_.inverse() * first.pose.inverse() * second.pose * mount_).pose();
    return compared;
}

} // namespace vectorlib
