#include "common/recording/Recording.h"
#include "common/recording/RecordingSession.h"
#include "common/recording/Sidecar.h"

#include <QTemporaryDir>
#include <QtTest>

#include <atomic>
#include <future>
#include <mutex>
#include <thread>

using namespace hermes;

namespace {

/// Writes one file of text, and fails when told to.
class TextWriter : public RecordingWriter {
public:
    Result<void> begin(const RecordingPlan &plan) override {
        plan_ = plan;
        file_.setFileName(plan.folder + '/' + plan.prefix + "-0001.txt");
        if (refuse || !file_.open(QIODevice::WriteOnly | QIODevice::NewOnly))
            return Error(ErrorCode::InputOutput, "refused");
        file_.write("one\ntwo\nthr");
        file_.flush();
        return {};
    }
    void end() override { file_.close(); }
    RecordingState state() const override {
        const std::lock_guard<std::mutex> lock(mutex_);
        return state_;
    }
    /// Keeps whole lines.
    Result<void> repair(const RecordingPlan &plan, QJsonObject &sidecar) override {
        QFile file(plan.folder + '/' + plan.prefix + "-0001.txt");
        if (!file.open(QIODevice::ReadWrite))
            return Error(ErrorCode::InputOutput, file.errorString());
        const QByteArray text = file.readAll();
        const int whole = text.lastIndexOf('\n') + 1;
        file.resize(whole);
        sidecar.insert("counts", QJsonObject{{"lines", text.count('\n')}});
        sidecar.insert("bytes", whole);
        sidecar.insert("end", sidecar.value("start").toDouble() + 1);
        return {};
    }
    void setState(const RecordingState &state) {
        const std::lock_guard<std::mutex> lock(mutex_);
        state_ = state;
    }

    bool refuse = false;

private:
    RecordingPlan plan_;
    QFile file_;
    mutable std::mutex mutex_;
    RecordingState state_;
};

/// A logger without a daemon around it.
struct Logger {
    explicit Logger(const QString &root, const QString &name = "logger")
        : recording(name, settings, health, writer) {
        for (const Field &field : Recording::settingFields())
            settings.declare(field);
        settings.addRule(Recording::checkSettings);
        set("folder", root);
        set("free_floor_bytes", 0);
        set("free_warn_bytes", 0);
        recording.open();
    }
    bool set(const char *name, const QJsonValue &value) {
        return settings.set({{"record", QJsonObject{{name, value}}}}).ok();
    }
    Result<QJsonValue> call(const QString &method, const QJsonObject &params = {}) {
        Result<QJsonValue> answer = QJsonValue();
        bool answered = false;
        for (const Command &command : recording.commands())
            if (command.name() == method)
                command.execute(params, Call(), Reply([&](Result<QJsonValue> result) {
                                    answer = std::move(result);
                                    answered = true;
                                }));
        if (!QTest::qWaitFor([&] { return answered; }))
            qFatal("no answer came");
        return answer;
    }
    QJsonObject item(const QString &name) {
        for (const QJsonValue &item : health.toJson())
            if (item.toObject().value("name") == name)
                return item.toObject();
        return {};
    }
    QString level(const QString &name) { return item(name).value("level").toString(); }

    Settings settings;
    Health health{nullptr};
    TextWriter writer;
    Recording recording;
};

QString folderOf(const Result<QJsonValue> &answer) {
    return answer->toObject().value("folder").toString();
}

QJsonObject sidecarOf(const QString &folder, const QString &logger = "logger") {
    const Result<QJsonObject> sidecar = Sidecar::read(Sidecar::path(folder, logger));
    return sidecar ? *sidecar : QJsonObject{{"unreadable", sidecar.error().message}};
}

void put(const QString &path, const QByteArray &bytes) {
    QFile file(path);
    QVERIFY(file.open(QIODevice::WriteOnly));
    QCOMPARE(file.write(bytes), qint64(bytes.size()));
}

/// What a process leaves that is killed while it records.
QString copyUnfinished(const QString &folder, const QString &root) {
    const QString copy = root + "/cut";
    QDir(root).mkpath("cut");
    for (const QString &name : QDir(folder).entryList(QDir::Files | QDir::Hidden))
        QFile::copy(folder + '/' + name, copy + '/' + name);
    return copy;
}

} // namespace

class TestRecording : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void recordsAndDescribes();
    void namesAreChecked_data();
    void namesAreChecked();
    void nothingIsOverwritten();
    void loggersShareASession();
    void aLoggerThatGivesUpLeavesTheFolderToOthers();
    void twoOfAKindDoNotDisturbEachOther();
    void refusalsLeaveNothingBehind();
    void lowSpaceIsToldAndEndsTheRecording();
    void aFailedWriterEndsTheRecording();
    void lossesAreShown();
    void aRecordingThatWasCutOffIsCompleted();
    void foreignSidecarsAreToldAndLeftAlone_data();
    void foreignSidecarsAreToldAndLeftAlone();
    void closingEndsTheRecording();
};

