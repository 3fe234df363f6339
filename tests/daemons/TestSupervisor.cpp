#include "common/client/DaemonAddress.h"
#include "daemons/supervisor/Supervisor.h"
#include "tests/support/DaemonClient.h"

using namespace hermes;
using namespace hermes::supervisor;

/// The supervisor with real processes: small shell scripts, and a daemon of ours.
class TestSupervisor : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void init() {
        folder_ = std::make_unique<QTemporaryDir>();
        qunsetenv("HERMES_ROBOT");
    }

    void cleanup() {
        client_.reset();
        if (supervisor_)
            supervisor_->shutDown();
        supervisor_.reset();
    }

    void startsInOrderAndEndsAtOnce() {
        const QString script = "trap 'echo told %1 >> " + folder_->filePath("log") +
                               "; sleep %2; echo end %1 >> " + folder_->filePath("log") +
                               "; exit 0' TERM; echo start %1 >> " + folder_->filePath("log") +
                               "; while :; do sleep 0.02; done";
        launch({shell("one", script.arg("one", "1")), shell("two", script.arg("two", "1")),
                shell("three", script.arg("three", "1"), false)});
        QTRY_COMPARE(written().size(), 2);
        QCOMPARE(stateOf("one"), QString("running"));
        QCOMPARE(stateOf("three"), QString("stopped"));
        QVERIFY(call("process.start", {{"name", "three"}}).ok());
        QTRY_COMPARE(written().size(), 3);
        client_.reset();
        supervisor_->shutDown();
        QStringList told = written().mid(3, 3); // before the first one has ended
        told.sort();
        QCOMPARE(told, QStringList({"told one", "told three", "told two"}));
        QCOMPARE(written().size(), 9); // each is told once, and ends
    }

    void killedProcessComesBackWithBackOff() {
        launch({shell("one", "exec sleep 100")});
        QTRY_COMPARE(stateOf("one"), QString("running"));
        std::map<int, QJsonObject> waits; // by the restarts before: what is told as soon as one waits
        client_->subscribe("processes", {{"queue", 100}}, [&](const TopicUpdate &update) {
            const QJsonObject told = update.json()["processes"][0].toObject();
            if (told["state"].toString() == "waiting")
                waits.try_emplace(told["restarts"].toInt(), told);
        });
        QTRY_VERIFY(supervisor_->hasSubscribers("processes"));
        for (int restarts : {0, 1}) {
            QTRY_COMPARE(stateOf("one"), QString("running"));
            const QJsonObject before = process("one");
            QCOMPARE(before["restarts"].toInt(), restarts);
            QCOMPARE(::kill(before["pid"].toInt(), SIGKILL), 0);
            QTRY_VERIFY(waits.count(restarts) == 1);
            QCOMPARE(waits[restarts]["last_exit"].toString(), QString("killed by signal 9 (SIGKILL)"));
        }
        QTRY_COMPARE(stateOf("one"), QString("running"));
        QCOMPARE(process("one")["restarts"].toInt(), 2);
        const double first = waits[0]["next_start_s"].toDouble(),
                     second = waits[1]["next_start_s"].toDouble();
        QVERIFY2(first > 0 && first < 0.55, saying(first)); // a timer may be 5 % late
        QVERIFY2(second > 0.55 && second < 1.1, saying(second));
    }

    void endInOrderIsNotStartedAgain() {
        launch({shell("one", "exit 0")});
        QTRY_COMPARE(process("one")["last_exit"].toString(), QString("exit status 0"));
        QCOMPARE(stateOf("one"), QString("stopped"));
    }

    void wrongCommandLineIsNotTriedAgain() {
        launch({shell("one", "echo what is wrong; exit 2")});
        QTRY_COMPARE(stateOf("one"), QString("failed"));
        QCOMPARE(process("one")["last_exit"].toString(), QString("exit status 2: what is wrong"));
        QTRY_COMPARE(call("daemon.status")->toObject()["state"].toString(), QString("degraded"));
    }

    /// By hand it ends; as a service it stays, starts nothing, and tells; the file is not written over.
    void aServiceTellsOfAWrongSettingsFile() {
        const QString name = folder_->filePath("supervisor.json");
        put(name, "{\n\"processes\": [}\n");
        const QStringList line{"hermes-supervisor", "--listen", "tcp://127.0.0.1:0", "--config", name};
        QVERIFY(Supervisor().prepare(line).has_value());
        qputenv("NOTIFY_SOCKET", folder_->filePath("nobody").toUtf8());
        QVERIFY(Supervisor().prepare(line + QStringList{"--check"}).has_value());
        supervisor_ = std::make_unique<Supervisor>();
        const auto ended = supervisor_->prepare(line);
        qunsetenv("NOTIFY_SOCKET");
        QVERIFY(!ended);
        QVERIFY(supervisor_->launch().ok());
        client_ = std::make_unique<ConnectedClient>(asOwner(supervisor_->info().listen.front()));
        const QJsonObject status = call("daemon.status")->toObject();
        QCOMPARE(status["state"].toString(), QString("degraded"));
        QVERIFY(QJsonDocument(status).toJson().contains("line 2"));
        for (const QJsonValue &process : call("process.list")->toObject()["processes"].toArray())
            QCOMPARE(process.toObject()["state"].toString(), QString("stopped"));
        QVERIFY(!call("settings.save").ok());
    }

    void processesDoNotSpeakToTheServiceManager() {
        qputenv("NOTIFY_SOCKET", "/nowhere/notify");
        launch({shell("one", "echo \"heard: $NOTIFY_SOCKET\"; sleep 100")});
        qunsetenv("NOTIFY_SOCKET");
        QTRY_COMPARE(call("process.output", {{"name", "one"}})->toArray(), QJsonArray{"heard: "});
    }

    void missingProgramIsTold() {
        const QTemporaryDir folder;
        const QString program = folder.filePath("one");
        launch({QJsonObject{
            {"name", "one"}, {"program", program}, {"arguments", QJsonArray{"100"}}, {"autostart", true}}});
        QTRY_COMPARE(stateOf("one"), QString("waiting"));
        VERIFY_STARTS(process("one")["last_exit"].toString(), program + ": ");
        QVERIFY(QFile::link("/bin/sleep", program));
        QTRY_COMPARE(stateOf("one"), QString("running"));
    }

    void stubbornProcessIsKilled() {
        launch({shell("one", "trap '' TERM; echo deaf; while :; do sleep 0.02; done")});
        QTRY_COMPARE(call("process.output", {{"name", "one"}})->toArray(), QJsonArray{"deaf"});
        QVERIFY(call("process.stop", {{"name", "one"}}).ok());
        QCOMPARE(stateOf("one"), QString("stopping"));
        QTRY_COMPARE_WITH_TIMEOUT(stateOf("one"), QString("stopped"), 8000);
    }

    void whatAProcessLeavesBehindIsKilled_data() {
        const Rows<QString> row("script");
        row("child", "sleep 600 & echo $!; wait");
        row("session of its own", "setsid sh -c 'echo $$; exec sleep 600' & wait");
        row("daemon", "(setsid sh -c 'echo $$; exec sleep 600' &) ; sleep 600");
        row("of a process that has ended", "setsid sh -c 'echo $$; exec sleep 600' & sleep 0.2");
    }

    void whatAProcessLeavesBehindIsKilled() {
        QFETCH(QString, script);
        launch({shell("one", script)});
        const auto output = [this] { return call("process.output", {{"name", "one"}})->toArray(); };
        QTRY_COMPARE(output().size(), 1);
        const pid_t left = output()[0].toString().toInt();
        QVERIFY(left > 1 && ::kill(left, 0) == 0);
        QVERIFY(call("process.stop", {{"name", "one"}}).ok());
        QTRY_COMPARE(stateOf("one"), QString("stopped"));
        const auto isGone = [left] { // or is dead and was not collected
            QFile file(QString("/proc/%1/stat").arg(left));
            return !file.open(QFile::ReadOnly) || file.readAll().contains(") Z");
        };
        QTRY_VERIFY(isGone());
    }

    void restartsInAStormEndInOneProcess() {
        launch({shell("one", "exec sleep 600")});
        for (int i = 0; i < 50; ++i)
            QVERIFY(call("process.restart", {{"name", "one"}}).ok());
        QTRY_COMPARE(stateOf("one"), QString("running"));
        QVERIFY(call("process.stop", {{"name", "one"}}).ok());
        QTRY_COMPARE(stateOf("one"), QString("stopped"));
    }

    void keepsTheLastOutput() {
        launch({shell("one", "i=0; while [ $i -lt 300 ]; do echo line $i; i=$((i+1)); done; printf 'no\\0 "
                             "end'; exec sleep 100")});
        const QString zero = QString("no") + QChar(0) + " end";
        const auto lines = [this](int count) {
            return call("process.output", {{"name", "one"}, {"lines", count}})->toArray();
        };
        QTRY_COMPARE(lines(2), (QJsonArray{"line 299", zero}));
        QCOMPARE(lines(200).size(), 200);
        QCOMPARE(lines(200)[0].toString(), QString("line 101"));
        QVERIFY(call("process.stop", {{"name", "one"}}).ok());
        QTRY_COMPARE(stateOf("one"), QString("stopped"));
        QCOMPARE(lines(1), QJsonArray{zero});
    }

    void whoWritesWithoutEndHoldsUpNobody() {
        launch({shell("one", "exec yes ''"), shell("two", "exec yes ''"), shell("three", "exec yes word")});
        QTRY_COMPARE(call("process.output", {{"name", "three"}, {"lines", 1}})->toArray(),
                     QJsonArray{"word"});
        QElapsedTimer time;
        for (int i = 0; i < 20; ++i) {
            time.start();
            QCOMPARE(stateOf("one"), QString("running"));
            QVERIFY2(time.elapsed() < 5000, saying(time.elapsed())); // the watchdog waits for 10 s
        }
        for (const char *name : {"one", "two", "three"})
            QVERIFY(call("process.stop", {{"name", name}}).ok());
        QTRY_COMPARE(stateOf("three"), QString("stopped"));
    }

    void reportsUse() {
        launch({shell("busy", "while :; do :; done")});
        QTRY_VERIFY(process("busy")["cpu"].toDouble() > 0.1);
        QVERIFY(process("busy")["cpu"].toDouble() < 1.5);
        QVERIFY(process("busy")["memory_bytes"].toDouble() > 100e3);
        QVERIFY(process("busy")["uptime_s"].toDouble() > 0);
    }

    void addAndRemove() {
        launch({});
        QVERIFY(call("process.add", shell("one", "exec sleep 100")).ok());
        QTRY_VERIFY(process("one")["pid"].toInt() > 0);
        const int pid = process("one")["pid"].toInt();
        QVERIFY(call("process.remove", {{"name", "one"}}).ok());
        QVERIFY(process("one").isEmpty());
        QTRY_VERIFY(::kill(pid, 0) != 0);
    }

    void changedEntryIsStartedAnew_data() { falseAndTrue("last", "the first", "the last"); }

    void changedEntryIsStartedAnew() {
        QFETCH(bool, last);
        const auto inOrder = [last](const QJsonObject &one, const QJsonObject &two) {
            return last ? QJsonArray{two, one} : QJsonArray{one, two};
        };
        launch(inOrder(shell("one", "echo first; exec sleep 100"), shell("two", "exec sleep 100")));
        QTRY_COMPARE(call("process.output", {{"name", "one"}})->toArray(), QJsonArray{"first"});
        QTRY_COMPARE(stateOf("two"), QString("running"));
        const int pid = process("two")["pid"].toInt();
        const QJsonArray changed =
            inOrder(shell("one", "echo second; exec sleep 100"), shell("two", "exec sleep 100"));
        QVERIFY(call("settings.set", {{"values", QJsonObject{{"processes", changed}}}}).ok());
        QTRY_COMPARE(call("process.output", {{"name", "one"}, {"lines", 1}})->toArray(),
                     QJsonArray{"second"});
        QCOMPARE(process("two")["pid"].toInt(), pid);
    }

    void aMendedEntryIsStarted_data() {
        const Rows<QString, QString> row("script", "state");
        row("wrong arguments", "exit 2", "failed");
        row("tried again later", "exit 1", "waiting");
    }

    /// Whatever was wrong with it; one that ended in order, or was stopped, stays as it is.
    void aMendedEntryIsStarted() {
        FETCH(QString, script, QString, state);
        launch({shell("one", script), shell("two", "exit 0"), shell("three", script)});
        QTRY_COMPARE(process("two")["last_exit"].toString(), QString("exit status 0"));
        QVERIFY(call("process.stop", {{"name", "three"}}).ok());
        QTRY_COMPARE(stateOf("three"), QString("stopped"));
        QTRY_COMPARE(stateOf("one"), state);
        QTRY_VERIFY(state == "failed" || process("one")["next_start_s"].toDouble() > 1);
        const int tries = process("one")["restarts"].toInt();
        const QString mended = "exec sleep 100";
        const QJsonArray entries{shell("one", mended), shell("two", mended), shell("three", mended)};
        QVERIFY(call("settings.set", {{"values", QJsonObject{{"processes", entries}}}}).ok());
        QTRY_VERIFY(process("one")["pid"].toInt() > 0);
        QTRY_COMPARE(call("daemon.status")->toObject()["state"].toString(), QString("running"));
        QCOMPARE(process("one")["restarts"].toInt(), tries); // by what is new, not by the next try
        QCOMPARE(stateOf("two"), QString("stopped"));
        QCOMPARE(stateOf("three"), QString("stopped"));
    }

    void refusals() {
        launch({shell("one", "exec sleep 100")});
        const auto message = [this](const QString &method, const QJsonObject &params) {
            const auto result = call(method, params);
            return result ? QString("accepted") : result.error().message;
        };
        QVERIFY(message("process.start", {{"name", "none"}}).contains("no process \"none\""));
        QVERIFY(message("process.remove", {{"name", "none"}}).contains("no process \"none\""));
        VERIFY_CONTAINS(message("process.add", shell("one", "true")), "processes.1.name");
        for (const QString &name : {QString(), QString("a\nb"), QString("../a"), QString("a/b"),
                                    QString(100000, 'a'), QString(".a"), QString("a") + QChar(0x1b) + "[2J"})
            QVERIFY2(message("process.add", {{"name", name}}).contains("name"), qPrintable(name.left(20)));
        QVERIFY(message("process.add", {{"name", "x"}, {"port", 70000}}).contains("port"));
    }

    void childrenEndWithAKilledSupervisor_data() {
        const Rows<QString> row("script");
        row("as told", "echo $$ > %1; exec sleep 100");
        row("that ignore SIGTERM", "trap '' TERM; echo $$ > %1; while :; do sleep 0.02; done");
        row("that stand still", "echo $$ > %1; kill -STOP $$; sleep 100");
    }

    void childrenEndWithAKilledSupervisor() {
        QFETCH(QString, script);
        QProcess supervisor;
        const QJsonArray processes{shell("one", script.arg(folder_->filePath("pid")))};
        supervisor.start(
            qEnvironmentVariable("HERMES_BIN") + "/hermes-supervisor",
            {"--listen", "tcp://127.0.0.1:0", "--set",
             "processes=" + QString::fromUtf8(QJsonDocument(processes).toJson(QJsonDocument::Compact))});
        QFile file(folder_->filePath("pid"));
        QTRY_VERIFY(file.size() > 0);
        QVERIFY(file.open(QIODevice::ReadOnly));
        const int pid = file.readAll().trimmed().toInt();
        QCOMPARE(::kill(pid, 0), 0);
        supervisor.kill();
        QVERIFY(supervisor.waitForFinished());
        const auto isGone = [pid] { // or is dead and was not collected
            QFile state(QString("/proc/%1/stat").arg(pid));
            return !state.open(QFile::ReadOnly) || state.readAll().contains(") Z");
        };
        QTRY_VERIFY_WITH_TIMEOUT(isGone(), 20000);
    }

    void runsADaemon() {
        const QString program = qEnvironmentVariable("HERMES_BIN") + "/hermes-scanmatcher";
        launch({QJsonObject{{"name", "scanmatcher"},
                            {"program", program},
                            {"autostart", true},
                            {"arguments", QJsonArray{"--listen", "tcp://127.0.0.1:0"}}}});
        QTRY_COMPARE(stateOf("scanmatcher"), QString("running"));
        QTRY_VERIFY(call("process.output", {{"name", "scanmatcher"}})->toArray().size() > 0);
        QVERIFY(call("process.stop", {{"name", "scanmatcher"}}).ok());
        QTRY_COMPARE(stateOf("scanmatcher"), QString("stopped"));
        QCOMPARE(process("scanmatcher")["last_exit"].toString(), QString("exit status 0"));
    }

