#include "daemons/motorcontrol/Drive.h"
#include "daemons/recorder/SessionReport.h"
#include "protocol/messages/Daemons.h"
#include "protocol/messages/Motors.h"
#include "tests/support/Rows.h"
#include "tests/support/SessionFolder.h"

using namespace hermes;
using namespace hermes::recorder;
using motorcontrol::Drive;

using Ending = std::function<void(Drive &, double)>;
Q_DECLARE_METATYPE(Ending)

namespace {

/// A drive of anna by the real drive of motor control, as the recorder sees it at 50 Hz.
class RecordedDrive {
public:
    explicit RecordedDrive(SessionFolder &folder)
        : folder_(folder) {
        drive_.configure({});
        drive_.setReady();
    }

    /// Commands at each step until the end, when something happens; then the robot comes to a stand.
    void run(double begin, double end, const Ending &happens) {
        QVERIFY(drive_.acquire(1, "anna", 1, begin).ok());
        for (double t = begin; t < end; t += 0.02)
            step(t, true);
        happens(drive_, end);
        for (double t = end; t < end + 3; t += 0.02)
            step(t, false);
    }
    Drive &drive() { return drive_; }

private:
    void step(double t, bool commands) {
        if (commands)
            QVERIFY(drive_.driveTwist(1, {0.5, 0, 0.1}, 0, t).ok());
        drive_.step(t);
        speed_ = drive_.haltReason().isEmpty() ? 0.5 : std::max(0.0, speed_ - 0.05);
        x_ += speed_ * 0.02;
        const MotionHold hold{drive_.latch().causes(), drive_.lease().state(t), drive_.haltReason(),
                              drive_.haltCause()};
        const QByteArray text = compactJson(asJson(MotionHold{
            hold.latched, {hold.control.held, hold.control.holder, 0, {}}, hold.halted, hold.cause}));
        if (std::exchange(told_, text) != text)
            folder_.add(t, "motorcontrol/control", hold);
        folder_.add(t, "motorcontrol/wheels", QByteArray(R"({"target":{"vx":0.5,"vy":0,"omega":0.1}})"));
        folder_.add(t, "motorcontrol/odometry", OdometryMessage{{x_, 0, 0}, {speed_, 0, 0}, {}, t});
    }

    SessionFolder &folder_;
    Drive drive_;
    QByteArray told_;
    double x_ = 0, speed_ = 0;
};

} // namespace

class TestSessionReport : public QObject {
    Q_OBJECT

    static QString explain(const SessionFolder &folder, std::optional<double> at_s = {}) {
        auto session = SessionReader::open(folder.path());
        if (!session)
            return session.error().message;
        const auto text = explainSession(*session, at_s);
        return text ? *text : text.error().message;
    }

private Q_SLOTS:
    void causeIsNamed_data() {
        const Rows<Ending, QStringList> row("ending", "told");
        row("emergency stop", [](Drive &d, double t) { d.emergencyStop(2, "window, 127.0.0.1:5000", t); },
            {"Cause: STOP", "emergency stop by window, 127.0.0.1:5000"});
        row("stop", [](Drive &d, double) { d.stop(2, "bert, 127.0.0.1:5001"); },
            {"Cause: STOP", "stopped by bert, 127.0.0.1:5001"});
        row("time-out", [](Drive &, double) {},
            {"Cause: time-out", "no command for 0.25 s", "Then: the control of anna ran out"});
        row("lost controller", [](Drive &d, double) { d.setNotReady("controller 1: does not answer"); },
            {"Cause: lost controller", "controller 1: does not answer"});
        row("take-over", [](Drive &d, double t) { QVERIFY(d.takeOver(2, "bert", 1, t).ok()); },
            {"Cause: take-over", "bert took the control over from anna"});
        row("low battery", [](Drive &d, double) { d.fault("battery", "controller 1: the battery has 17 V"); },
            {"Cause: low battery", "controller 1: the battery has 17 V"});
        row("lost client", [](Drive &d, double) { d.clientGone(1); }, {"Cause: lost client"});
    }
    void causeIsNamed() {
        FETCH(Ending, ending, QStringList, told);
        SessionFolder folder;
        RecordedDrive(folder).run(1, 4, ending);
        folder.finish();
        const QString text = explain(folder);
        told += {"anna drove until then, for 3.", "Commanded last: 0.50 m/s ahead",
                 "Measured last:  0.45 m/s ahead", "The wheels stood 0.1"};
        for (const QString &line : told)
            QVERIFY2(text.contains(line), qPrintable(line + "\n\n" + text));
        QCOMPARE(text.count("Cause:"), 1);
    }

    void aDriveThatItsDriverEndedIsNoFault() {
        SessionFolder folder;
        RecordedDrive(folder).run(1, 4, [](Drive &d, double) { d.release(1); });
        folder.finish();
        const QString text = explain(folder);
        QVERIFY2(text.contains("did not stop by a fault") && text.contains("the control was released"),
                 qPrintable(text));
        QVERIFY(explain(folder, 4).contains("Cause: the client that drove gave the control back"));
        QVERIFY(explain(folder, 60).startsWith("at_s is 60 s, expected at most the "));
    }