void TestRecording::recordsAndDescribes() {
    QTemporaryDir root;
    Logger logger(root.path() + "/recordings");
    QCOMPARE(logger.call("record.stop").error().code, int(ErrorCode::NotReady));
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
    QCOMPARE(sidecar.value("counts").toObject(), state.counts);
    QCOMPARE(sidecar.value("files").toArray(), state.files);
    QCOMPARE(sidecar.value("settings").toObject(), logger.settings.values());
    QCOMPARE(sidecar.value("session"), started->toObject().value("session"));
    QVERIFY(sidecar.value("end").toDouble() >= sidecar.value("start").toDouble());
    QVERIFY(sidecar.value("end_mono").toDouble() >= sidecar.value("start_mono").toDouble());
    QCOMPARE(QDir(folderOf(started)).entryList(QDir::Files | QDir::Hidden),
             QStringList({"logger-0001.txt", "logger.json"}));
    const QJsonArray list = logger.call("record.list")->toArray();
    QCOMPARE(list.size(), 1);
    QCOMPARE(list[0].toObject().value("name").toString(), "drive 1");
    QVERIFY(list[0].toObject().value("complete").toBool());
}

void TestRecording::namesAreChecked_data() {
    QTest::addColumn<QString>("name");
    QTest::addColumn<bool>("fine");
    QTest::newRow("plain") << "run1" << true;
    QTest::newRow("umlaut") << QString::fromUtf8("Gew\xc3\xa4"
                                                 "chshaus 7")
                            << true;
    QTest::newRow("longest") << QString(100, 'a') << true;
    QTest::newRow("too long") << QString(101, 'a') << false;
    QTest::newRow("too long in UTF-8") << QString(51, QChar(0xE4)) << false;
    QTest::newRow("empty") << "" << false;
    QTest::newRow("up") << ".." << false;
    QTest::newRow("hidden") << ".a" << false;
    QTest::newRow("path") << "a/b" << false;
    QTest::newRow("absolute") << "/a" << false;
    QTest::newRow("line") << "a\nb" << false;
    QTest::newRow("NUL") << QString::fromLatin1("a\0b", 3) << false;
}

