#include "gui/desktop/model/Events.h"

#include "common/Time.h"

#include <QStringList>
#include <algorithm>
#include <tuple>

namespace hermes::desktop {
namespace {

constexpr std::size_t lookBack = 50; // for an event that is alike

} // namespace

void Events::happened(Event::Level level, const QString &from, const QString &text, bool isSeen) {
    if (Event *const before = alike(level, from, text))
        return comeAgain(*before, isSeen);
    happenedBefore(level, from, text, stampNow(), isSeen);
}

void Events::happenedBefore(Event::Level level, const QString &from, const QString &text, double stamp,
                            bool isSeen) {
    Event &event = add(level, from, text, stamp);
    event.isAcknowledged = isSeen || level == Event::Level::Info;
    event.over = monotonicNow();
    tell(event);
}

void Events::goesOn(const QString &key, Event::Level level, const QString &from, const QString &text,
                    bool isSeen) {
    const auto known = open_.find(key);
    Event *event = known == open_.end() ? nullptr : find(known->second);
    const bool isAnother = level == Event::Level::Error && event && event->text != text;
    if (event && event->isOver && (isAnother || monotonicNow() - event->over > sameWithin_s))
        event = nullptr;
    if (!event) {
        event = &add(level, from, text, stampNow());
        event->isOver = false;
        event->isAcknowledged = isSeen;
        event->key = key;
        open_[key] = event->id;
        return tell(*event);
    }
    const bool isWorse = level > event->level, wasOver = event->isOver;
    if (!isWorse && !wasOver && event->level == level && event->text == text)
        return;
    event->isOver = false;
    event->level = level;
    event->text = text;
    if (!isWorse && !wasOver)
        return Q_EMIT changed();
    comeAgain(*event, isSeen);
}

void Events::ends(const QString &key) {
    const auto known = open_.find(key);
    if (known == open_.end())
        return;
    Event *const event = find(known->second);
    if (!event || event->isOver)
        return;
    event->isOver = true;
    event->over = monotonicNow();
    Q_EMIT changed();
}

void Events::endAll(const QString &prefix) {
    QStringList keys;
    for (auto one = open_.lower_bound(prefix); one != open_.end() && one->first.startsWith(prefix); ++one)
        keys.append(one->first);
    for (const QString &key : qAsConst(keys))
        ends(key);
}

void Events::rename(const QString &from, const QString &to) {
    for (Event &event : events_)
        if (event.from == from)
            event.from = to;
    Q_EMIT changed();
}

void Events::acknowledge(quint64 id) {
    Event *const event = find(id);
    if (!event || event->isAcknowledged)
        return;
    event->isAcknowledged = true;
    Q_EMIT changed();
}

void Events::acknowledgeAll() {
    for (Event &event : events_)
        event.isAcknowledged = true;
    Q_EMIT changed();
}

bool Events::isWaiting(const Event &event) {
    return !event.isAcknowledged && (event.level == Event::Level::Error || !event.isOver ||
                                     monotonicNow() - event.over < warningStays_s);
}

const Event *Events::loudest() const {
    const Event *found = nullptr;
    const auto rank = [](const Event &event) {
        const bool isPast =
            event.isOver && (!event.key.isEmpty() || monotonicNow() - event.over > sameWithin_s);
        return std::tuple(!isPast, event.level, event.began); // what is so now hides behind nothing
    };
    for (const Event &event : events_)
        if (isWaiting(event) && (!found || rank(event) >= rank(*found)))
            found = &event;
    return found;
}

int Events::waiting() const {
    return int(std::count_if(events_.begin(), events_.end(), isWaiting));
}

Event *Events::find(quint64 id) {
    const auto found = std::lower_bound(events_.begin(), events_.end(), id,
                                        [](const Event &event, quint64 wanted) { return event.id < wanted; });
    return found == events_.end() || found->id != id ? nullptr : &*found;
}

Event *Events::alike(Event::Level level, const QString &from, const QString &text) {
    const auto oldest = events_.rbegin() + std::ptrdiff_t(std::min(lookBack, events_.size()));
    const auto found = std::find_if(events_.rbegin(), oldest, [&](const Event &event) {
        return event.isOver && event.level == level && event.from == from && event.text == text &&
               monotonicNow() - event.over < sameWithin_s;
    });
    return found == oldest ? nullptr : &*found;
}

Event &Events::add(Event::Level level, const QString &from, const QString &text, double stamp) {
    makeRoom();
    Event event;
    event.id = ++last_;
    event.level = level;
    event.stamp = stamp;
    event.began = monotonicNow();
    event.from = from;
    event.text = text;
    events_.push_back(event);
    return events_.back();
}

// However much is told, an error that nobody has seen is the last to go.
void Events::makeRoom() {
    if (events_.size() < most)
        return;
    const auto isSpent = [](const Event &event) { return !isWaiting(event); };
    const auto isNoError = [](const Event &event) { return event.level != Event::Level::Error; };
    auto goes = std::find_if(events_.begin(), events_.end(), isSpent);
    if (goes == events_.end())
        goes = std::find_if(events_.begin(), events_.end(), isNoError);
    if (goes == events_.end())
        goes = events_.begin();
    if (const auto known = open_.find(goes->key); known != open_.end() && known->second == goes->id)
        open_.erase(known);
    events_.erase(goes);
    ++forgotten_;
}

// An error that comes again was not seen; of a warning that comes and goes once is enough.
void Events::comeAgain(Event &event, bool isSeen) {
    ++event.times;
    event.stamp = stampNow();
    event.began = monotonicNow();
    if (event.isOver)
        event.over = monotonicNow();
    if (event.level == Event::Level::Error)
        event.isAcknowledged = isSeen;
    tell(event);
}

void Events::tell(const Event &event) {
    if (event.level == Event::Level::Error && !event.isAcknowledged)
        Q_EMIT alarm();
    Q_EMIT changed();
}

} // namespace hermes::desktop
