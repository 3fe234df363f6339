#include "gui/desktop/model/Fleet.h"

#include "common/Project.h"
#include "common/interface/InterfaceUrl.h"
#include "gui/desktop/widgets/ForeignText.h"

#include <QHostAddress>
#include <QRegularExpression>
#include <QSet>
#include <algorithm>

namespace hermes::desktop {
namespace {

constexpr std::ptrdiff_t maxAtHost = 300; // daemons, as far as supervisors name them

} // namespace

Fleet::Fleet(QObject *parent)
    : QObject(parent) {
    changes_.setSingleShot(true);
    changes_.setInterval(10);
    connect(&changes_, &QTimer::timeout, this, [this] {
        tellConflicts();
        Q_EMIT changed();
    });
}

Fleet::~Fleet() = default;

Result<void> Fleet::add(const QString &address) {
    const bool hasPort = address.contains(':') && !address.endsWith(']');
    const auto url = InterfaceUrl::parse(hasPort ? address : address + ":1");
    if (!url)
        return url.error();
    if (url->scheme != "tcp" || url->host.isEmpty() || url->port == 0 || !url->path.isEmpty())
        return Error(ErrorCode::InvalidParams, tr("address \"%1\": expected a name or an address, as "
                                                  "192.168.1.20, or with a port, as 192.168.1.20:7450")
                                                   .arg(address));
    static const QRegularExpression numbers(R"(^(?:tcp://)?([0-9.]+)(?::|$))"),
        four(R"(^\d{1,3}(\.\d{1,3}){3}$)");
    if (const QString typed = numbers.match(address).captured(1);
        !typed.isEmpty() && (!four.match(typed).hasMatch() || QHostAddress(typed).isNull()))
        return Error(ErrorCode::InvalidParams,
                     tr("address \"%1\": expected four numbers from 0 to 255").arg(address));
    const QString name = url->host == "localhost" ? QString("127.0.0.1") : url->host;
    const QString host = name.contains(':') ? '[' + name + ']' : name;
    const QString known = hasPort ? QString("%1:%2").arg(host).arg(url->port) : host;
    if (addresses_.contains(known))
        return {};
    addresses_.append(known);
    if (!robot_ && preferred_.isEmpty())
        preferred_ = known;
    if (hasPort) {
        entryAt({host, url->port}).isAdded = true;
    } else {
        robotWith(host);
        for (const QString &daemon : daemonNames())
            entryAt({host, defaultPort(daemon)}).isSought = true;
    }
    distribute();
    return {};
}

Fleet::Entry &Fleet::entryAt(const Place &place) {
    Entry &entry = entries_[place];
    if (entry.link)
        return entry;
    entry.link = std::make_unique<DaemonLink>(QString("%1:%2").arg(place.first).arg(place.second));
    connect(entry.link.get(), &DaemonLink::ready, this,
            [this, link = entry.link.get()] { link->hasMethod("process.list") ? distribute() : touch(); });
    connect(entry.link.get(), &DaemonLink::changed, this, [this, place] { onChanged(place); });
    return entry;
}

void Fleet::onChanged(const Place &place) {
    const Entry &entry = entries_.at(place);
    if (entry.told != entry.tells() || (!entry.namedBy && entry.isShown() != bool(entry.robot)))
        distribute();
}

Robot *Fleet::robotWith(const QString &id) {
    if (Robot *const known = robotAt(id))
        return known;
    robots_.push_back(std::make_unique<Robot>(id));
    Robot *const robot = robots_.back().get();
    connect(robot, &Robot::changed, this, &Fleet::touch);
    connect(robot, &Robot::namedChanged, this, [this] { distribute(); });
    robot->setGivenName(names_.value(id));
    return robot;
}

DaemonLink *Fleet::daemonAt(const QString &address) const {
    if (address.isEmpty())
        return nullptr; // of which QString::section() would fail
    const auto entry = entries_.find({address.section(':', 0, -2), address.section(':', -1).toUShort()});
    return entry == entries_.end() ? nullptr : entry->second.link.get();
}

Robot *Fleet::robotOf(const DaemonLink *daemon) const {
    if (!daemon)
        return nullptr;
    const auto entry = entries_.find({daemon->host(), daemon->port()});
    return entry != entries_.end() && entry->second.link.get() == daemon ? entry->second.robot : nullptr;
}

Robot *Fleet::robotAt(const QString &address) const {
    for (const auto &robot : robots_)
        if (robot->id() == address)
            return robot.get();
    const DaemonLink *const daemon = daemonAt(address);
    return daemon && daemon->isKnown() ? robotOf(daemon) : nullptr;
}

QString Fleet::titleOf(const Robot &robot) const {
    if (namesakes_.isEmpty())
        for (const auto &other : robots_)
            ++namesakes_[other->name()];
    return namesakes_.value(robot.name()) > 1 ? tr("%1 (%2)").arg(robot.name(), robot.address())
                                              : robot.name();
}

QString Fleet::titleOf(const DaemonLink &daemon) const {
    const Robot *const robot = robotOf(&daemon);
    return robots_.size() > 1 && robot ? tr("%1 of %2").arg(daemon.name(), titleOf(*robot)) : daemon.name();
}

void Fleet::setNames(const QMap<QString, QString> &names) {
    names_ = names;
    for (const auto &robot : robots_)
        robot->setGivenName(names_.value(robot->id()));
}

void Fleet::rename(Robot &robot, const QString &name) {
    const QString given = shortLine(name.trimmed(), Robot::longestName);
    if (given.isEmpty())
        names_.remove(robot.id());
    else
        names_[robot.id()] = given;
    robot.setGivenName(given);
}

void Fleet::prefer(const QString &robot) {
    if (isMeant_ || robot.isEmpty())
        return;
    preferred_ = robot;
    distribute();
}

QString Fleet::preferred() const {
    return !preferred_.isEmpty() ? preferred_ : robot_ ? robot_->id() : QString();
}

void Fleet::choose(Robot *robot) {
    keepChoice();
    if (robot_ != robot)
        setChosen(robot, lastDaemonOf(robot));
}

void Fleet::choose(DaemonLink *daemon) {
    keepChoice();
    Robot *const robot = robotOf(daemon);
    setChosen(robot ? robot : robot_, daemon);
}

void Fleet::goAlong(Robot *robot) {
    if (preferred_.isEmpty())
        setChosen(robot, robotOf(daemon_) == robot ? daemon_.data() : lastDaemonOf(robot));
}

void Fleet::keepChoice() {
    isMeant_ = isMeant_ || robot_;
    if (isMeant_)
        preferred_.clear();
}

DaemonLink *Fleet::lastDaemonOf(const Robot *robot) const {
    const auto last = lastDaemons_.find(robot);
    return last != lastDaemons_.end() && robot && robot->has(last->second) ? last->second.data() : nullptr;
}

void Fleet::setChosen(Robot *robot, DaemonLink *daemon) {
    const bool isOther = std::exchange(robot_, robot) != robot;
    const bool isOtherDaemon = daemon_ != daemon;
    daemon_ = daemon;
    lastDaemons_[robot] = daemon;
    if (isOther)
        Q_EMIT robotChosen(robot);
    if (isOtherDaemon)
        Q_EMIT daemonChosen(daemon);
}

void Fleet::touch() {
    namesakes_.clear();
    if (!changes_.isActive())
        changes_.start();
}

// As far as there are not too many: a supervisor may name what it likes. Who has it keeps it for as long as
// it is named.
void Fleet::findNamed() {
    for (auto &[place, entry] : entries_)
        entry.namedBy = nullptr;
    for (const auto &robot : robots_)
        for (const Place &place : robot->named()) {
            const auto isThere = [&](const auto &entry) { return entry.first.first == place.first; };
            if (!entries_.count(place) &&
                std::count_if(entries_.begin(), entries_.end(), isThere) >= maxAtHost)
                continue;
            Entry &entry = entryAt(place);
            if (!entry.namedBy || entry.robot == robot.get())
                entry.namedBy = robot.get();
        }
}

std::vector<Fleet::Move> Fleet::reassign() {
    QHash<QString, QString> supervised; // the robots that have the supervisors of a host; empty: several
    for (auto &[place, entry] : entries_) {
        entry.told = entry.tells();
        const QString id = entry.told.value_or(QString());
        if (!id.isEmpty() && entry.link->hasMethod("process.list"))
            supervised[place.first] = supervised.value(place.first, id) == id ? id : QString();
    }
    std::vector<Move> moves;
    for (auto &[place, entry] : entries_) {
        Robot *to = nullptr;
        Robot *const from = entry.robot;
        QString id = entry.told.value_or(QString());
        if (id.isEmpty() && entry.namedBy) {
            to = entry.namedBy;
        } else if (entry.namedBy || entry.isShown()) {
            if (id.isEmpty() && entry.told)
                id = supervised.value(place.first);
            id = id.isEmpty() ? place.first : id;
            to = from && from->id() == id ? from : robotWith(id);
        }
        entry.robot = to;
        if (from == to)
            continue;
        DaemonLink *const daemon = entry.link.get();
        if (from)
            from->release(daemon);
        if (to)
            to->take(daemon);
        moves.push_back({daemon, from, to});
    }
    return moves;
}

// A host on which nothing was found is shown, unless another robot there stands for it.
std::vector<std::unique_ptr<Robot>> Fleet::takeEmpty() {
    QSet<QString> inhabited;
    for (const auto &[place, entry] : entries_)
        if (entry.robot)
            inhabited.insert(place.first);
    std::vector<std::unique_ptr<Robot>> gone;
    for (auto &robot : robots_)
        if (robot->daemons().empty() &&
            (inhabited.contains(robot->id()) || !addresses_.contains(robot->id())))
            gone.push_back(std::move(robot));
    robots_.erase(std::remove(robots_.begin(), robots_.end(), nullptr), robots_.end());
    return gone;
}

void Fleet::distribute(std::unique_ptr<Robot> removed) {
    findNamed();
    const std::vector<Move> moves = reassign();
    Robots gone = takeEmpty();
    namesakes_.clear();
    for (const auto &[daemon, from, to] : moves)
        if (from && to)
            Q_EMIT moved(daemon, from, to);
    const std::size_t empty = gone.size();
    if (removed)
        gone.push_back(std::move(removed));
    followChoice(moves, gone);
    if (!moves.empty())
        touch();
    for (std::size_t i = 0; i < gone.size(); ++i)
        Q_EMIT robotGone(gone[i].get(), i < empty ? successorOf(*gone[i], moves) : nullptr);
    for (const auto &robot : robots_)
        for (const Move &move : moves)
            if (robot.get() == move.from || robot.get() == move.to) {
                Q_EMIT robot->capabilitiesChanged();
                break;
            }
    if (gone.empty())
        return;
    Q_EMIT changed(); // at once: nobody is to look at them any more
    for (auto &robot : gone)
        robot.release()->deleteLater();
}

void Fleet::tellConflicts() {
    QHash<QString, const DaemonLink *> known; // processes
    for (const auto &robot : robots_) {
        QStringList lines;
        int drivable = 0;
        for (const DaemonLink *daemon : robot->daemons()) {
            const QString process = daemon->identity();
            const DaemonLink *const twin = process.isEmpty() ? nullptr : known.value(process);
            if (twin && lines.isEmpty()) // one stands for all
                lines.append(tr("%1 is the same as %2 of the robot %3, by another address")
                                 .arg(daemon->address(), twin->address(), titleOf(*robotOf(twin))));
            drivable += !twin && daemon->hasMethod("motor.drive");
            known.insert(process, twin ? twin : daemon);
        }
        const auto isMissing = [this](const Place &place) { return entries_.count(place) == 0; };
        if (const auto missing = std::count_if(robot->named().begin(), robot->named().end(), isMissing))
            lines.append(tr("%1 daemons are too many for one host").arg(missing));
        if (drivable > 1)
            lines.prepend(tr("%1 of its daemons can be driven, of which one is").arg(drivable));
        robot->setConflicts(lines);
    }
}

Result<QStringList> Fleet::remove(Robot *robot) {
    if (const QString why = objection_ ? objection_(*robot) : QString(); !why.isEmpty())
        return Error(ErrorCode::NotReady, why);
    QStringList back = addresses_;
    forgetHost(robot->id()); // where nothing was found
    for (const DaemonLink *daemon : robot->daemons())
        forgetHost(daemon->host());
    std::vector<std::unique_ptr<DaemonLink>> links;
    for (auto entry = entries_.begin(); entry != entries_.end();) {
        if (entry->second.robot != robot) {
            ++entry;
            continue;
        }
        DaemonLink *const link = entry->second.link.get();
        if (link->hasMethod("process.list") && !back.contains(link->address()))
            back.append(link->address());
        addresses_.removeAll(link->address());
        link->disconnect(this);
        links.push_back(std::move(entry->second.link));
        entry = entries_.erase(entry);
    }
    for (const QString &address : qAsConst(addresses_))
        back.removeAll(address);
    const auto place =
        std::find_if(robots_.begin(), robots_.end(), [robot](const auto &one) { return one.get() == robot; });
    std::unique_ptr<Robot> removed = std::move(*place);
    robots_.erase(place);
    distribute(std::move(removed));
    for (auto &link : links) {
        connect(link.get(), &QObject::destroyed, this, &Fleet::touch); // told once more when they are gone
        link.release()->deleteLater();
    }
    return back;
}

// What was found there and stays is known by its own address from now on.
void Fleet::forgetHost(const QString &host) {
    if (addresses_.removeAll(host) == 0)
        return;
    for (auto &[place, entry] : entries_) {
        if (place.first != host || !std::exchange(entry.isSought, false) || !entry.robot || entry.isAdded)
            continue;
        entry.isAdded = true;
        addresses_.append(entry.link->address());
    }
}

Robot *Fleet::successorOf(const Robot &gone, const std::vector<Move> &moves) const {
    for (const Move &move : moves)
        if (move.from == &gone && move.to)
            return move.to;
    for (const auto &[place, entry] : entries_)
        if (place.first == gone.id() && entry.robot)
            return entry.robot;
    return nullptr;
}

void Fleet::followChoice(const std::vector<Move> &moves, const Robots &gone) {
    Robot *next = robot_;
    for (const auto &robot : gone) {
        lastDaemons_.erase(robot.get());
        if (robot.get() == robot_)
            next = successorOf(*robot, moves);
    }
    if (Robot *const preferred = robotAt(preferred_)) {
        next = preferred;
        preferred_.clear();
    } else if (!isMeant_ && preferred_.isEmpty()) {
        for (const Move &move : moves)
            if (move.to && move.from == robot_)
                next = move.to;
    }
    if (!next && !robots_.empty())
        next = robots_.front().get();
    setChosen(next, next && next->has(daemon_) ? daemon_.data() : lastDaemonOf(next));
}

} // namespace hermes::desktop
