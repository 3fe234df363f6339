#include "gui/vector/evaluation/Evaluation.h"
#include "gui/vector/Failure.h"
#include "vectorlib/geometry/Angle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <unordered_map>

namespace hermes::vector {

using vectorlib::Pose2D;

namespace {

/// Numbers of poses by the square in which they lie.
class PoseGrid {
public:
    explicit PoseGrid(double side)
        : side_(side) {}

    void insert(const Pose2D &pose, std::size_t number) {
        cells_[keyOf(cellOf(pose.x), cellOf(pose.y))].push_back(number);
    }
    /// Those in the pose's square and the eight around it.
    template <typename Take>
    void forEachNear(const Pose2D &pose, Take take) const {
        for (std::int64_t x = cellOf(pose.x) - 1; x <= cellOf(pose.x) + 1; ++x)
            for (std::int64_t y = cellOf(pose.y) - 1; y <= cellOf(pose.y) + 1; ++y)
                if (const auto cell = cells_.find(keyOf(x, y)); cell != cells_.end())
                    for (const std::size_t number : cell->second)
                        take(number);
    }

private:
    std::int64_t cellOf(double metres) const { return std::int64_t(std::floor(metres / side_)); }
    static std::uint64_t keyOf(std::int64_t x, std::int64_t y) {
        return std::uint64_t(x) << 32 ^ (std::uint64_t(y) & 0xffffffff);
    }

