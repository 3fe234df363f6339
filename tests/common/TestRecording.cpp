#include "LoggerFixture.h"
#include "protocol/wire/Fields.h"

using namespace hermes;

class TestRecording : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void recordsAndDescribes() {
        QTemporaryDir root;
        Logger logger(root.path() + "/recordings");
        QCOMPARE(logger.call("record.stop").error().code, int(ErrorCode::NotReady));
        qputenv("HERMES_ROBOT", "11111111-2222-4333-8444-555555555555 rover");
        RecordingState state;
        state.counts = {{"lines", 2}};
        state.losses = {{"lines", 0}};
        state.files = {QJsonObject{{"name", "logger-0001.txt"}}};
        logger.writer.setState(state);
        const Result<QJsonValue> started = logger.call("record.start", {{"name", "drive 1"}});
        QVERIFY(started.ok());
        QCOMPARE(folderOf(started), root.path() + "/recordings/drive 1");
        QCOMPARE(logger.call("record.start", {{"name", "other"}}).error().code, int(ErrorCode::NotReady));
        QJsonObject sidecar = sidecarOf(folderOf(started));
        QVERIFY(sidecar.value("ended").isNull() && !sidecar.value("complete").toBool());
        QVERIFY(logger.call("record.stop").ok());
        sidecar = sidecarOf(folderOf(started));
        QCOMPARE(sidecar.value("ended").toString(), "stopped");
        QVERIFY(sidecar.value("complete").toBool());
        QCOMPARE(sidecar.value("counts"), asJson(state.counts));
        QCOMPARE(sidecar.value("files").toArray(), state.files);
        QCOMPARE(sidecar.value("settings").toObject(), logger.settings.values());
        QCOMPARE(sidecar.value("session"), started->toObject().value("session"));
        QCOMPARE(sidecar.value("robot").toObject().value("name").toString(), QString("rover"));
        QVERIFY(sidecar.value("end").toDouble() >= sidecar.value("start").toDouble());
        QVERIFY(sidecar.value("end_mono").toDouble() >= sidecar.value("start_mono").toDouble());
        QCOMPARE(QDir(folderOf(started)).entryList(QDir::Files | QDir::Hidden),
                 QStringList({"logger-0001.txt", "logger.json"}));
        const QJsonArray list = logger.call("record.list")->toArray();
        QCOMPARE(list.size(), 1);
        QCOMPARE(list[0].toObject().value("name").toString(), "drive 1");
        QVERIFY(list[0].toObject().value("complete").toBool());
    }

    void namesAreChecked_data() {
        const Rows<QString, bool> row("name", "fine");
        row("plain", "run1", true);
        row("umlaut",
            "Gew\xc3\xa4"
            "chshaus 7",
            true);
        row("longest", QString(100, 'a'), true);
        row("too long", QString(101, 'a'), false);
        row("too long in UTF-8", QString(51, QChar(0xE4)), false);
        row("empty", "", false);
        row("up", "..", false);
        row("hidden", ".a", false);
        row("path", "a/b", false);
        row("absolute", "/a", false);
        row("line", "a\nb", false);
        row("NUL", QString::fromLatin1("a\0b", 3), false);
    }

    void namesAreChecked() {
        FETCH(QString, name, bool, fine);
        QTemporaryDir root;
        Logger logger(root.path() + "/recordings");
        for (const QJsonObject &params :
             {QJsonObject{{"name", name}}, QJsonObject{{"name", "b"}, {"session", name}}}) {
            const Result<QJsonValue> answer = logger.call("record.start", params);
            QCOMPARE(answer.ok(), fine);
            if (fine)
                QVERIFY(logger.call("record.stop").ok());
            else
                QCOMPARE(answer.error().code, int(ErrorCode::InvalidParams));
        }
        QCOMPARE(QDir(root.path()).entryList(QDir::Dirs | QDir::NoDotAndDotDot).size(), fine ? 1 : 0);
    }

    void nothingIsOverwritten() {
        QTemporaryDir root;
        Logger logger(root.path());
        for (int i = 0; i < 2; ++i) {
            const Result<QJsonValue> answer = logger.call("record.start", {{"name", "a"}, {"session", "s"}});
            QCOMPARE(answer.ok(), i == 0);
            if (i == 0)
                QVERIFY(logger.call("record.stop").ok());
            else
                QCOMPARE(answer.error().data.toObject().value("path").toString(), root.path() + "/a");
        }
        put(root.path() + "/file", "x");
        QCOMPARE(logger.call("record.start", {{"name", "file"}}).error().code, int(ErrorCode::InputOutput));
        QDir(root.path()).mkpath("foreign");
        put(root.path() + "/foreign/notes", "x");
        QCOMPARE(logger.call("record.start", {{"name", "foreign"}}).error().code,
                 int(ErrorCode::InputOutput));
    }

    void lossesAreShown() {
        QTemporaryDir root;
        Logger logger(root.path());
        QVERIFY(logger.call("record.start", {{"name", "a"}}).ok());
        RecordingState state;
        state.losses = {{"queue", 3}};
        logger.writer.setState(state);
        QTRY_COMPARE(logger.level("recording"), "warn");
        QTRY_COMPARE(sidecarOf(root.path() + "/a").value("losses"), asJson(state.losses)); // while it goes on
    }

    void closingEndsTheRecording() {
        QTemporaryDir root;
        Logger logger(root.path());
        QVERIFY(logger.call("record.start", {{"name", "a"}}).ok());
        logger.recording.close();
        QCOMPARE(sidecarOf(root.path() + "/a").value("ended").toString(), "shut down");
    }

    /// Its free space is read in a thread: until then nothing is wrong.
    void diskIsWellFromTheStart() {
        QTemporaryDir root;
        Logger logger(root.path() + "/recordings");
        QCOMPARE(logger.level("disk"), "ok");
        QTRY_VERIFY(logger.recording.status().freeBytes.has_value());
        QCOMPARE(logger.level("disk"), "ok");
    }
};
