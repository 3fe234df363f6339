#include "daemons/ros2/Bridge.h"

#include "common/Log.h"
#include "common/Time.h"
#include "protocol/ros/Messages.h"

#include <algorithm>

namespace hermes::ros2 {
namespace {

constexpr std::chrono::milliseconds period{1000}; // of refreshing
constexpr int maxOutlets = 200;
constexpr double matcherWait_s = 3;

bool hasTopic(const RobotDaemons::Daemon &daemon, const QString &name) {
    return std::any_of(daemon.topics.begin(), daemon.topics.end(),
                       [&](const TopicDescription &topic) { return topic.name == name; });
}

} // namespace

Result<std::unique_ptr<Bridge>> Bridge::open(const Options &options, RobotDaemons &daemons) {
    auto participant = Participant::open(options.network);
    if (!participant)
        return participant.error();
    return std::unique_ptr<Bridge>(new Bridge(options, daemons, participant.take()));
}

Bridge::Bridge(const Options &options, RobotDaemons &daemons, std::unique_ptr<Participant> participant)
    : options_(options)
    , daemons_(daemons)
    , participant_(std::move(participant))
    , graph_(*participant_, options.graph, options.space.isEmpty() ? "/" : options.space, "hermes")
    , robot_(options.framePrefix) {
    connect(&daemons, &RobotDaemons::came, this, &Bridge::greet);
    connect(&daemons, &RobotDaemons::went, this, &Bridge::lose);
    connect(&second_, &QTimer::timeout, this, &Bridge::refresh);
    second_.start(period);
    if (options.tellsReplays)
        if (auto clock = participant_->write("rt/clock", ros::typeOf<ros::Clock>(), {false, false, 1}))
            clock_ = clock.take();
    for (const ros::Mapping &mapping : ros::mappings())
        if (!mapping.isOfEach)
            outletFor(mapping, {});
    for (const auto &[address, daemon] : daemons.all())
        if (daemon->isKnown)
            greet(daemon.get());
}

Bridge::~Bridge() {
    for (const auto &[daemon, handle] : settings_)
        daemon->client->unsubscribe(handle);
    for (const Feed &feed : feeds_)
        if (feed.handle != 0)
            feed.daemon->client->unsubscribe(feed.handle);
}

/// ROS has one log and one topic of diagnostics, and one of frames where their names tell the robots apart.
QString Bridge::ddsTopic(const QString &name) const {
    const bool isOfAll = name == "rosout" || name == "diagnostics" ||
                         (name.startsWith("tf") && !options_.framePrefix.isEmpty());
    return (isOfAll ? QString("rt/") : "rt" + options_.space + '/') + name;
}

void Bridge::addEndpoints(const std::vector<Guid> &readers, const std::vector<Guid> &writers) {
    readers_.insert(readers_.end(), readers.begin(), readers.end());
    writers_.insert(writers_.end(), writers.begin(), writers.end());
    tellGraph();
}

void Bridge::greet(RobotDaemons::Daemon *daemon) {
    if (hasTopic(*daemon, "scan2d"))
        robot_.addScanner(daemon->name, daemon->address);
    if (settings_.count(daemon) == 0 && hasTopic(*daemon, "settings"))
        settings_[daemon] =
            daemon->client->subscribe("settings", {}, [this, daemon](const TopicUpdate &update) {
                robot_.takeSettings(daemon->name, update.json().toObject());
                receive();
            });
    newcomers_.push_back({daemon, monotonicNow()});
    receive();
}

/// Of several scanners the one that is matched has the plain names, whoever came first: the matcher is waited
/// for, a little while.
void Bridge::receive() {
    std::stable_partition(newcomers_.begin(), newcomers_.end(), [this](const Newcomer &one) {
        return robot_.isMatched(one.daemon->name).value_or(false);
    });
    const bool hasScan = std::any_of(outlets_.begin(), outlets_.end(),
                                     [](const Outlet &outlet) { return outlet.name == "scan"; });
    for (auto one = newcomers_.begin(); one != newcomers_.end();) {
        const bool isMatched = robot_.isMatched(one->daemon->name).value_or(false);
        const bool mustWait = hasTopic(*one->daemon, "scan2d") && !isMatched && !hasScan &&
                              monotonicNow() - one->since < matcherWait_s;
        if (!mustWait)
            attach(one->daemon);
        one = mustWait ? one + 1 : newcomers_.erase(one);
    }
}

void Bridge::attach(RobotDaemons::Daemon *daemon) {
    for (const ros::Mapping &mapping : ros::mappings())
        for (const QString &topic : mapping.topics)
            if (hasTopic(*daemon, topic))
                if (Outlet *const outlet = outletFor(mapping, mapping.isOfEach ? daemon->name : QString())) {
                    Feed &feed = feedOf(daemon, topic);
                    if (std::find(feed.outlets.begin(), feed.outlets.end(), outlet) == feed.outlets.end())
                        feed.outlets.push_back(outlet);
                }
    for (Feed &feed : feeds_)
        subscribeAsWanted(feed);
}

/// Its subscriptions stand: the client makes them again when it comes back.
void Bridge::lose(RobotDaemons::Daemon *daemon) {
    for (const Feed &feed : feeds_)
        if (feed.daemon == daemon)
            for (Outlet *const outlet : feed.outlets)
                outlet->translator->lose(daemon->name);
}

Bridge::Feed &Bridge::feedOf(RobotDaemons::Daemon *daemon, const QString &topic) {
    for (Feed &feed : feeds_)
        if (feed.daemon == daemon && feed.topic == topic)
            return feed;
    return feeds_.emplace_back(Feed{daemon, topic, {}, 0, 0});
}

Bridge::Outlet *Bridge::outletFor(const ros::Mapping &mapping, const QString &daemon) {
    for (Outlet &outlet : outlets_)
        if (outlet.mapping == &mapping && outlet.daemon == daemon)
            return &outlet;
    if (outlets_.size() >= maxOutlets)
        return nullptr;
    const bool isFirst = std::none_of(outlets_.begin(), outlets_.end(),
                                      [&](const Outlet &one) { return one.name == mapping.rosTopic; });
    const QString name = mapping.nameOf(daemon, isFirst || daemon.isEmpty());
    outlets_.push_back({&mapping, name, daemon, nullptr, mapping.make(), {}});
    Outlet &outlet = outlets_.back();
    auto writer =
        participant_->write(ddsTopic(name), mapping.type, mapping.quality, "typehash=" + mapping.hash + ';',
                            [this, &outlet] { readersChanged(outlet); });
    if (!writer) {
        logError("ros", writer.error().message);
        outlets_.pop_back();
        return nullptr;
    }
    outlet.writer = writer.take();
    tellGraph();
    return &outlet;
}

/// Somebody new may be a reader that gets nothing of what was written before: as RViz is for maps.
void Bridge::readersChanged(Outlet &outlet) {
    if (!outlet.writer)
        return;
    for (Feed &feed : feeds_)
        subscribeAsWanted(feed);
    if (!outlet.last.empty() && outlet.writer->readers() > 0)
        outlet.writer->write(outlet.last);
}

void Bridge::subscribeAsWanted(Feed &feed) {
    const bool isWanted = std::any_of(feed.outlets.begin(), feed.outlets.end(), [](const Outlet *outlet) {
        return outlet->mapping->quality.isLatched || outlet->writer->readers() > 0;
    });
    if (isWanted && feed.handle == 0) {
        feed.dropped = 0;
        feed.handle = feed.daemon->client->subscribe(
            feed.topic, {}, [this, &feed](const TopicUpdate &update) { take(feed, update); });
    } else if (!isWanted && feed.handle != 0) {
        feed.daemon->client->unsubscribe(std::exchange(feed.handle, 0));
    }
}

void Bridge::take(Feed &feed, const TopicUpdate &update) {
    const bool isReplayed =
        update.replayed || update.data["replayed"].boolean(); // by who replays it, or has it
    if (isReplayed != options_.tellsReplays) {                // what was is never mixed with what is
        ++counts_.leftOut;
        return;
    }
    if (clock_)
        tellTime(update.stamp);
    counts_.dropped += update.dropped - std::min(update.dropped, feed.dropped);
    feed.dropped = update.dropped;
    const ros::Told told{feed.daemon->name, update.stamp, robot_};
    for (Outlet *const outlet : feed.outlets) {
        if (!outlet->mapping->quality.isLatched && outlet->writer->readers() == 0)
            continue;
        QString problem;
        if (outlet->translator->take(update, told, cdr_, problem))
            write(*outlet);
        if (!problem.isEmpty()) {
            ++counts_.unreadable;
            counts_.lastProblem = feed.daemon->name + '/' + update.topic + ": " + problem;
        }
    }
}

/// Of what is replayed: nodes with use_sim_time live by it. It goes back when the replay does.
void Bridge::tellTime(double stamp) {
    constexpr double step_s = 0.01, late_s = 0.5; // topics come a little out of order
    if (stamp < toldTime_ + step_s && stamp > toldTime_ - late_s)
        return;
    toldTime_ = stamp;
    clock_->write(ros::toCdr(ros::Clock{ros::toTime(stamp)}));
}

void Bridge::write(Outlet &outlet) {
    outlet.writer->write(cdr_);
    ++counts_.written;
    if (outlet.mapping->quality.isLatched && outlet.mapping->quality.depth == 1)
        outlet.last = cdr_;
}

void Bridge::refresh() {
    receive();
    for (Outlet &outlet : outlets_)
        if (outlet.translator->refresh(robot_, stampNow(), cdr_))
            write(outlet);
}

void Bridge::tellGraph() {
    std::vector<Guid> writers = writers_;
    if (clock_)
        writers.push_back(clock_->guid());
    for (const Outlet &outlet : outlets_)
        if (outlet.writer)
            writers.push_back(outlet.writer->guid());
    graph_.setEndpoints(readers_, writers);
}

std::string Bridge::latched(const QString &topic) const {
    for (const Outlet &outlet : outlets_)
        if (outlet.name == topic)
            return outlet.last;
    return {};
}

Bridge::Counts Bridge::counts() const {
    Counts counts = counts_;
    for (const Outlet &outlet : outlets_) {
        ++counts.topics;
        counts.read += outlet.writer->readers() > 0;
    }
    return counts;
}

} // namespace hermes::ros2