    double side_;
    std::unordered_map<std::uint64_t, std::vector<std::size_t>> cells_;
};

std::vector<double> wayAlong(const std::vector<Pose2D> &drive) {
    std::vector<double> way(drive.size());
    for (std::size_t i = 1; i < drive.size(); ++i)
        way[i] = way[i - 1] + std::hypot(drive[i].x - drive[i - 1].x, drive[i].y - drive[i - 1].y);
    return way;
}

} // namespace

void forEachRevisit(const std::vector<Pose2D> &drive, const RevisitRule &rule,
                    const std::function<void(std::size_t, std::size_t)> &take) {
    const std::vector<double> way = wayAlong(drive);
    PoseGrid grid(rule.metres);
    std::size_t behind = 0; // poses far enough back on the way
    for (std::size_t later = 0; later < drive.size(); ++later) {
        for (; behind + rule.scans <= later && way[later] - way[behind] >= rule.way; ++behind)
            grid.insert(drive[behind], behind);
        const Pose2D &here = drive[later];
        grid.forEachNear(here, [&](std::size_t earlier) {
            const Pose2D &there = drive[earlier];
            const double turn = std::remainder(here.theta - there.theta, 2 * vectorlib::pi);
            if (std::hypot(here.x - there.x, here.y - there.y) < rule.metres &&
                std::abs(turn) < rule.degrees * vectorlib::pi / 180)
                take(earlier, later);
        });
    }
}

using vectorlib::Pose2D;
using vectorlib::StampedPose;
using vectorlib::Transformation2D;

Evaluation::Evaluation(const vectorlib::CarmenLog &log, const std::vector<StampedPose> &trajectory,
                       const std::string &name)
    : poses_(trajectory.size()) {
    for (const vectorlib::CarmenScan &scan : log.scans)
        reference_.push_back(scan.laserPose);
    if (isOneByOne(log, trajectory))
        pairOneByOne(trajectory);
    else
        pairByStamps(log, trajectory, name);
    if (pairs_.size() < 2)
        throw Failure(name + ": found " + std::to_string(trajectory.size()) + " poses, " +
                      std::to_string(pairs_.size()) + " of them at the time of one of the log's " +
                      std::to_string(log.scans.size()) + " scans, expected two or more");
    compareConsecutive();
    compareRevisits();
}

void Evaluation::pairOneByOne(const std::vector<StampedPose> &trajectory) {
    for (std::size_t i = 0; i < trajectory.size(); ++i)
        pairs_.push_back({i, trajectory[i].pose});
}

// As many poses as scans; a tenth at the same time are enough, as where a log steps back others cannot be.
bool Evaluation::isOneByOne(const vectorlib::CarmenLog &log, const std::vector<StampedPose> &trajectory) {
    if (trajectory.size() != log.scans.size())
        return false;
    std::size_t same = 0;
    for (std::size_t i = 0; i < trajectory.size(); ++i)
        same += std::abs(trajectory[i].stamp - log.scans[i].stamp) <= sameStamp;
    return same * 10 >= trajectory.size();
}

// Each scan and the pose nearest to it that has no scan nearer to itself.
void Evaluation::pairByStamps(const vectorlib::CarmenLog &log, const std::vector<StampedPose> &trajectory,
                              const std::string &name) {
    constexpr double oneStamp = 0.001; // seconds
    std::vector<std::size_t> byStamp(log.scans.size());
    std::iota(byStamp.begin(), byStamp.end(), std::size_t(0));
    const auto stampAt = [&](std::size_t place) { return log.scans[byStamp[place]].stamp; };
    std::stable_sort(byStamp.begin(), byStamp.end(),
                     [&](std::size_t a, std::size_t b) { return log.scans[a].stamp < log.scans[b].stamp; });
    std::vector<const StampedPose *> poseOf(log.scans.size());
    std::size_t several = 0; // poses at the time of more than one scan
    for (const StampedPose &p : trajectory) {
        auto place = std::size_t(
            std::lower_bound(byStamp.begin(), byStamp.end(), p.stamp,
                             [&](std::size_t scan, double stamp) { return log.scans[scan].stamp < stamp; }) -
            byStamp.begin());
        if (place == byStamp.size() || (place > 0 && p.stamp - stampAt(place - 1) < stampAt(place) - p.stamp))
            --place;
        const double apart = std::abs(stampAt(place) - p.stamp);
        if (!(apart <= sameStamp))
            continue;
        several += (place > 0 && stampAt(place) - stampAt(place - 1) < oneStamp) ||
                   (place + 1 < byStamp.size() && stampAt(place + 1) - stampAt(place) < oneStamp);
        const StampedPose *&nearest = poseOf[byStamp[place]];
        if (!nearest || apart < std::abs(nearest->stamp - stampAt(place)))
            nearest = &p;
    }
    if (several * 10 > trajectory.size())
        throw Failure(name + ": found " + std::to_string(several) + " of " +
                      std::to_string(trajectory.size()) +
                      " poses at the time of several scans of the log, so that their stamps do not tell the "
                      "scan; expected a pose for each of its " +
                      std::to_string(log.scans.size()) + " scans");
    for (std::size_t scan = 0; scan < poseOf.size(); ++scan)
        if (poseOf[scan])
            pairs_.push_back({scan, poseOf[scan]->pose});
}

// How far off the turns of a hundred stretches of the drive are, of all that it turns: 0 is right, 1 as wrong
// as no turn at all. Nothing where there are too few stretches, or they turn too little, to tell.
std::optional<double> Evaluation::turnsMissed() const {
    constexpr std::size_t most = 100, fewest = 20;
    constexpr double least = 0.05; // radians a stretch: several times what a reference is off
    const std::size_t stride = std::max<std::size_t>(1, pairs_.size() / most);
    double turned = 0, missed = 0;
    std::size_t stretches = 0;
    for (std::size_t i = stride; i < pairs_.size(); i += stride, ++stretches) {
        const double turn = referenceOf(pairs_[i - stride], pairs_[i]).alpha();
        turned += std::abs(vectorlib::wrapAngle(turn));
        missed += std::abs(vectorlib::wrapAngle(motionOf(pairs_[i - stride], pairs_[i]).alpha() - turn));
    }
    if (stretches < fewest || turned < least * double(stretches))
        return std::nullopt;
    return missed / turned;
}

void Evaluation::expectSameDrive(const std::string &log, const std::string &trajectory,
                                 std::ostream &warnings) const {
    constexpr double most = 0.7; // docs/hermes-vector-map.md has what right and wrong logs have
    const std::optional<double> missed = turnsMissed();
    const std::string found = std::to_string(pairs_.size()) + " of " + std::to_string(poses_) +
                              " poses at the time of one of the " + std::to_string(reference_.size()) +
                              " scans of " + log;
    if (missed && *missed > most)
        throw Failure(trajectory + ": found " + found + ", but turns that are off by " +
                      std::to_string(std::lround(*missed * 100)) + " % of the log's, expected at most " +
                      std::to_string(std::lround(most * 100)) +
                      " %: it is another log's, or has no headings");
    if (pairs_.size() * 2 >= std::min(poses_, reference_.size()))
        return;
    if (!missed)
        throw Failure(trajectory + ": found only " + found +
                      ", expected half of them, or enough to see that they turn as the log does: is it "
                      "another log's?");
    warnings << "hermes-vector: " << trajectory << ": only " << found << '\n';
}

void Evaluation::compareRevisits() {
    std::vector<const Pair *> pairOf(reference_.size());
    for (const Pair &p : pairs_)
        pairOf[p.scan] = &p;
    const auto forEachPair = [&](auto take) {
        forEachRevisit(reference_, {}, [&](std::size_t earlier, std::size_t later) {
            if (pairOf[earlier] && pairOf[later])
                take(*pairOf[earlier], *pairOf[later]);
        });
    };
    forEachPair([this](const Pair &, const Pair &) { ++revisitPairs_; });
    const std::size_t step = std::max<std::size_t>(1, (revisitPairs_ + maxPairs - 1) / maxPairs);
    errorOf_.resize(reference_.size());
    std::size_t number = 0;
    forEachPair([&](const Pair &earlier, const Pair &later) {
        if (number++ % step != 0)
            return;
        revisits_.add(referenceOf(earlier, later), motionOf(earlier, later));
        ScanError &error = errorOf_[later.scan];
        error.sum += revisits_.lastMetres();
        ++error.count;
    });
}

nlohmann::ordered_json Evaluation::summary() const {
    nlohmann::ordered_json consecutive = {{"motions", consecutive_.size()}};
    consecutive.update(consecutive_.summary());
    nlohmann::ordered_json revisits = {{"pairs", revisitPairs_}, {"compared", revisits_.size()}};
    revisits.update(revisits_.summary());
    return {{"scans", reference_.size()},
            {"poses", poses_},
            {"compared", pairs_.size()},
            {"consecutive", consecutive},
            {"revisits", revisits}};
}

// The motion with the least squares of distances between the places of both.
Transformation2D Evaluation::ontoReference() const {
    Point from, to;
    for (const Pair &p : pairs_) {
        from = from + Point(p.pose.x, p.pose.y);
        to = to + Point(reference_[p.scan].x, reference_[p.scan].y);
    }
    from = from * (1 / double(pairs_.size()));
    to = to * (1 / double(pairs_.size()));
    double along = 0, across = 0;
    for (const Pair &p : pairs_) {
        const Point a = Point(p.pose.x, p.pose.y) - from,
                    b = Point(reference_[p.scan].x, reference_[p.scan].y) - to;
        along += a.dot(b);
        across += a.x * b.y - a.y * b.x;
    }
    const Transformation2D turned(0, 0, std::atan2(across, along));
    const Point shift = to - turned * from;
    return {shift.x, shift.y, turned.alpha()};
}

vectorlib::SvgPicture Evaluation::picture(const std::string &title) const {
    namespace colour = vectorlib::colour;
    constexpr double small = 0.1, large = 0.5; // metres
    const Transformation2D onto = ontoReference();
    Path reference, found;
    for (const Pose2D &p : reference_)
        reference.emplace_back(p.x, p.y);
    for (const Pair &p : pairs_)
        found.push_back(onto * Point(p.pose.x, p.pose.y));
    vectorlib::SvgPicture picture(title);
    picture.path({colour::reference, 1.5, "reference", true}, reference);
    picture.path({colour::estimate, 1.2, "trajectory, laid onto it"}, found);
    std::array<Path, 3> again;
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
        const ScanError &error = errorOf_[pairs_[i].scan];
        if (error.count == 0)
            continue;
        const double mean = error.sum / double(error.count);
        again[mean < small ? 0 : mean < large ? 1 : 2].push_back(found[i]);
    }
    picture.points({"#009e73", 5, "place met again: off by less than 10 cm"}, again[0]);
    picture.points({colour::before, 5, "by 10 to 50 cm"}, again[1]);
    picture.points({colour::outliers, 5, "by more"}, again[2]);
    return picture;
}

} // namespace hermes::vector
