// Which daemon belongs to which robot.
#include "gui/desktop/model/Fleet.h"

#include <QHash>
#include <algorithm>

namespace hermes::desktop {
namespace {

constexpr std::ptrdiff_t maxAtHost = 300; // daemons, as far as supervisors name them
constexpr int maxConflicts = 5;           // that are told one by one

} // namespace

Robot *Fleet::setAt(const QString &host, const QString &address) {
    Robot *const robot = robotAt(address);
    return robot ? robot : makeRobot(host, address, nullptr);
}

void Fleet::place(DaemonLink *daemon, Robot *robot) {
    const QString host = daemon->host();
    QString address = robot ? robot->address() : QString();
    for (int number = 2; address.isEmpty(); ++number)
        if (const QString free = QString("%1#%2").arg(host).arg(number); !robotAt(free))
            address = free;
    if (address == host)
        places_.remove(daemon->address());
    else
        places_[daemon->address()] = address;
    distribute();
}

void Fleet::setPlaces(const QMap<QString, QString> &places) {
    for (auto one = places.begin(); one != places.end(); ++one) {
        const QString host = one.key().section(':', 0, -2), number = one.value().section('#', 1);
        if (number.toInt() > 1 && one.value() == QString("%1#%2").arg(host).arg(number.toInt()))
            places_[one.key()] = one.value();
    }
    distribute();
}

// Who has it keeps it for as long as it is named. As far as there are not too many: a supervisor may name
// what it likes.
void Fleet::findNamers() {
    for (auto &[place, entry] : entries_)
        entry.namedBy = entry.led;
    for (const auto &robot : robots_)
        for (const quint16 port : robot->named()) {
            const auto isThere = [&](const auto &entry) { return entry.first.first == robot->host(); };
            if (!entries_.count({robot->host(), port}) &&
                std::count_if(entries_.begin(), entries_.end(), isThere) >= maxAtHost)
                continue;
            Entry &entry = entryAt({robot->host(), port});
            if (!entry.led && (!entry.namedBy || entry.robot == robot.get()))
                entry.namedBy = robot.get();
        }
}

std::vector<Fleet::Move> Fleet::reassign() {
    std::vector<Move> moves;
    for (auto &[place, entry] : entries_) {
        Robot *to = entry.namedBy;
        Robot *const from = entry.robot;
        if (!to && entry.isOfHost()) {
            const QString address = places_.value(entry.link->address(), place.first);
            to = from && from->address() == address ? from : setAt(place.first, address);
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
    std::vector<std::unique_ptr<Robot>> gone;
    const auto isOver = [this](const std::unique_ptr<Robot> &robot) {
        const auto standsForIt = [&robot](const std::unique_ptr<Robot> &other) {
            return other && other->host() == robot->host() && !other->daemons().empty();
        };
        return !robot->isSupervised() && robot->daemons().empty() &&
               (robot->address() != robot->host() || !addresses_.contains(robot->host()) ||
                std::any_of(robots_.begin(), robots_.end(), standsForIt));
    };
    for (auto &robot : robots_)
        if (isOver(robot))
            gone.push_back(std::move(robot));
    robots_.erase(std::remove(robots_.begin(), robots_.end(), nullptr), robots_.end());
    return gone;
}

void Fleet::distribute(std::unique_ptr<Robot> removed) {
    findNamers();
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
    for (std::size_t i = 0; i < gone.size(); ++i)
        Q_EMIT robotGone(gone[i].get(), i < empty ? successorOf(*gone[i], moves) : nullptr);
    tellConflicts();
    for (const auto &robot : robots_)
        for (const Move &move : moves)
            if (robot.get() == move.from || robot.get() == move.to) {
                Q_EMIT robot->capabilitiesChanged();
                break;
            }
    if (gone.empty())
        return moves.empty() ? void() : touch();
    Q_EMIT changed(); // at once: nobody is to look at them any more
    for (auto &robot : gone)
        robot.release()->deleteLater();
}

void Fleet::tellConflicts() {
    std::map<const Robot *, QStringList> conflicts;
    for (const auto &robot : robots_)
        for (const quint16 port : robot->named()) {
            const auto entry = entries_.find({robot->host(), port});
            const Robot *const owner = entry == entries_.end() ? nullptr : entry->second.robot;
            if (owner && owner != robot.get())
                conflicts[robot.get()].append((entry->second.led
                                                   ? tr("Port %1 is that of the robot %2")
                                                   : tr("Port %1 stays with the robot %2, which "
                                                        "names it too"))
                                                  .arg(port)
                                                  .arg(titleOf(*owner)));
            else if (!owner)
                conflicts[robot.get()].append(tr("Port %1 is one too many of this host").arg(port));
        }
    QHash<QString, const Robot *> known;
    for (const auto &[place, entry] : entries_) {
        const QString identity = entry.link->identity();
        const Robot *const first = known.value(identity, entry.robot);
        if (identity.isEmpty() || !entry.robot)
            continue;
        known.insert(identity, first);
        const QString twin = tr("The same as the robot %1, by another address").arg(titleOf(*first));
        if (first != entry.robot && !conflicts[entry.robot].contains(twin))
            conflicts[entry.robot].append(twin);
    }
    for (const auto &robot : robots_) {
        QStringList &lines = conflicts[robot.get()];
        const auto daemons = robot->daemons();
        const auto drivable = std::count_if(daemons.begin(), daemons.end(), [](const DaemonLink *daemon) {
            return daemon->hasMethod("motor.drive");
        });
        if (drivable > 1)
            lines.prepend(
                tr("%1 of its daemons can be driven, of which one is: make them robots of their own")
                    .arg(drivable));
        const int more = lines.size() - maxConflicts;
        lines = lines.mid(0, maxConflicts);
        if (more > 0)
            lines.append(tr("and %1 more").arg(more));
        robot->setConflicts(lines);
    }
}

Result<QStringList> Fleet::remove(Robot *robot) {
    if (const QString why = objection_ ? objection_(*robot) : QString(); !why.isEmpty())
        return Error(ErrorCode::NotReady, why);
    const QStringList before = addresses_;
    forgetHost(robot->host());
    std::vector<std::unique_ptr<DaemonLink>> links;
    for (auto entry = entries_.begin(); entry != entries_.end();) {
        if (entry->second.robot != robot) {
            ++entry;
            continue;
        }
        addresses_.removeAll(entry->second.link->address());
        entry->second.link->disconnect(this);
        links.push_back(std::move(entry->second.link));
        entry = entries_.erase(entry);
    }
    QStringList back;
    if (robot->isSupervised())
        back.append(robot->address());
    for (const QString &address : before)
        if (!addresses_.contains(address) && !back.contains(address))
            back.append(address);
    const auto place =
        std::find_if(robots_.begin(), robots_.end(), [robot](const auto &one) { return one.get() == robot; });
    std::unique_ptr<Robot> removed = std::move(*place);
    robots_.erase(place);
    distribute(std::move(removed));
    for (auto &link : links)
        link.release()->deleteLater();
    changes_.start(); // told once more when they are gone
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
    for (const auto &robot : robots_)
        if (robot->host() == gone.host())
            return robot.get();
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
