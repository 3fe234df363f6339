#include "daemons/recorder/SessionReport.h"

#include "common/schema/SchemaValidator.h"
#include "daemons/recorder/DriveHistory.h"
#include "daemons/recorder/HaltCause.h"
#include "protocol/wire/Fields.h"

#include <QDateTime>
#include <QMap>
#include <algorithm>
#include <cmath>

namespace hermes::recorder {
namespace {

constexpr double before_s = 10, after_s = 5; // around a moment
constexpr int mostShown = 200;
constexpr double stands_mps = 0.01, stands_radps = 0.02; // and less

QString velocityText(const Twist2D &v) {
    const auto rounded = [](double value) {
        return QString::number(std::round(100 * value) / 100 + 0.0, 'f', 2);
    };
    return QString("%1 m/s ahead, %2 m/s to the left, %3 rad/s")
        .arg(rounded(v.vx), rounded(v.vy), rounded(v.omega));
}

bool isStanding(const Twist2D &v) {
    return std::hypot(v.vx, v.vy) < stands_mps && std::abs(v.omega) < stands_radps;
}

struct TopicTimes {
    quint64 messages = 0;
    double first_s = 0, last_s = 0, longestGap_s = 0;

    void add(double t_s) {
        if (messages++ == 0)
            first_s = last_s = t_s;
        longestGap_s = std::max(longestGap_s, t_s - last_s);
        last_s = t_s;
    }
    double rate_hz() const { return last_s > first_s ? double(messages - 1) / (last_s - first_s) : 0; }
};

/// In seconds: as the sidecars tell, and to the last message of one that goes on or was cut off.
double lengthOf(const SessionReader &session, const DriveHistory &history) {
    return std::max(history.duration_s(), session.recorded().duration_s);
}

/// Makes the page.
class Page {
public:
    Page(SessionReader &session, const DriveHistory &history)
        : session_(session)
        , history_(history)
        , length_s_(lengthOf(session, history)) {}

    QString about(std::optional<double> at_s) {
        const Halt *halt = at_s ? history_.haltNear(*at_s) : history_.lastFault();
        isWhole_ = !at_s && !halt;
        at_s_ = at_s ? *at_s : halt ? halt->t_s : 0;
        tellSession();
        if (halt)
            tellHalt(*halt);
        else
            add(at_s ? QString("At %1: the robot did not stop within %2 s of it.")
                           .arg(timeText(at_s_))
                           .arg(before_s)
                     : QString("The robot did not stop by a fault, nor by anybody else than its driver."));
        tellAround();
        tellWrong();
        tellDrives();
        return lines_.join('\n') + '\n';
    }

private:
    void add(const QString &line) { lines_.append(line); }

    QString timeText(double t_s) const {
        const auto time = QDateTime::fromMSecsSinceEpoch(qint64((session_.start() + t_s) * 1000));
        return QString("%1 (%2 s)").arg(time.toString("hh:mm:ss.zzz")).arg(t_s, 0, 'f', 2);
    }

    void tellSession() {
        const SessionSummary summary = session_.recorded().summary();
        add(QString("Session %1, begun %2, %3 s, recorded by %4")
                .arg(summary.name,
                     QDateTime::fromMSecsSinceEpoch(qint64(session_.start() * 1000))
                         .toString("yyyy-MM-dd hh:mm:ss"),
                     QString::number(length_s_, 'f', 1), summary.daemons.join(", ")));
        for (const QString &problem : summary.problems + session_.problems())
            add("Missing: " + problem);
        add({});
    }

    void tellHalt(const Halt &halt) {
        add(QString("The robot stopped at %1: %2").arg(timeText(halt.t_s), halt.reason));
        add("  Cause: " + haltCause(halt.cause).text);
        if (halt.driver.isEmpty())
            add("  Nobody drove then.");
        else
            add(QString("  %1 drove until then, for %2 s")
                    .arg(halt.driver)
                    .arg(halt.t_s - halt.driven_from_s, 0, 'f', 1));
        tellMotion(halt.t_s);
        for (const QString &later : halt.later)
            add("  Then: " + later);
        add({});
    }

    /// Commanded and measured just before, and how it came to a stand.
    void tellMotion(double t_s) {
        std::optional<Twist2D> target, measured;
        std::optional<double> stood_s;
        std::optional<Pose2D> at;
        double way_m = 0;
        const auto wanted = [](const QString &topic) {
            return topic == "motorcontrol/odometry" || topic == "motorcontrol/wheels";
        };
        const auto take = [&](const SessionMessage &message) {
            ReadReport report;
            if (message.name() == "wheels") {
                if (message.t_s < t_s)
                    if (const auto twist = readMessage<Twist2D>(message.data()["target"], report))
                        if (!target || !isStanding(*twist)) // that of the halt is no command
                            target = twist;
                return;
            }
            const auto odometry = readMessage<OdometryMessage>(message.data(), report);
            if (!odometry || stood_s)
                return;
            if (message.t_s <= t_s)
                measured = odometry->twist;
            else if (at)
                way_m += std::hypot(odometry->pose.x - at->x, odometry->pose.y - at->y);
            at = odometry->pose;
            if (message.t_s > t_s && isStanding(odometry->twist))
                stood_s = message.t_s - t_s;
        };
        session_.read(wanted, take, std::max(0.0, t_s - 1), t_s + after_s);
        if (target)
            add("  Commanded last: " + velocityText(*target));
        if (measured)
            add("  Measured last:  " + velocityText(*measured));
        if (measured && isStanding(*measured))
            add("  The wheels stood already.");
        else if (stood_s)
            add(QString("  The wheels stood %1 s later, after %2 m.")
                    .arg(*stood_s, 0, 'f', 2)
                    .arg(way_m, 0, 'f', 2));
        else if (measured)
            add(QString("  No standstill of the wheels is recorded after it."));
    }

