#include "daemons/scanmatcher/MapCorrector.h"

#include "common/Log.h"

#include <chrono>

namespace hermes::scanmatcher {

using vectorlib::PoseConstraint;
using vectorlib::ScanTracker;
using vectorlib::Transformation2D;

namespace {

using Clock = std::chrono::steady_clock;

constexpr quint64 maxWaiting = 1000;                // scans
constexpr std::chrono::milliseconds pause(500);     // without a scan, after which all news count
constexpr double least_m = 0.01, least_rad = 0.003; // by which a pose must move to be worth a new map
constexpr double still_m = 0.02, still_rad = 0.01;  // what the next scan shows is not worth remembering
constexpr quint64 fewLeft = 2;                      // scans that the matching places itself
constexpr int maxRounds = 20;                       // in which the thread catches up

} // namespace

void MapCorrector::stop() {
    {
        const std::lock_guard lock(mutex_);
        ending_ = true;
    }
    wake_.notify_all();
    if (thread_.joinable())
        thread_.join();
}

void MapCorrector::follow(bool follows, const ScanTracker &tracker) {
    if (std::exchange(follows_, follows) == follows)
        return;
    if (!follows)
        forget({}); // a correction that is under way comes too late
    else if (!isResumed_)
        restart(tracker);
}

// A robot that stands for a day must not fill the memory with what it sees, or does not see.
bool MapCorrector::isStill(const Seen &seen) {
    return seen.by != vectorlib::TrackedBy::Placed && seen.motion.translation().norm() < still_m &&
           std::abs(seen.motion.alpha()) < still_rad;
}

// That has some scans already.
void MapCorrector::beginDrive(quint64 scans) {
    {
        const std::lock_guard lock(mutex_);
        ++drive_;
        taken_ = scans;
        state_.isFull = state_.isDue = false;
        state_.keys = state_.bytes = 0;
        state_.loops = {};
    }
    added_ = scans;
    pose_.reset();
    isResumed_ = false;
    leftOut_.reset();
    pending_.clear();
}

void MapCorrector::restart(const ScanTracker &tracker) {
    std::vector<vectorlib::MapEdge> known;
    tracker.builder.map.forEach([&](const vectorlib::MapEdge &edge) { known.push_back(edge); });
    forget(std::move(known));
}

void MapCorrector::forget(std::vector<vectorlib::MapEdge> known) {
    if (const CorrectorState lost = state(); lost.keys > 0)
        logInfo("loops", QString("a drive of %1 key scans is not remembered any more; %2")
                             .arg(lost.keys)
                             .arg(lost.journal.path.isEmpty() ? QString("no journal was kept")
                                                              : "it is in " + lost.journal.path));
    beginDrive(0);
    Item item;
    item.drive = drive_;
    item.known = std::move(known);
    push(std::move(item));
}

void MapCorrector::resume(std::unique_ptr<RememberedDrive> remembered) {
    const vectorlib::LoopCloser &loops = remembered->drive.loops;
    beginDrive(loops.scans());
    pose_ = lastTaken_ = Transformation2D(loops.pose(loops.scans() - 1));
    isResumed_ = true;
    Item item;
    item.drive = drive_;
    item.remembered = std::move(remembered);
    push(std::move(item));
}

void MapCorrector::add(const ScanTracker &tracker, const std::vector<vectorlib::Vector2D<float>> &points,
                       bool isInterrupted) {
    if (!follows_)
        return;
    if (state().isFull)
        return pending_.clear(); // no correction comes any more that would need them
    const Transformation2D pose(tracker.builder.report().pose);
    Seen seen;
    seen.number = tracker.counts().scans - 1;
    const bool isResumed = std::exchange(isResumed_, false) || (isInterrupted && pose_);
    seen.motion = !pose_ ? pose : isResumed ? pose_->inverse() * pose : tracker.tracked(*pose_);
    seen.by = isResumed ? vectorlib::TrackedBy::Placed : tracker.trackedBy();
    seen.trust = tracker.trust();
    pose_ = pose;
    if (leftOut_) {
        seen.motion = leftOut_->motion * seen.motion;
        seen.by = std::max(seen.by, leftOut_->by);
    }
    const bool showsNothing =
        points.empty() || tracker.builder.report().outcome == vectorlib::ScanReport::Outcome::Skipped;
    if (added_ > 0 && (showsNothing || isStill(seen))) {
        leftOut_ = std::move(seen);
        return;
    }
    {
        const std::lock_guard lock(mutex_);
        if (state_.waiting >= maxWaiting) {
            ++state_.dropped;
            leftOut_ = std::move(seen);
            return;
        }
        ++state_.waiting;
        forgetPending(taken_);
    }
    leftOut_.reset();
    seen.points = points;
    if (tracker.isStraight() && tracker.draws())
        seen.edges = tracker.builder.edges();
    seen.own = std::uint32_t(tracker.builder.own());
    ++added_;
    Item item;
    item.drive = drive_;
    item.scan = std::make_shared<const Seen>(std::move(seen));
    pending_.push_back({item.scan, pose});
    push(std::move(item));
}

bool MapCorrector::apply(ScanTracker &tracker, Correction &correction) {
    const auto begin = Clock::now();
    const bool isOfThisDrive = correction.drive == drive_ && pose_;
    if (isOfThisDrive) {
        forgetPending(correction.scans);
        const Transformation2D last(correction.last), moved = last * lastTaken_.inverse();
        lastTaken_ = last;
        pose_ = moved * *pose_;
        tracker.correct(correction.map, moved);
        for (Pending &p : pending_) {
            p.pose = moved * p.pose;
            tracker.builder.place(p.scan->edges, p.pose.pose());
        }
    }
    const std::chrono::duration<double, std::milli> stall = Clock::now() - begin;
    {
        const std::lock_guard lock(mutex_);
        state_.corrections += isOfThisDrive;
        state_.longestStallMs = std::max(state_.longestStallMs, stall.count());
    }
    return isOfThisDrive;
}

void MapCorrector::acknowledge() {
    const std::lock_guard lock(mutex_);
    isHandedOver_ = false;
    wake_.notify_all();
}

CorrectorState MapCorrector::state() const {
    const std::lock_guard lock(mutex_);
    CorrectorState state = state_;
    state.journal = journal_.state();
    return state;
}

void MapCorrector::push(Item item) {
    const std::lock_guard lock(mutex_);
    items_.push_back(std::move(item));
    wake_.notify_all();
}

void MapCorrector::run() {
    for (;;) {
        const bool isQuiet = !wait();
        if (isEnding())
            break;
        take();
        if (memory_.loops.isDue() || ((isQuiet || isFull_) && memory_.loops.hasNews())) {
            tellUnderWay(true);
            correct();
            tellUnderWay(false);
        } else {
            tellGrown();
        }
        journal_.write(memory_, trust_);
        if (isFull_ && !memory_.loops.hasNews())
            tellFull();
    }
    journal_.finish(memory_, trust_);
}

// False where nothing came for a while.
bool MapCorrector::wait() {
    std::unique_lock lock(mutex_);
    return wake_.wait_for(lock, pause, [this] { return ending_ || !items_.empty(); });
}

// What waits, and no more: a queue that fills meanwhile must not keep a correction from being made.
void MapCorrector::take() {
    std::size_t count;
    {
        const std::lock_guard lock(mutex_);
        count = items_.size();
    }
    for (; count > 0; --count) {
        Item item;
        {
            const std::lock_guard lock(mutex_);
            if (ending_)
                return;
            item = std::move(items_.front());
            items_.pop_front();
        }
        take(item);
    }
}

void MapCorrector::take(const Item &item) {
    if (item.old)
        return;
    if (!item.scan)
        return remember(item);
    isFull_ = isFull_ || memory_.bytes() >= limit_;
    if (isFull_) { // the last correction leaves it to the matching's thread
        const std::lock_guard lock(mutex_);
        --state_.waiting;
        return;
    }
    const Seen &seen = *item.scan;
    memory_.add(seen.points, seen.edges, seen.motion, seen.by, seen.own);
    numbers_.push_back(seen.number);
    trust_.push_back(seen.trust);
    journal_.write(memory_, trust_);
    tellMemory();
    const std::lock_guard lock(mutex_);
    taken_ += item.drive == drive_;
    --state_.waiting;
}

// The drive that begins, or goes on.
void MapCorrector::remember(const Item &item) {
    journal_.finish(memory_, trust_);
    journal_.begin();
    remembered_ = item.drive;
    numbers_.clear();
    if (item.remembered) {
        memory_ = std::move(item.remembered->drive);
        trust_ = std::move(item.remembered->trust);
    } else {
        memory_ = vectorlib::MappedDrive();
        memory_.known = item.known;
        trust_.clear();
    }
    resumed_ = memory_.loops.scans();
    isFull_ = memory_.bytes() >= limit_;
    GraphMessage all = graph(0, 0);
    all.cleared = true;
    grown_(all);
    toldKeys_ = memory_.loops.graph().poses.size();
    toldConstraints_ = memory_.loops.graph().constraints.size();
    tellMemory();
}

void MapCorrector::tellMemory() {
    const std::lock_guard lock(mutex_);
    if (remembered_ != drive_)
        return; // another drive has begun
    state_.keys = memory_.loops.graph().poses.size();
    state_.loops = memory_.loops.counts();
    state_.isDue = state_.isUnderWay || memory_.loops.hasNews();
    state_.bytes = memory_.bytes();
}

void MapCorrector::tellUnderWay(bool isUnderWay) {
    {
        const std::lock_guard lock(mutex_);
        state_.isUnderWay = isUnderWay;
    }
    tellMemory();
}

void MapCorrector::correct() {
    const std::vector<vectorlib::Pose2D> before = memory_.loops.graph().poses;
    if (!memory_.loops.correct())
        return;
    journal_.corrected();
    toldKeys_ = toldConstraints_ = 0; // weights are others
    const auto c = std::make_shared<Correction>();
    double turned = 0;
    for (std::size_t k = 0; k < before.size(); ++k) {
        const vectorlib::Pose2D by = before[k].inverse() * memory_.loops.graph().poses[k];
        c->farthest = std::max(c->farthest, std::hypot(by.x, by.y));
        turned = std::max(turned, std::abs(by.theta));
    }
    if ((c->farthest < least_m && turned < least_rad) || isEnding())
        return tellGrown();
    memory_.rebuild(builder_);
    if (isEnding())
        return;
    memory_.review(builder_.map, memory_.loops.poses());
    const quint64 drive = remembered_;
    for (int round = 0; round < maxRounds; ++round) {
        if (state().waiting <= fewLeft)
            break;
        const std::size_t known = memory_.loops.scans();
        take();
        if (remembered_ != drive)
            return; // that drive is over
        memory_.extend(builder_, known);
    }
    handOver(c);
}

void MapCorrector::handOver(std::shared_ptr<Correction> c) {
    c->drive = remembered_;
    c->scans = memory_.loops.scans();
    c->last = memory_.loops.pose(c->scans - 1);
    builder_.map.takeChanges(); // all of it is new
    std::swap(c->map, builder_.map);
    builder_.clear();
    c->map.forEach([&](const vectorlib::MapEdge &e) { c->edges.emplace_hint(c->edges.end(), e.id, e); });
    c->numbers = numbers_;
    for (std::size_t i = resumed_; i < memory_.loops.scans(); ++i)
        c->poses.push_back(memory_.loops.pose(i));
    c->graph = graph(0, 0);
    toldKeys_ = c->graph.poses.size();
    toldConstraints_ = memory_.loops.graph().constraints.size();
    {
        const std::lock_guard lock(mutex_);
        if (ending_)
            return;
        isHandedOver_ = true;
    }
    corrected_(c);
    c.reset();
    std::unique_lock lock(mutex_);
    wake_.wait(lock, [this] { return ending_ || !isHandedOver_; });
}

void MapCorrector::tellGrown() {
    const vectorlib::PoseGraph &g = memory_.loops.graph();
    if (g.poses.size() == toldKeys_ && g.constraints.size() == toldConstraints_)
        return;
    grown_(graph(toldKeys_, toldConstraints_));
    toldKeys_ = g.poses.size();
    toldConstraints_ = g.constraints.size();
}

GraphMessage MapCorrector::graph(std::size_t first, std::size_t constraint) const {
    const vectorlib::PoseGraph &g = memory_.loops.graph();
    GraphMessage message;
    message.cleared = first == 0;
    message.first = qint64(first);
    message.size = qint64(g.poses.size());
    for (std::size_t k = first; k < g.poses.size(); ++k) {
        const vectorlib::Pose2D &p = g.poses[k];
        message.poses.push_back({p.x, p.y, p.theta});
        message.trust.push_back(trust_[memory_.loops.scanOf(k)]);
    }
    for (std::size_t i = constraint; i < g.constraints.size(); ++i) {
        const PoseConstraint &c = g.constraints[i];
        if (c.mayBeWrong)
            message.loops.push_back({qint64(c.from), qint64(c.to), c.weight});
    }
    return message;
}

} // namespace hermes::scanmatcher