private:
    void launch(const QJsonArray &processes) {
        supervisor_ = std::make_unique<Supervisor>();
        const QByteArray json = QJsonDocument(processes).toJson(QJsonDocument::Compact);
        ::launch(*supervisor_, {"processes=" + QString::fromUtf8(json)});
        client_ = std::make_unique<ConnectedClient>(asOwner(supervisor_->info().listen.front()));
    }

    QJsonObject process(const QString &name) {
        const auto list = call("process.list");
        if (list)
            for (const QJsonValue &one : (*list)["processes"].toArray())
                if (one["name"].toString() == name)
                    return one.toObject();
        return {};
    }

    QString stateOf(const QString &name) { return process(name)["state"].toString(); }
    QJsonObject shell(const QString &name, const QString &script, bool autostart = true) const {
        return {{"name", name},
                {"program", "/bin/sh"},
                {"arguments", QJsonArray{"-c", script}},
                {"port", 0},
                {"autostart", autostart}};
    }
    Result<QJsonValue> call(const QString &method, const QJsonObject &params = {}) {
        return client_->callAndWait(method, params);
    }
    QStringList written() const {
        QFile file(folder_->filePath("log"));
        return file.open(QIODevice::ReadOnly) ? QString(file.readAll()).split('\n', Qt::SkipEmptyParts)
                                              : QStringList();
    }

    std::unique_ptr<QTemporaryDir> folder_;
    std::unique_ptr<Supervisor> supervisor_;
    std::unique_ptr<PatientClient> client_;
};