    void tellAround() {
        const double from_s = isWhole_ ? 0 : at_s_ - before_s;
        const double to_s = std::min(length_s_, isWhole_ ? 1e9 : at_s_ + after_s);
        QStringList events;
        int more = 0;
        for (const Event &event : history_.events()) {
            if (event.t_s < from_s || event.t_s > to_s)
                continue;
            if (events.size() < mostShown)
                events.append(QString("  %1  %2").arg(timeText(event.t_s), event.text));
            else
                ++more;
        }
        add(QString("What happened from %1 s to %2 s:")
                .arg(std::max(0.0, from_s), 0, 'f', 1)
                .arg(to_s, 0, 'f', 1));
        lines_ += events.isEmpty() ? QStringList("  nothing that was recorded") : events;
        if (more > 0)
            add(QString("  and %1 more").arg(more));
        add({});
    }

    void tellWrong() {
        const double t_s = isWhole_ ? length_s_ : at_s_ + 1; // health follows what it tells
        const QStringList wrong = history_.wrongAt(t_s);
        add(isWhole_ ? QString("What was wrong at the end:") : QString("What was wrong at that time:"));
        lines_ += wrong.isEmpty() ? QStringList("  nothing") : wrong;
        add({});
    }

    void tellDrives() {
        add("Who drove, and why each drive ended:");
        if (history_.halts().empty() && history_.driver().isEmpty())
            add("  nobody");
        for (const Halt &halt : history_.halts())
            add(halt.driver.isEmpty() ? QString("  %1  nobody: %2").arg(timeText(halt.t_s), halt.reason)
                                      : QString("  %1  %2, from %3 s on, %4 m, up to %5 m/s: %6")
                                            .arg(timeText(halt.t_s), halt.driver)
                                            .arg(halt.driven_from_s, 0, 'f', 1)
                                            .arg(halt.way_m, 0, 'f', 1)
                                            .arg(halt.fastest_mps, 0, 'f', 2)
                                            .arg(halt.reason));
        if (!history_.driver().isEmpty())
            add(QString("  %1 drove to the end of the session").arg(history_.driver()));
    }

    SessionReader &session_;
    const DriveHistory &history_;
    const double length_s_;
    QStringList lines_;
    bool isWhole_ = false;
    double at_s_ = 0;
};

} // namespace

std::vector<SessionMark> sessionMarks(SessionReader &session) {
    constexpr std::size_t maxMarks = 1000;
    std::vector<SessionMark> marks;
    session.read([](const QString &topic) { return topic == "recorder/marks"; },
                 [&marks](const SessionMessage &message) {
                     if (marks.size() < maxMarks)
                         marks.push_back({message.t_s, message.data()["text"].text()});
                 });
    return marks;
}

SessionInfo sessionInfo(SessionReader &session) {
    DriveHistory history(false); // without its events, which take memory
    QMap<QString, TopicTimes> times;
    for (auto lost = session.lost().begin(); lost != session.lost().end(); ++lost)
        times[lost.key()]; // also where nothing else came
    session.read({}, [&](const SessionMessage &message) {
        times[message.topic].add(message.t_s);
        history.take(message);
    });
    SessionInfo info;
    info.summary = session.recorded().summary();
    info.summary.problems += session.problems();
    info.duration_s = lengthOf(session, history);
    info.driven_m = history.driven_m();
    for (const RecordedPart &part : session.recorded().parts)
        info.parts.push_back(part.summary());
    info.marks = history.marks();
    info.stops = history.stops();
    info.faults = history.faults();
    for (auto topic = times.begin(); topic != times.end(); ++topic)
        info.topics.push_back({topic.key(), topic->messages, quint64(session.lost().value(topic.key())),
                               topic->rate_hz(), topic->longestGap_s});
    return info;
}

Result<QString> explainSession(SessionReader &session, std::optional<double> at_s) {
    DriveHistory history;
    bool isEmpty = true;
    session.read(&DriveHistory::wants, [&](const SessionMessage &message) {
        history.take(message);
        isEmpty = false;
    });
    if (isEmpty)
        return Error(ErrorCode::NotReady,
                     session.folder() +
                         ": found no messages of a robot, expected those of recorder-0001.mcap and on" +
                         (session.problems().isEmpty() ? QString() : ": " + session.problems().join("; ")));
    const double end_s = lengthOf(session, history);
    if (at_s && *at_s > end_s)
        return invalidParams({{"at_s", *at_s, "a time of the session"}},
                             QString("at_s is %1 s, expected at most the %2 s of the session")
                                 .arg(*at_s)
                                 .arg(end_s, 0, 'f', 1));
    return Page(session, history).about(at_s);
}

} // namespace hermes::recorder
