#include "common/daemon/Server.h"

#include "common/Log.h"
#include "common/Time.h"
#include "common/interface/Descriptors.h"
#include "common/interface/InterfaceRegistry.h"
#include "common/interface/OwnSocket.h"

#include <QStringList>
#include <algorithm>
#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

namespace hermes {
namespace {

const QString source = QStringLiteral("server");
constexpr double quiet_s = 1;     // after the last client has gone, before memory is given back
constexpr double unheard_s = 0.4; // after a client has said anything, the same
constexpr int look_ms = 250;      // at what clients take, and whether they are silent
constexpr int mappedBytes = 4 << 20, keptBytes = 16 << 20;

void addTo(QJsonObject &sums, const QString &key, quint64 count) {
    sums.insert(key, sums.value(key).toDouble() + double(count));
}

void addSession(QJsonObject &sums, Session &session) {
    const CodecCounters &codec = session.codecCounters();
    addTo(sums, "requests", session.counters().requests);
    addTo(sums, "error_replies", session.counters().errors);
    addTo(sums, "ignored_responses", session.counters().ignored);
    addTo(sums, "malformed_frames", codec.malformed);
    addTo(sums, "oversized_frames", codec.oversized);
    addTo(sums, "dropped_topic_messages", session.topics().dropped());
    const LinkCounters link = session.linkCounters();
    addTo(sums, "line_frames_in", link.framesIn);
    addTo(sums, "line_frames_out", link.framesOut);
    addTo(sums, "line_damaged_frames", link.damaged);
    addTo(sums, "line_repeated_requests", session.repeatedRequests());
    addTo(sums, "line_repeated_pieces", link.repeatedPieces);
    addTo(sums, "line_abandoned_messages", link.abandoned);
}

/// In a virtual machine it may take 10 µs to get 4 kB from the system. Large replies would get and give back
/// theirs each time; Server::giveMemoryBack() does that once.
void keepMemory() {
    ::mallopt(M_MMAP_THRESHOLD, mappedBytes);
    ::mallopt(M_TRIM_THRESHOLD, keptBytes);
}

/// That all clients together may take.
qint64 memoryOfClients() {
    rlimit room{RLIM_INFINITY, RLIM_INFINITY};
    ::getrlimit(RLIMIT_AS, &room);
    const rlim_t there = rlim_t(::sysconf(_SC_PHYS_PAGES)) * rlim_t(::sysconf(_SC_PAGESIZE));
    return qint64(std::min(there, room.rlim_cur) / 8);
}

QString howToGetMore(const Peer &peer) {
    if (peer.certificate)
        return QString("the certificate of \"%1\" says so, hermesctl keys issue makes another one")
            .arg(peer.certificate->name);
    if (peer.place == Peer::Place::Elsewhere)
        return "the setting access.plain says what clients without a certificate may do";
    if (roleOf(peer, {Role::Observer, Role::Engineer}) == Role::Engineer)
        return "the setting access.others, which the daemon's own user may change, says what "
               "other users of this computer may do";
    return "over its Unix socket, which hermesctl, the window and docs/examples/hermes.py use, the daemon's "
           "own "
           "user has all rights; the setting access.plain says which over TCP";
}

} // namespace

Server::Server(const CommandRegistry &registry, TopicHub &hub, QObject *parent)
    : QObject(parent)
    , commands_(registry)
    , topics_(hub)
    , gapWatch_(this)
    , audit_(this) {
    keepMemory();
    connect(&gapWatch_, &GapWatch::looked, this, [this] {
        for (Session *session : qAsConst(sessions_))
            session->becomeFresh();
    });
    idleTimer_.setInterval(look_ms);
    connect(&idleTimer_, &QTimer::timeout, this, [this] {
        const auto all = sessions_.values();
        for (Session *session : all)
            session->checkIdle();
        saveMemory();
        giveMemoryBack();
    });
    idleTimer_.start();
}

void Server::setLimits(const SessionLimits &session, int clients) {
    limits_ = session;
    clientLimit_ = clients;
    idleTimer_.setInterval(limits_.idle_s > 0 && limits_.idle_s < 1 ? int(limits_.idle_s * 250) + 1
                                                                    : look_ms);
    raiseDescriptorLimit(clients);
}

Result<void> Server::listen(const QString &text, bool insecure) {
    const auto url = InterfaceUrl::parse(text);
    if (!url)
        return url.error();
    if (!makeCodec(url->protocol())) {
        return Error(ErrorCode::InvalidSetting,
                     QString("cannot listen on %1: unknown protocol \"%2\", known are: %3")
                         .arg(text, url->protocol(), codecNames().join(", ")));
    }
    if (isOpenToNetwork(*url) && !insecure) {
        return Error(
            ErrorCode::NotAuthorised,
            QString("will not listen on %1: others on the network could command this daemon in plain "
                    "text. Listen on 127.0.0.1, or with certificates (tls://HOST:PORT, hermesctl "
                    "keys), or accept that with \"insecure\": true in the settings "
                    "(--set insecure=true)")
                .arg(text));
    }
    // The one beside it first: who comes as soon as this one listens finds it.
    auto own = listenForOwn(*url);
    const auto listener = begin(*url);
    if (!listener) {
        delete (own ? *own : nullptr);
        return listener.error();
    }
    const auto actual = InterfaceUrl::parse((*listener)->address());
    if (url->port == 0 && actual)
        own = listenForOwn({actual->scheme, actual->host, actual->port, actual->path, url->options});
    listeners_.append(*listener);
    if (!own)
        logWarning(source, QString("%1; hermesctl and the window connect over TCP instead, as %2")
                               .arg(own.error().message, toString(access_.plain)));
    else if (*own)
        ownListeners_.append(*own);
    logInfo(source, QString("listening on %1, protocol %2").arg((*listener)->address(), url->protocol()));
    return {};
}

Result<Listener *> Server::begin(const InterfaceUrl &url) {
    const auto listener = makeListener(url, this);
    if (!listener)
        return listener;
    connect(*listener, &Listener::accepted, this,
            [this, protocol = url.protocol()](Interface *peer) { accept(peer, protocol); });
    const auto listening = (*listener)->listen();
    if (listening)
        return listener;
    delete *listener;
    return listening.error();
}

Result<Listener *> Server::listenForOwn(const InterfaceUrl &tcp) {
    const auto own = ownSocketOf(tcp);
    return own ? begin(*own) : Result<Listener *>(nullptr);
}

void Server::setAccess(const Access &access) {
    access_ = access;
    for (Session *session : qAsConst(sessions_))
        giveRole(session);
}

void Server::giveRole(Session *session) const {
    session->setRole(roleOf(session->peer(), access_), howToGetMore(session->peer()));
}

void Server::close() {
    for (Listener *listener : listeners_ + ownListeners_)
        listener->close();
    const auto all = sessions_.values();
    for (Session *session : all)
        session->close("the daemon is stopping");
}

QStringList Server::addresses() const {
    QStringList result;
    for (const Listener *listener : listeners_)
        result.append(listener->address());
    return result;
}

QStringList Server::failures() const {
    QStringList result;
    for (const Listener *listener : listeners_)
        if (!listener->failure().isEmpty())
            result.append(listener->failure());
    return result;
}

QJsonObject Server::counters() const {
    QJsonObject sums = past_;
    for (Session *session : sessions_)
        addSession(sums, *session);
    sums.insert("clients", sessions_.size());
    sums.insert("clients_in_all", double(lastId_));
    sums.insert("clients_in_kept_places", restricted().size());
    sums.insert("clients_turned_away", double(turnedAway_));
    return sums;
}

void Server::accept(Interface *peer, const QString &protocol) {
    auto *channel = new Channel(peer, makeCodec(protocol), this);
    if (peer->isConnection()) // else what one stranger says would end it for all
        channel->codec().watchForStrangers();
    auto *session = new Session(++lastId_, channel, commands_, limits_, gapWatch_, audit_, this);
    giveRole(session);
    if (!mayStay(session)) {
        turnAway(session, {ErrorCode::OverLimit, session->restriction()});
        return session->deleteLater();
    }
    sessions_.insert(session->id(), session);
    connect(session, &Session::foreign, this,
            [this, session](const RpcError &error) { turnAway(session, error); });
    connect(session, &Session::closed, this,
            [this, session](const QString &reason) { remove(session, reason); });
}

bool Server::mayStay(Session *session) {
    const int most = maxPlaces();
    if (places() < most)
        return true;
    session->restrictTo(
        QString("%1 clients are connected already (%2)")
            .arg(places())
            .arg(most < clientLimit_ ? "there are no more file descriptors" : "limits.clients"));
    return makeKeptPlace();
}

// The system may give fewer descriptors than the clients need: those of the kept places are not given away.
int Server::maxPlaces() const {
    const int others = sessions_.size() + descriptorsLeft() - spareDescriptors;
    const int kept = commands_.urgent().isEmpty() ? 0 : std::min(keptPlaces, others / 2);
    return std::clamp(others - kept, 1, clientLimit_);
}

// All clients together take an eighth of the memory at most: who takes most of it goes.
void Server::saveMemory() {
    const auto held = [](const Session *session) { return session->heldBytes(); };
    qint64 all = 0;
    for (const Session *session : qAsConst(sessions_))
        all += held(session);
    while (all > memoryOfClients() && !sessions_.isEmpty()) {
        Session *const largest = *std::max_element(sessions_.begin(), sessions_.end(),
                                                   [&](auto *a, auto *b) { return held(a) < held(b); });
        all -= held(largest);
        largest->expel(QString("%1 MiB wait for or from this client, and all clients together may take "
                               "%2 MiB of this computer's memory")
                           .arg(held(largest) >> 20)
                           .arg(memoryOfClients() >> 20));
        if (sessions_.contains(largest->id()))
            return; // it ends with the batch that is being carried out
    }
}

// A stop has to find a place however many take one and are silent: whoever was silent for the longest time
// goes.
bool Server::makeKeptPlace() {
    if (commands_.urgent().isEmpty())
        return false;
    const QVector<Session *> all = restricted();
    if (all.isEmpty() || (all.size() < keptPlaces && descriptorsLeft() > spareDescriptors))
        return true;
    Session *const longest = *std::min_element(all.begin(), all.end(), [](Session *a, Session *b) {
        return a->lastSignOfLife() < b->lastSignOfLife();
    });
    turnAway(longest,
             {ErrorCode::OverLimit, longest->restriction() + "; its place is given to another client now"});
    return true;
}

void Server::turnAway(Session *session, const RpcError &reason) {
    ++turnedAway_;
    // Many may come; a record of each would bury all others.
    if (const double now = monotonicNow(); now - turnAwayTold_ > 1) {
        turnAwayTold_ = now;
        logWarning(
            source,
            QString("%1 turned away: %2; %3 in all").arg(session->name(), reason.message).arg(turnedAway_));
    }
    session->refuse(reason);
    session->close(reason.message);
}

QVector<Session *> Server::restricted() const {
    QVector<Session *> result;
    std::copy_if(sessions_.begin(), sessions_.end(), std::back_inserter(result),
                 [](Session *session) { return session->isRestricted(); });
    return result;
}

// The first who came to a kept place gets one that has become free.
void Server::givePlaces() {
    for (Session *session : restricted())
        if (places() < maxPlaces())
            session->restrictTo(QString());
}

// What a crowd of clients needed lies free between what is in use, and stays with the process else. This
// takes about 0.1 ms for a megabyte, in a virtual machine ten times as long: it is done in a pause of whoever
// drives.
void Server::giveMemoryBack() {
    const double now = monotonicNow();
    const auto speaks = [now](const Session *session) { return now - session->lastHeard() < unheard_s; };
    if (giveBackFrom_ == 0 || now < giveBackFrom_ || std::any_of(sessions_.begin(), sessions_.end(), speaks))
        return;
    giveBackFrom_ = 0;
    ::malloc_trim(0);
}

void Server::remove(Session *session, const QString &reason) {
    if (sessions_.remove(session->id()) == 0)
        return;
    logDebug(source, QString("client %1 gone: %2").arg(session->name(), reason));
    addSession(past_, *session);
    topics_.forget(&session->topics());
    session->deleteLater();
    giveBackFrom_ = monotonicNow() + quiet_s;
    givePlaces();
    Q_EMIT clientGone(session->id());
}

} // namespace hermes
