// Recordings that are refused, that the disk ends, and those that a process left unfinished.
#include "LoggerFixture.h"

using namespace hermes;

/// What a process leaves that is killed while it records.
static QString copyUnfinished(const QString &folder, const QString &root) {
    const QString copy = root + "/cut";
    QDir(root).mkpath("cut");
    for (const QString &name : QDir(folder).entryList(QDir::Files | QDir::Hidden))
        QFile::copy(folder + '/' + name, copy + '/' + name);
    return copy;
}

/// Goes on with an earlier recording in a new file, and fails then.
class TornWriter : public TextWriter {
public:
    bool goesOn() const override { return true; }
    Result<void> begin(const RecordingPlan &plan) override {
        const bool isNew = plan.earlier.isEmpty();
        QFile file(plan.folder + '/' + plan.prefix + (isNew ? "-0001.txt" : "-0002.txt"));
        if (file.open(QIODevice::WriteOnly | QIODevice::NewOnly) && isNew)
            return {};
        return Error(ErrorCode::InputOutput, "torn");
    }
};

class TestRecordingEnds : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void refusalsLeaveNothingBehind() {
        QTemporaryDir root;
        Logger logger(root.path());
        logger.writer.refuse = true;
        QCOMPARE(logger.call("record.start", {{"name", "a"}}).error().message, "refused");
        QVERIFY(!QFile::exists(root.path() + "/a"));
        logger.writer.refuse = false;
        QVERIFY(logger.call("record.start", {{"name", "a"}}).ok());
    }

    void aResumeThatFailsRemovesWhatItMadeAlone() {
        QTemporaryDir root;
        TornWriter writer;
        RecordingSession session(writer);
        RecordingSession::Options options;
        options.logger = "l";
        options.root = root.path();
        QVERIFY(session.begin(options, {"run", "id"}).ok());
        QVERIFY(session.finish(RecordingEnd::Stopped, {}).ok());
        QVERIFY(QFile(root.filePath("run/l-0003.txt")).open(QIODevice::WriteOnly)); // of whomever
        QCOMPARE(session.begin(options, {"run", "id"}).error().message, QString("torn"));
        QCOMPARE(QDir(root.filePath("run")).entryList({"l-*"}), QStringList({"l-0001.txt", "l-0003.txt"}));
        QCOMPARE(Sidecar::read(root.filePath("run/l.json"))->value("ended").toString(), QString("stopped"));
    }

    void lowSpaceIsToldAndEndsTheRecording() {
        QTemporaryDir root;
        Logger logger(root.path());
        QVERIFY(logger.call("record.start", {{"name", "a"}}).ok());
        QVERIFY(!logger.set("free_floor_bytes", 1)); // above free_warn_bytes
        QVERIFY(!logger.set("folder", ""));
        QVERIFY(logger.set("free_warn_bytes", 1e15));
        QTRY_COMPARE(logger.level("disk"), "error");
        QVERIFY(logger.recording.isActive());
        QVERIFY(logger.set("free_floor_bytes", 1e15));
        QTRY_VERIFY(!logger.recording.isActive());
        const Result<QJsonValue> stopped = logger.call("record.stop");
        QCOMPARE(stopped.error().code, int(ErrorCode::InputOutput));
        QCOMPARE(stopped.error().data.toObject().value("path").toString(), root.path() + "/a");
        QCOMPARE(logger.level("recording"), "error");
        QCOMPARE(logger.recording.status().error->code, -32008);
        const QJsonObject sidecar = sidecarOf(root.path() + "/a");
        QCOMPARE(sidecar.value("ended").toString(), "free space");
        QVERIFY(sidecar.value("complete").toBool());
        const Result<QJsonValue> refused = logger.call("record.start", {{"name", "b"}});
        QCOMPARE(refused.error().code, int(ErrorCode::InputOutput));
        QCOMPARE(refused.error().data.toObject().value("path").toString(), root.path() + "/b");
        QVERIFY(!QFile::exists(root.path() + "/b"));
    }

    void aFailedWriterEndsTheRecording() {
        QTemporaryDir root;
        Logger logger(root.path());
        QVERIFY(logger.call("record.start", {{"name", "a"}}).ok());
        RecordingState state;
        state.error = Error(ErrorCode::InputOutput, "the stick was pulled");
        logger.writer.setState(state);
        QTRY_VERIFY(!logger.recording.isActive());
        QCOMPARE(logger.call("record.stop").error().message, "the stick was pulled");
        QCOMPARE(sidecarOf(root.path() + "/a").value("ended").toString(), "failed");
        QVERIFY(!sidecarOf(root.path() + "/a").value("complete").toBool());
        logger.writer.setState({});
        QVERIFY(logger.call("record.start", {{"name", "b"}}).ok());
        QCOMPARE(logger.level("recording"), "ok");
    }

    void aFileThatIsRemovedEndsTheRecording_data() {
        const Rows<bool, bool, bool> row("isReplaced", "isFolderToo", "hasSuccessor");
        row("removed", false, false, false);
        row("replaced", true, false, false);
        row("moved away with its folder", false, true, false);
        row("moved away with its folder, which has a successor", false, true, true);
    }

    void aFileThatIsRemovedEndsTheRecording() {
        FETCH(bool, isReplaced, bool, isFolderToo, bool, hasSuccessor);
        QTemporaryDir root;
        Logger logger(root.path());
        const QString folder = root.path() + "/a", path = folder + "/logger-0001.txt";
        QVERIFY(logger.call("record.start", {{"name", "a"}}).ok());
        if (isFolderToo)
            QVERIFY(QDir().rename(folder, root.path() + "/moved") &&
                    (!hasSuccessor || QDir().mkpath(folder)));
        else
            QVERIFY(QFile::rename(path, root.path() + "/kept")); // so that its inode is not given again
        if (isReplaced)
            put(path, "one\ntwo\nthr");
        QTRY_VERIFY(!logger.recording.isActive());
        const Result<QJsonValue> stopped = logger.call("record.stop");
        QCOMPARE(stopped.error().code, int(ErrorCode::InputOutput));
        const QString named = stopped.error().data.toObject().value("path").toString();
        const bool isFile = named == path && (!isFolderToo || hasSuccessor);
        QVERIFY2(isFile || (isFolderToo && named == folder), qPrintable(named)); // between rename and mkpath
        QVERIFY(stopped.error().message.contains(isReplaced ? "another file" : "removed or moved away"));
        QCOMPARE(logger.level("recording"), "error");
        QCOMPARE(logger.item("recording").message, stopped.error().message);
        if (!isFolderToo || hasSuccessor) {
            QCOMPARE(sidecarOf(folder).value("ended").toString(), "failed");
            QVERIFY(!sidecarOf(folder).value("complete").toBool());
        }
        QVERIFY(logger.call("record.start", {{"name", "b"}}).ok());
        QCOMPARE(logger.level("recording"), "ok");
    }

    void aFileThatIsRemovedJustBeforeTheStopIsMissed() {
        QTemporaryDir root;
        Logger logger(root.path());
        QVERIFY(logger.call("record.start", {{"name", "a"}}).ok());
        QVERIFY(QFile::remove(root.path() + "/a/logger-0001.txt"));
        const Result<QJsonValue> stopped = logger.call("record.stop");
        QVERIFY(!stopped.ok());
        QCOMPARE(stopped.error().data.toObject().value("path").toString(),
                 root.path() + "/a/logger-0001.txt");
        QVERIFY(!sidecarOf(root.path() + "/a").value("complete").toBool());
    }

    void aFileThatIsCutIsMissed_data() {
        const Rows<int> row("told"); // bytes that the writer says it wrote
        row("shorter than it was", 0);
        row("shorter than what was written", 11);
    }

    void aFileThatIsCutIsMissed() {
        QFETCH(int, told);
        QTemporaryDir root;
        Logger logger(root.path());
        const QString path = root.path() + "/a/logger-0001.txt";
        QVERIFY(logger.call("record.start", {{"name", "a"}}).ok());
        RecordingState state;
        state.files.append(QJsonObject{{"name", "logger-0001.txt"}, {"bytes", told}});
        logger.writer.setState(state);
        QVERIFY(QFile::resize(path, 5));
        const Result<QJsonValue> stopped = logger.call("record.stop");
        QVERIFY(!stopped);
        VERIFY_CONTAINS(stopped.error().message, "was cut");
        QCOMPARE(stopped.error().data.toObject().value("path").toString(), path);
        QVERIFY(!sidecarOf(root.path() + "/a").value("complete").toBool());
    }

    void whatLinksLeadToStays_data() {
        const Rows<QString, QString> row("name", "target");
        row("draft of the sidecar", "cut/.logger.json.new", "victim");
        row("room for the sidecar", "cut/.logger.reserve", "victim");
        row("lock", ".logger.lock", "none");
        row("a recording elsewhere", "linked", "cut");
    }

    /// Beside recordings that are completed, and in the folder of one that begins.
    void whatLinksLeadToStays() {
        FETCH(QString, name, QString, target);
        QTemporaryDir root, other, recorded;
        put(other.filePath("victim"), "precious");
        Logger killed(recorded.path());
        const QString folder = folderOf(killed.call("record.start", {{"name", "a"}}));
        const bool isElsewhere = target == "cut";
        copyUnfinished(folder, isElsewhere ? other.path() : root.path());
        QFile::remove(root.filePath(name));
        QVERIFY(QFile::link(other.filePath(target), root.filePath(name)));
        Logger next(root.path());
        const bool isCompleted = QTest::qWaitFor([&] { return next.level("recording") == "warn"; }, 2000);
        QCOMPARE(isCompleted, !isElsewhere);
        next.call("record.start", {{"name", "cut"}, {"session", "s"}});
        QVERIFY(QDir(other.path()).mkdir("empty") &&
                QFile::link(other.filePath("empty"), root.filePath("elsewhere")));
        QVERIFY(!next.call("record.start", {{"name", "elsewhere"}}).ok());
        QVERIFY(QDir(other.path()).rmdir("empty")); // nothing is in it
        QCOMPARE(QDir(other.path()).entryList(QDir::AllEntries | QDir::NoDotAndDotDot),
                 QStringList(isElsewhere ? QStringList{"cut", "victim"} : QStringList{"victim"}));
        QFile victim(other.filePath("victim"));
        QVERIFY(victim.open(QIODevice::ReadOnly));
        QCOMPARE(victim.readAll(), QByteArray("precious"));
        if (isElsewhere)
            QVERIFY(sidecarOf(other.filePath("cut")).value("ended").isNull());
    }

    void aStopWhileItBeginsEndsIt_data() { falseAndTrue("begins", "does not", "begins"); }

    void aStopWhileItBeginsEndsIt() {
        QFETCH(bool, begins);
        QTemporaryDir root;
        Logger logger(root.path());
        logger.writer.hold = true;
        logger.writer.refuse = !begins;
        std::optional<Result<QJsonValue>> started;
        for (const Command &command : logger.recording.commands())
            if (command.name() == "record.start")
                command.execute(QJsonObject{{"name", "a"}}, Call(),
                                Reply([&](const Result<QJsonValue> &result) { started = result; }));
        QTimer::singleShot(50, [&] { logger.writer.hold = false; });
        const Result<QJsonValue> stopped = logger.call("record.stop");
        QVERIFY(started);
        QCOMPARE(started->ok(), begins);
        QVERIFY(!logger.recording.isActive());
        QCOMPARE(stopped.ok(), begins);
        if (begins)
            QCOMPARE(sidecarOf(root.path() + "/a").value("ended").toString(), "stopped");
        else
            QCOMPARE(stopped.error().code, int(ErrorCode::NotReady));
    }

    void aStopOfAnotherSessionEndsNothing() {
        QTemporaryDir root;
        Logger logger(root.path());
        const QJsonObject mine{{"session", "mine"}}, late{{"session", "late"}};
        QCOMPARE(logger.call("record.stop", mine).error().code, int(ErrorCode::NotReady));
        QVERIFY(logger.call("record.start", {{"name", "a"}, {"session", "mine"}}).ok());
        QCOMPARE(logger.call("record.stop", late).error().message, "no such session is being recorded: late");
        QVERIFY(logger.recording.isActive());
        QVERIFY(logger.call("record.stop", mine).ok());
        QVERIFY(logger.call("record.start", {{"name", "b"}, {"session", "late"}}).ok());
        QCOMPARE(logger.call("record.stop", mine).error().code, int(ErrorCode::NotReady));
        QVERIFY(logger.recording.isActive());

        QVERIFY(logger.call("record.stop").ok());
        logger.writer.hold = true; // while one begins
        for (const Command &command : logger.recording.commands())
            if (command.name() == "record.start")
                command.execute(QJsonObject{{"name", "c"}}, Call(), Reply([](const Result<QJsonValue> &) {}));
        QVERIFY(!logger.call("record.stop", late).ok());
        QVERIFY(!logger.call("record.stop", {{"session", ""}}).ok());
        QTimer::singleShot(50, [&] { logger.writer.hold = false; });
        QVERIFY(logger.call("record.stop").ok());
        QVERIFY(!logger.recording.isActive());
    }

    void aRecordingThatWasCutOffIsCompleted() {
        QTemporaryDir root, other;
        Logger killed(root.path());
        const QString folder = folderOf(killed.call("record.start", {{"name", "a"}}));
        const QString cut = copyUnfinished(folder, other.path());
        QVERIFY(QFile::exists(cut + "/.logger.reserve"));
        Logger next(other.path());
        QTRY_COMPARE(sidecarOf(cut).value("ended").toString(), "cut off");
        const QJsonObject sidecar = sidecarOf(cut);
        QVERIFY(!sidecar.value("complete").toBool());
        QCOMPARE(sidecar.value("counts").toObject(), QJsonObject({{"lines", 2}}));
        QCOMPARE(sidecar.value("end").toDouble(), sidecar.value("start").toDouble() + 1);
        QCOMPARE(QDir(cut).entryList(QDir::Files | QDir::Hidden),
                 QStringList({"logger-0001.txt", "logger.json"}));
        QCOMPARE(QFileInfo(cut + "/logger-0001.txt").size(), 8);
        QCOMPARE(next.call("record.list")->toArray()[0].toObject().value("complete"), QJsonValue(false));
        QTRY_COMPARE(next.level("recording"), "warn");
        for (const QString &word : {QString("\"a\" was cut off"), cut, sidecar.value("end_utc").toString()})
            VERIFY_CONTAINS(next.item("recording").message, word);
        QVERIFY(next.call("record.start", {{"name", "b"}}).ok());
        QCOMPARE(next.level("recording"), "ok");
    }

    void aClockThatWasSetDoesNotChangeALength_data() {
        const Rows<double, double> row("renewed_s",
                                       "length_s"); // the files end after a second of the wall clock
        row("as the files say", 0.3, 1);
        row("the clock was set back", 600, 600);
    }

    void aClockThatWasSetDoesNotChangeALength() {
        FETCH(double, renewed_s, double, length_s);
        QTemporaryDir root, other;
        Logger killed(root.path());
        const QString folder = folderOf(killed.call("record.start", {{"name", "a"}}));
        const QString cut = copyUnfinished(folder, other.path());
        QJsonObject sidecar = sidecarOf(cut);
        sidecar["end_mono"] = sidecar["start_mono"].toDouble() + renewed_s;
        QVERIFY(Sidecar::write(cut + "/logger.json", sidecar, false));
        Logger next(other.path());
        QTRY_COMPARE(sidecarOf(cut).value("ended").toString(), "cut off");
        const double told_s = next.call("record.list")->toArray().at(0)["duration_s"].toDouble();
        QVERIFY2(std::abs(told_s - length_s) < 1e-3, qPrintable(QString::number(told_s)));
    }

    void foreignSidecarsAreToldAndLeftAlone_data() {
        const Rows<QByteArray> row("content");
        row("empty", QByteArray());
        row("cut", "{\"format\": \"hermes rec");
        row("array", "[1]");
        row("another format", "{\"format\": \"hermes recording 2\"}");
        row("binary", QByteArray("\0\xff\xfe", 3));
    }

    void foreignSidecarsAreToldAndLeftAlone() {
        QFETCH(QByteArray, content);
        QTemporaryDir root;
        QDir(root.path()).mkpath("a");
        const QString path = root.path() + "/a/logger.json";
        put(path, content);
        Logger logger(root.path());
        QTRY_COMPARE(logger.level("recording"), "warn");
        QVERIFY(logger.item("recording").message.contains(path));
        const QJsonArray list = logger.call("record.list")->toArray();
        QCOMPARE(list.size(), 1);
        QVERIFY(list[0].toObject().value("error").toString().contains(path));
        QVERIFY(!logger.call("record.start", {{"name", "a"}, {"session", "s"}}).ok());
        QCOMPARE(contentOf(path), content);
    }

    void listNamesWhatIsWrongInASidecar() {
        QTemporaryDir root;
        QDir(root.path()).mkpath("a");
        put(root.path() + "/a/logger.json",
            R"({"format": "hermes recording 1", "ended": "stopped", "start": 5, "counts": {"lines": "two"}})");
        Logger logger(root.path());
        const QJsonObject entry = logger.call("record.list")->toArray()[0].toObject();
        QCOMPARE(entry.value("name").toString(), "a");
        QVERIFY(!entry.contains("start"));
        QCOMPARE(entry.value("error").toString(),
                 root.path() + "/a/logger.json: member counts.lines: found text \"two\", expected a number");
    }
};
