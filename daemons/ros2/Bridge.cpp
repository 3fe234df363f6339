#include "daemons/ros2/Bridge.h"

#include "common/Log.h"

#include <QCryptographicHash>
#include <QRegularExpression>
#include <QUrl>
#include <algorithm>

namespace hermes::ros2 {
namespace {

constexpr std::chrono::milliseconds period{1000}; // of refreshing
constexpr int maxOutlets = 200;

/// What ROS takes for a name: letters, digits and underscores, no digit first.
QString rosName(const QString &name) {
    QString made = name;
    made.replace(QRegularExpression("[^A-Za-z0-9_]"), "_");
    return made.isEmpty() || made[0].isDigit() ? '_' + made : made;
}

bool hasTopic(const RobotDaemons::Daemon &daemon, const QString &name) {
    return std::any_of(daemon.topics.begin(), daemon.topics.end(),
                       [&](const TopicDescription &topic) { return topic.name == name; });
}

QByteArray hashOf(const Mapping &mapping) {
    return "RIHS01_" +
           QCryptographicHash::hash(QByteArray::fromStdString(mapping.hashedText), QCryptographicHash::Sha256)
               .toHex();
}

int portOf(const RobotDaemons::Daemon &daemon) {
    return QUrl(daemon.address.contains("//") ? daemon.address : "tcp://" + daemon.address).port(0);
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
    for (const Mapping &mapping : mappings())
        if (!mapping.isOfEach)
            outletFor(mapping, {});
    for (const auto &[address, daemon] : daemons.all())
        if (daemon->isKnown)
            greet(daemon.get());
}

Bridge::~Bridge() {
    for (const auto &[daemon, handle] : settings_)
        daemon->client->unsubscribe(handle);
    for (const Outlet &outlet : outlets_)
        for (const Outlet::Source &source : outlet.sources)
            if (source.handle != 0)
                source.daemon->client->unsubscribe(source.handle);
}

QString Bridge::ddsTopic(const QString &name) const {
    return "rt" + options_.space + '/' + name;
}

void Bridge::addReader(const Guid &reader) {
    readers_.push_back(reader);
    tellGraph();
}

void Bridge::greet(RobotDaemons::Daemon *daemon) {
    if (hasTopic(*daemon, "scan2d"))
        robot_.addScanner(daemon->name, portOf(*daemon));
    if (settings_.count(daemon) == 0 && hasTopic(*daemon, "settings"))
        settings_[daemon] =
            daemon->client->subscribe("settings", {}, [this, daemon](const TopicUpdate &update) {
                robot_.takeSettings(daemon->name, update.json().toObject());
            });
    for (const Mapping &mapping : mappings())
        follow(mapping, daemon);
}

/// Its subscriptions stand: the client makes them again when it comes back.
void Bridge::lose(RobotDaemons::Daemon *daemon) {
    for (Outlet &outlet : outlets_)
        for (const Outlet::Source &source : outlet.sources)
            if (source.daemon == daemon)
                outlet.translator->lose(daemon->name);
}

void Bridge::follow(const Mapping &mapping, RobotDaemons::Daemon *daemon) {
    for (const QString &topic : mapping.topics) {
        if (!hasTopic(*daemon, topic))
            continue;
        Outlet *const outlet = outletFor(mapping, mapping.isOfEach ? daemon->name : QString());
        if (!outlet)
            return;
        const auto isThis = [&](const Outlet::Source &one) {
            return one.daemon == daemon && one.topic == topic;
        };
        if (std::any_of(outlet->sources.begin(), outlet->sources.end(), isThis))
            continue;
        outlet->sources.push_back({daemon, topic, 0, 0});
        readersChanged(*outlet);
    }
}

/// The first daemon that has it is known by the plain name, as long as this program runs.
QString Bridge::nameFor(const Mapping &mapping, const QString &daemon) const {
    const auto isTaken = [&](const Outlet &one) {
        return one.name == mapping.rosTopic && !one.daemon.isEmpty();
    };
    return std::any_of(outlets_.begin(), outlets_.end(), isTaken) ? rosName(daemon) + '/' + mapping.rosTopic
                                                                  : mapping.rosTopic;
}

Bridge::Outlet *Bridge::outletFor(const Mapping &mapping, const QString &daemon) {
    for (Outlet &outlet : outlets_)
        if (outlet.mapping == &mapping && outlet.daemon == daemon)
            return &outlet;
    if (outlets_.size() >= maxOutlets)
        return nullptr;
    const QString name = nameFor(mapping, daemon);
    outlets_.push_back({&mapping, name, daemon, nullptr, mapping.make(), {}, {}});
    Outlet &outlet = outlets_.back();
    auto writer = participant_->write(ddsTopic(name), mapping.type, mapping.quality, hashOf(mapping),
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
    const bool isWanted = outlet.mapping->quality.isLatched || outlet.writer->readers() > 0;
    for (Outlet::Source &source : outlet.sources) {
        if (isWanted && source.handle == 0) {
            subscribe(outlet, source);
        } else if (!isWanted && source.handle != 0) {
            source.daemon->client->unsubscribe(source.handle);
            source.handle = 0;
        }
    }
    if (outlet.mapping->quality.isLatched && !outlet.last.empty() && outlet.writer->readers() > 0)
        outlet.writer->write(outlet.last);
}

void Bridge::subscribe(Outlet &outlet, Outlet::Source &source) {
    source.dropped = 0;
    source.handle = source.daemon->client->subscribe(
        source.topic, {},
        [this, &outlet, &source](const TopicUpdate &update) { take(outlet, source, update); });
}

void Bridge::take(Outlet &outlet, Outlet::Source &source, const TopicUpdate &update) {
    if (update.replayed) { // it says nothing of the robot of now
        ++counts_.replayed;
        return;
    }
    counts_.dropped += update.dropped - std::min(update.dropped, source.dropped);
    source.dropped = update.dropped;
    QString problem;
    if (outlet.translator->take(update, {source.daemon->name, update.stamp, robot_}, cdr_, problem))
        write(outlet);
    if (problem.isEmpty())
        return;
    ++counts_.unreadable;
    counts_.lastProblem = source.daemon->name + '/' + update.topic + ": " + problem;
}

void Bridge::write(Outlet &outlet) {
    outlet.writer->write(cdr_);
    ++counts_.written;
    if (outlet.mapping->quality.isLatched)
        outlet.last = cdr_;
}

void Bridge::refresh() {
    for (Outlet &outlet : outlets_)
        if (outlet.translator->refresh(robot_, cdr_))
            write(outlet);
}

void Bridge::tellGraph() {
    std::vector<Guid> writers;
    for (const Outlet &outlet : outlets_)
        if (outlet.writer)
            writers.push_back(outlet.writer->guid());
    graph_.setEndpoints(readers_, writers);
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
