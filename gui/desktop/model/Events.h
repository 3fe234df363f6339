#pragma once

#include <QObject>
#include <deque>
#include <map>

namespace hermes::desktop {

/// One thing that an operator has to know of.
struct Event {
    enum class Level { Info, Warning, Error };

    quint64 id = 0;
    Level level = Level::Info;
    double stamp = 0; ///< s since the epoch, by this computer's clock: when it came last
    QString from;     ///< who tells it: a daemon, with its robot
    QString text;     ///< one short line
    int times = 1;    ///< how often it came
    bool isOver = true;
    bool isAcknowledged = false;
    double began = 0, over = 0; ///< monotonic s: when it came last, and ended
    QString key;                ///< of Events::goesOn()
};

/// What has happened to the robots and what is wrong with them now, the latest last: of each whether it goes
/// on and whether the operator has seen it. What comes again and again is one event that says how often. An
/// error waits until it is acknowledged; a warning goes by itself some time after it is over.
class Events : public QObject {
    Q_OBJECT
public:
    static constexpr std::size_t most = 1000;
    /// A warning that is over is shown for so long.
    static constexpr double warningStays_s = 10;
    /// What ended less than this ago and comes again is the same event.
    static constexpr double sameWithin_s = 60;

    using QObject::QObject;

    /// Something that has no duration. isSeen: the operator knows it already.
    void happened(Event::Level level, const QString &from, const QString &text, bool isSeen = false);
    /// Something that was so before anybody looked: at that time. isSeen: it waits for nobody.
    void happenedBefore(Event::Level level, const QString &from, const QString &text, double stamp,
                        bool isSeen = true);
    /// Something that goes on until ends(key). Told again it is the same event; with a higher level it has to
    /// be acknowledged again. An error that comes again with another text is another one.
    void goesOn(const QString &key, Event::Level level, const QString &from, const QString &text,
                bool isSeen = false);
    void ends(const QString &key);
    /// All whose key begins so.
    void endAll(const QString &prefix);

    /// Whoever told it has another name now.
    void rename(const QString &from, const QString &to);
    void acknowledge(quint64 id);
    void acknowledgeAll();

    const std::deque<Event> &all() const { return events_; }
    /// How many were left out because there were too many.
    quint64 forgotten() const { return forgotten_; }
    /// Of those that wait to be acknowledged, what goes on or came within a minute; of those the worst, then
    /// the latest. Null: none.
    const Event *loudest() const;
    /// How many wait.
    int waiting() const;

Q_SIGNALS:
    void changed();
    /// A new error that the operator has not seen.
    void alarm();

private:
    Event *find(quint64 id);
    Event *alike(Event::Level level, const QString &from, const QString &text);
    Event &add(Event::Level level, const QString &from, const QString &text, double stamp);
    void comeAgain(Event &event, bool isSeen);
    void tell(const Event &event);
    void makeRoom();
    static bool isWaiting(const Event &event);

    std::deque<Event> events_;
    std::map<QString, quint64> open_; ///< what goes on or did lately, by key
    quint64 last_ = 0, forgotten_ = 0;
};

} // namespace hermes::desktop