void TestRecording::namesAreChecked() {
    QFETCH(QString, name);
    QFETCH(bool, fine);
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

void TestRecording::nothingIsOverwritten() {
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
    QCOMPARE(logger.call("record.start", {{"name", "foreign"}}).error().code, int(ErrorCode::InputOutput));
}

void TestRecording::loggersShareASession() {
    QTemporaryDir root;
    Logger a(root.path(), "a"), b(root.path(), "b"), c(root.path(), "c");
    const QJsonObject params{{"name", "run1"}, {"session", "s1"}};
    const Result<QJsonValue> first = a.call("record.start", params);
    QVERIFY(first.ok());
    QCOMPARE(folderOf(b.call("record.start", params)), folderOf(first));
    QCOMPARE(c.call("record.start", {{"name", "run1"}, {"session", "s2"}}).error().code,
             int(ErrorCode::InputOutput));
    QCOMPARE(c.call("record.start", {{"name", "run1"}}).error().code, int(ErrorCode::InputOutput));
    QVERIFY(a.call("record.stop").ok());
    QVERIFY(b.call("record.stop").ok());
    QCOMPARE(sidecarOf(folderOf(first), "a").value("session").toString(), "s1");
    QCOMPARE(sidecarOf(folderOf(first), "b").value("session").toString(), "s1");
}

void TestRecording::aLoggerThatGivesUpLeavesTheFolderToOthers() {
    QTemporaryDir root;
    TextWriter refusing, writer;
    refusing.refuse = true;
    RecordingSession givesUp(refusing), records(writer);
    for (int i = 0; i < 50; ++i) {
        const SessionName name{QString("run%1").arg(i), "s"};
        std::atomic<int> ready{0};
        const auto begin = [&](RecordingSession &session, const QString &logger) {
            RecordingSession::Options options;
            options.logger = logger;
            options.root = root.path();
            for (++ready; ready < 2;)
                std::this_thread::yield();
            return session.begin(options, name);
        };
        auto other = std::async(std::launch::async, [&] { return begin(givesUp, "other"); });
        const Result<void> begun = begin(records, "logger");
        QCOMPARE(other.get().error().message, QString("refused"));
        QVERIFY2(begun.ok(), qPrintable(QString("%1: %2").arg(i).arg(begun.error().message)));
        QVERIFY(records.finish(RecordingEnd::Stopped, {}).ok());
        QCOMPARE(QDir(root.path() + '/' + name.name).entryList(QDir::Files | QDir::Hidden),
                 QStringList({"logger-0001.txt", "logger.json"}));
    }
}

void TestRecording::twoOfAKindDoNotDisturbEachOther() {
    QTemporaryDir root;
    Logger one(root.path());
    const Result<QJsonValue> started = one.call("record.start", {{"name", "one"}});
    QVERIFY(started.ok());
    Logger two(root.path());
    const Result<QJsonValue> refused = two.call("record.start", {{"name", "two"}});
    QCOMPARE(refused.error().code, int(ErrorCode::NotReady));
    QVERIFY2(refused.error().message.contains("record.folder"), qPrintable(refused.error().message));
    QCOMPARE(two.level("recording"), "warn");
    QVERIFY(sidecarOf(folderOf(started)).value("ended").isNull()); // it is not taken for one that was cut off
    QVERIFY(one.call("record.stop").ok());
    QVERIFY(two.call("record.start", {{"name", "two"}}).ok());
}

void TestRecording::refusalsLeaveNothingBehind() {
    QTemporaryDir root;
    Logger logger(root.path());
    logger.writer.refuse = true;
    QCOMPARE(logger.call("record.start", {{"name", "a"}}).error().message, "refused");
    QVERIFY(!QFile::exists(root.path() + "/a"));
    logger.writer.refuse = false;
    QVERIFY(logger.call("record.start", {{"name", "a"}}).ok());
}

void TestRecording::lowSpaceIsToldAndEndsTheRecording() {
    QTemporaryDir root;
    Logger logger(root.path());
    QVERIFY(logger.call("record.start", {{"name", "a"}}).ok());
    QVERIFY(!logger.set("free_floor_bytes", 1)); // above free_warn_bytes
    QVERIFY(logger.set("free_warn_bytes", 1e15));
    QTRY_COMPARE(logger.level("disk"), "error");
    QVERIFY(logger.recording.isActive());
    QVERIFY(logger.set("free_floor_bytes", 1e15));
    QTRY_VERIFY(!logger.recording.isActive());
    const Result<QJsonValue> stopped = logger.call("record.stop");
    QCOMPARE(stopped.error().code, int(ErrorCode::InputOutput));
    QCOMPARE(stopped.error().data.toObject().value("path").toString(), root.path() + "/a");
    QCOMPARE(logger.level("recording"), "error");
    QCOMPARE(logger.recording.status().value("error").toObject().value("code").toInt(), -32008);
    const QJsonObject sidecar = sidecarOf(root.path() + "/a");
    QCOMPARE(sidecar.value("ended").toString(), "free space");
    QVERIFY(sidecar.value("complete").toBool());
    const Result<QJsonValue> refused = logger.call("record.start", {{"name", "b"}});
    QCOMPARE(refused.error().code, int(ErrorCode::InputOutput));
    QCOMPARE(refused.error().data.toObject().value("path").toString(), root.path() + "/b");
    QVERIFY(!QFile::exists(root.path() + "/b"));
}

void TestRecording::aFailedWriterEndsTheRecording() {
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

void TestRecording::lossesAreShown() {
    QTemporaryDir root;
    Logger logger(root.path());
    QVERIFY(logger.call("record.start", {{"name", "a"}}).ok());
    RecordingState state;
    state.losses = {{"queue", 3}};
    logger.writer.setState(state);
    QTRY_COMPARE(logger.level("recording"), "warn");
    QTRY_COMPARE(sidecarOf(root.path() + "/a").value("losses").toObject(), state.losses); // while it goes on
}

void TestRecording::aRecordingThatWasCutOffIsCompleted() {
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
}

void TestRecording::foreignSidecarsAreToldAndLeftAlone_data() {
    QTest::addColumn<QByteArray>("content");
    QTest::newRow("empty") << QByteArray();
    QTest::newRow("cut") << QByteArray("{\"format\": \"hermes rec");
    QTest::newRow("array") << QByteArray("[1]");
    QTest::newRow("another format") << QByteArray("{\"format\": \"hermes recording 2\"}");
    QTest::newRow("binary") << QByteArray("\0\xff\xfe", 3);
}

void TestRecording::foreignSidecarsAreToldAndLeftAlone() {
    QFETCH(QByteArray, content);
    QTemporaryDir root;
    QDir(root.path()).mkpath("a");
    const QString path = root.path() + "/a/logger.json";
    put(path, content);
    Logger logger(root.path());
    QTRY_COMPARE(logger.level("recording"), "warn");
    QVERIFY(logger.item("recording").value("message").toString().contains(path));
    const QJsonArray list = logger.call("record.list")->toArray();
    QCOMPARE(list.size(), 1);
    QVERIFY(list[0].toObject().value("error").toString().contains(path));
    QVERIFY(!logger.call("record.start", {{"name", "a"}, {"session", "s"}}).ok());
    QFile file(path);
    QVERIFY(file.open(QIODevice::ReadOnly));
    QCOMPARE(file.readAll(), content);
}

void TestRecording::closingEndsTheRecording() {
    QTemporaryDir root;
    Logger logger(root.path());
    QVERIFY(logger.call("record.start", {{"name", "a"}}).ok());
    logger.recording.close();
    QCOMPARE(sidecarOf(root.path() + "/a").value("ended").toString(), "stopped");
}

QTEST_GUILESS_MAIN(TestRecording)
#include "TestRecording.moc"