    // Who looks for the cause wants the first of what followed one another, of the last drive.
    void theLastOfSeveralStopsIsMeant() {
        SessionFolder folder;
        RecordedDrive drive(folder);
        drive.run(1, 4, [](Drive &d, double t) { d.emergencyStop(2, "bert", t); });
        drive.drive().resetEmergencyStop("bert");
        drive.run(20, 22, [](Drive &d, double) {
            d.setNotReady("controller 2: does not answer");
            d.fault("controller_2", "controller 2 reports: logic battery");
        });
        folder.nextFile();
        folder.add(26, "recorder/marks", SessionMark{26, "a door"});
        folder.finish();
        const QString text = explain(folder), first = explain(folder, 5);
        QVERIFY2(text.contains("controller 2 reports: logic battery") &&
                     text.contains("anna drove until then"),
                 qPrintable(text));
        QVERIFY2(text.contains("mark: a door"), qPrintable(text));
        QVERIFY2(first.contains("emergency stop by bert\n  Cause: STOP") && !first.contains("a door"),
                 qPrintable(first));
    }

    void whatHappenedAndWhatWasWrong() {
        SessionFolder folder;
        folder.add(0, "velodynelogger/status",
                   DaemonStatus{"running", {{"packets", "ok", "750 a second", {}, 0}}, {}});
        RecordedDrive drive(folder);
        drive.run(1, 4, [&](Drive &d, double t) {
            folder.add(
                t, "motorcontrol/commands",
                QByteArray(
                    R"({"stamp":1,"client":"127.0.0.1:5","role":"observer","method":"motor.estop","params":{"client":"window"}})"));
            folder.add(t, "velodynelogger/status",
                       DaemonStatus{"running", {{"packets", "error", "none came", {}, 0}}, {}});
            folder.add(t, "supervisor/log", LogMessage{1, "warning", "process", "velodynelogger: ended"});
            d.emergencyStop(2, "window", t);
        });
        folder.add(
            8, "motorcontrol/commands",
            QByteArray(
                R"({"stamp":1,"client":"x","role":"engineer","method":"motor.stop","error":-1,"message":"no"})"));
        folder.finish({{"velodynelogger/cloud", 3}});
        const QString text = explain(folder);
        for (const char *line :
             {"127.0.0.1:5 (observer) to motorcontrol: motor.estop {\"client\":\"window\"}",
              "health of velodynelogger packets: error: none came",
              "log of supervisor: warning process: velodynelogger: ended",
              "x (engineer) to motorcontrol: motor.stop, refused: no",
              "What was wrong at that time:\n  velodynelogger packets: error: none came"})
            QVERIFY2(text.contains(line), qPrintable(line + QString("\n\n") + text));

        auto session = SessionReader::open(folder.path());
        const SessionInfo info = sessionInfo(*session);
        QCOMPARE(info.summary.session, QString("7f3a"));
        QCOMPARE(info.duration_s, 8.0);
        QVERIFY2(std::abs(*info.driven_m - 1.55) < 0.05, qPrintable(QString::number(*info.driven_m)));
        QCOMPARE(info.stops, QStringList{"4.00 s: motor.estop by 127.0.0.1:5"});
        QCOMPARE(info.faults, QStringList{"4.00 s: velodynelogger packets error: none came"});
        const auto topic = [&](const QString &name) {
            return *std::find_if(info.topics.begin(), info.topics.end(),
                                 [&](const auto &t) { return t.topic == name; });
        };
        QCOMPARE(topic("velodynelogger/cloud").lost, quint64(3));
        QVERIFY(std::abs(topic("motorcontrol/odometry").rate_hz - 50) < 1);
        QCOMPARE(topic("velodynelogger/status").longest_gap_s, 4.0);
    }

    void hostileSessionsAreRefusedOrRead_data() { rowsOf<QByteArray>("mcap", {"", "hello"}); }
    void hostileSessionsAreRefusedOrRead() {
        QFETCH(QByteArray, mcap);
        SessionFolder folder;
        folder.finish();
        put(folder.filePath("recorder-0001.mcap"), mcap);
        QVERIFY2(explain(folder).contains("found no messages"), qPrintable(explain(folder)));
    }

    void readingThatIsToEndOpensNoMoreFiles() {
        SessionFolder folder;
        folder.add(0, "recorder/marks", SessionMark{0, "begin"});
        folder.add(1, "recorder/marks", SessionMark{1, "more"});
        folder.finish();
        put(folder.filePath("recorder-0002.mcap"), "hello");
        std::atomic<bool> stop{false};
        auto session = SessionReader::open(folder.path(), &stop);
        int messages = 0;
        session->read({}, [&](const SessionMessage &) {
            stop = true;
            ++messages;
        });
        QCOMPARE(messages, 1);
        QCOMPARE(session->problems(), QStringList());
        stop = false;
        session->read({}, [&](const SessionMessage &) { ++messages; });
        QCOMPARE(messages, 3);
        QCOMPARE(session->problems().size(), 1); // of the second file
    }

    void messagesThatAreNoneAreLeftOut() {
        SessionFolder folder;
        for (const QByteArray text :
             {"", "{", "[]", "null", R"({"control":5,"halted":[]})", R"({"health":[{}]})"})
            for (const char *topic : {"motorcontrol/control", "motorcontrol/odometry", "motorcontrol/wheels",
                                      "a/status", "a/log", "a/commands", "recorder/marks"})
                folder.add(1, topic, text);
        RecordedDrive(folder).run(2, 4, [](Drive &d, double) { d.stop(2, "bert"); });
        folder.finish();
        QVERIFY2(explain(folder).contains("Cause: STOP"), qPrintable(explain(folder)));
        QVERIFY(explain(folder, -1e300).contains("did not stop"));
        QVERIFY(explain(folder, 1e300).startsWith("at_s is 1e+300 s, expected "));
        QCOMPARE(explain(SessionFolder()).section(": ", -1),
                 QString("found no sidecar of a recording, expected some"));
    }
};
