// Several loggers that record at the same time, together or in each other's way.
#include "LoggerFixture.h"

#include <future>

using namespace hermes;

class TestSharedSession : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void loggersShareASession() {
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

    void aLoggerThatGivesUpLeavesTheFolderToOthers() {
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
            QVERIFY2(begun.ok(), saying("%1: %2", i, begun.error().message));
            QVERIFY(records.finish(RecordingEnd::Stopped, {}).ok());
            QCOMPARE(QDir(root.path() + '/' + name.name).entryList(QDir::Files | QDir::Hidden),
                     QStringList({"logger-0001.txt", "logger.json"}));
        }
    }

    void twoOfAKindDoNotDisturbEachOther() {
        QTemporaryDir root;
        Logger one(root.path());
        const Result<QJsonValue> started = one.call("record.start", {{"name", "one"}});
        QVERIFY(started.ok());
        Logger two(root.path());
        const Result<QJsonValue> refused = two.call("record.start", {{"name", "two"}});
        QCOMPARE(refused.error().code, int(ErrorCode::NotReady));
        VERIFY_CONTAINS(refused.error().message, "record.folder");
        QCOMPARE(two.level("recording"), "warn");
        QVERIFY(
            sidecarOf(folderOf(started)).value("ended").isNull()); // it is not taken for one that was cut off
        QVERIFY(one.call("record.stop").ok());
        QVERIFY(two.call("record.start", {{"name", "two"}}).ok());
    }
};
