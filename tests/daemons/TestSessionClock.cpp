// A wall clock that is set while a session is recorded, as that of a board which gets its time by network
// late.
#include "daemons/recorder/SessionControl.h"
#include "daemons/recorder/SessionReport.h"
#include "tests/daemons/FakeLogger.h"
#include "tests/support/Rows.h"
#include "tests/support/SessionFolder.h"

using namespace hermes;
using namespace hermes::recorder;

namespace {

/// Records since six seconds, with a clock that was set since.
class EarlierLogger : public Daemon {
public:
    EarlierLogger()
        : Daemon({"seriallogger", "seriallogger", "For tests"}) {
        addCommand(Command("record.start", "Begins").handler([](const Call &) { return QJsonValue(); }));
        addCommand(Command("record.status", "Tells").handler([](const Call &) {
            return QJsonObject{
                {"recording", true}, {"name", "run"}, {"session", "7f3a"}, {"start", 1e3}, {"duration_s", 6}};
        }));
        if (prepare({"seriallogger", "--listen", "tcp://127.0.0.1:0"}) || !launch())
            qFatal("the logger does not start");
    }
    ~EarlierLogger() override { shutDown(); }

    QString address() { return server().addresses().value(0); }
};

} // namespace

class TestSessionClock : public QObject {
    Q_OBJECT

    /// What record.list of two loggers tells: the second begins a second after the first, and both end after
    /// six. The wall clock is set before the second begins.
    static SessionReplies lists(double step_s, bool hasMono = true) {
        SessionReplies replies;
        for (const auto &[name, after_s] : {std::pair("velodynelogger", 0.0), {"recorder", 1.0}}) {
            const double start = 1.7e9 + after_s + (after_s > 0 ? step_s : 0);
            QJsonObject entry{
                {"name", "run"}, {"session", "7f3a"},  {"start", start},   {"end", 1.7e9 + 6 + step_s},
                {"bytes", 1},    {"ended", "stopped"}, {"complete", true}, {"folder", "/none"}};
            if (hasMono) {
                entry.insert("start_mono", 50 + after_s);
                entry.insert("boot", "this run");
                entry.insert("duration_s", 6 - after_s);
            }
            SessionMember member;
            member.name = name;
            member.replays = true;
            replies.push_back({member, QJsonValue(QJsonArray{entry})});
        }
        return replies;
    }

    /// The recorder's own part of a session: answers record.list with this, and begins what it is asked for.
    static SessionMember ownMember(const QJsonValue &list) {
        SessionMember own;
        own.name = "recorder";
        own.replays = true;
        own.send = [list](const QString &method, const QJsonObject &params, const Client::Callback &done,
                          std::chrono::milliseconds) {
            done(method == "record.list"
                     ? list
                     : QJsonObject{{"recording", method == "record.start"}, {"session", params["session"]}});
        };
        return own;
    }

private Q_SLOTS:
    void init() { Log::instance().setStderr(false); }

    void lengthsAndOffsetsDoNotChange_data() {
        const Rows<double> row("step_s");
        row("not set", 0);
        row("ahead", 600);
        row("back", -900);
        row("to 1970", -1.7e9);
    }
    void lengthsAndOffsetsDoNotChange() {
        QFETCH(double, step_s);
        const RecordedSession session = SessionList::of(lists(step_s)).sessions.at(0);
        QCOMPARE(session.start, 1.7e9);
        QCOMPARE(session.duration_s, 6.0);
        QCOMPARE(*session.summary().duration_s, 6.0);
        QCOMPARE(session.parts.at(0).offset_s, 0.0);
        QCOMPARE(session.parts.at(1).offset_s, 1.0);
        SessionReplies others = lists(step_s); // whoever answers first
        std::swap(others[0], others[1]);
        const RecordedSession same = SessionList::of(others).sessions.at(0);
        QCOMPARE(same.start, 1.7e9);
        QCOMPARE(same.duration_s, 6.0);
        QCOMPARE(same.parts.at(0).offset_s, 1.0);
    }

    // By an older version, or on several hosts.
    void withoutStampsOfItTheWallClockCounts() {
        const RecordedSession usual = SessionList::of(lists(0, false)).sessions.at(0);
        QCOMPARE(usual.duration_s, 6.0);
        QCOMPARE(usual.parts.at(1).offset_s, 1.0);
        QVERIFY(SessionList::of(lists(-900, false)).sessions.at(0).duration_s >= 0);
    }

    void aPlaceWithinTheSessionIsPlayed_data() {
        const Rows<double> row("step_s");
        row("ahead", 600);
        row("back", -900);
    }
    void aPlaceWithinTheSessionIsPlayed() {
        QFETCH(double, step_s);
        RobotDaemons daemons("");
        SessionControl control(daemons, ownMember(*lists(step_s)[0].result));
        QString told;
        const auto tell = [&](const Result<SessionState> &state) {
            told = state ? state->state : state.error().message;
        };
        SessionPlayer::Options options;
        options.from_s = 7;
        control.replay("run", options, tell);
        QTRY_COMPARE(told, QString("from_s is 7 s, expected at most the 6.0 s of the session"));
        options.from_s = 5;
        control.replay("run", options, tell);
        QTRY_COMPARE(told, QString("replaying"));
    }

    void aSessionThatGoesOnIsAsOldAsItsLoggerSays() {
        EarlierLogger logger;
        RobotDaemons daemons("");
        SessionControl control(daemons, ownMember(QJsonArray()));
        daemons.follow({logger.address()});
        QTRY_COMPARE(control.state().state, QString("recording"));
        const double duration_s = control.state().duration_s;
        QVERIFY2(duration_s >= 6 && duration_s < 100, qPrintable(QString::number(duration_s)));
    }

    void reportsTellTheTimeThatPassed() {
        SessionFolder folder;
        folder.add(0, "recorder/marks", SessionMark{0, "begin"});
        folder.add(6, "recorder/marks", SessionMark{6, "end"});
        folder.finish({}, {{"start_mono", 50}, {"end_mono", 56.5}, {"end", SessionFolder::start - 900}});
        auto session = SessionReader::open(folder.path());
        const SessionInfo info = sessionInfo(*session);
        QCOMPARE(*info.summary.duration_s, 6.5);
        QCOMPARE(info.duration_s, 6.5);
        const QString text = *explainSession(*session, {});
        QVERIFY2(text.section('\n', 0, 0).contains(", 6.5 s, recorded by"), qPrintable(text));
        QVERIFY2(text.contains("What happened from 0.0 s to 6.5 s"), qPrintable(text));
    }
};
