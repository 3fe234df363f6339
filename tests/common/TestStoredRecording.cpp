#include "common/Time.h"
#include "common/recording/Sidecar.h"
#include "common/recording/StoredRecording.h"

using namespace hermes;

static QJsonObject usual() {
    return {{"format", Sidecar::format},
            {"start", 1000.5},
            {"end", 1003},
            {"start_mono", 7},
            {"end_mono", 9.5},
            {"ended", "stopped"},
            {"files", QJsonArray{QJsonObject{{"name", "logger-0001.pcap"}}, QJsonObject{{"name", "b"}}}}};
}

static QJsonObject with(const char *member, const QJsonValue &value) {
    QJsonObject content = usual();
    content.insert(member, value);
    return content;
}

/// Recordings that are found to be replayed, and sidecars that somebody has edited.
class TestStoredRecording : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void initTestCase() {
        QDir(folder_.path()).mkpath("run");
        put(folder_.filePath("run/logger-0001.pcap"), "packets");
        put(folder_.filePath("run/b"), "");
        QVERIFY(QFile::link("/etc/passwd", folder_.filePath("run/link")));
        QCOMPARE(::mkfifo(QFile::encodeName(folder_.filePath("run/pipe")).constData(), 0600), 0);
    }

    void tellsFilesAndTime() {
        const Result<StoredRecording> found = find(usual());
        QVERIFY2(found.ok(), found ? "" : qPrintable(found.error().message));
        QCOMPARE(found->start_s, 1000.5);
        QCOMPARE(found->length_s, 2.5);
        QCOMPARE(*found->files(),
                 QStringList({folder_.filePath("run/logger-0001.pcap"), folder_.filePath("run/b")}));
        QVERIFY(find(with("files", QJsonArray()))->files()->isEmpty());
    }

    void aMomentIsTheSameByBothClocks() {
        const double stamp = stampNow(), mono = monotonicNow();
        const Moment hourAgo = Moment::ofMono(mono - 3600), now = Moment::now();
        const double meanwhile_s = monotonicNow() - mono;
        QCOMPARE(hourAgo.mono_ns, std::int64_t((mono - 3600) * 1e9));
        QVERIFY(std::abs(hourAgo.stamp() + 3600 - stamp) <= meanwhile_s + 1e-3);
        QVERIFY(std::abs((now.stamp() - stamp) - (now.mono() - mono)) <= meanwhile_s + 1e-3);
    }

    void lengths_data() {
        const Rows<QJsonObject, double> row("sidecar", "length");
        row("the clock was set meanwhile", with("end", 5000), 2.5);
        row("cut off, without end_mono", with("end_mono", QJsonValue()), 2.5);
        row(
            "of an older version, whose clock was set back",
            [] {
                QJsonObject content = with("end", 1);
                content.remove("start_mono");
                content.remove("end_mono");
                return content;
            }(),
            0.0);
        row("ends before it begins", with("end_mono", 1), 0.0);
        row("of no use", with("end_mono", 1e300), 1e7);
    }

    void lengths() {
        QFETCH(QJsonObject, sidecar);
        QTEST(find(sidecar)->length_s, "length");
    }

    void refusals_data() {
        Rows<QJsonObject, QString, int>("sidecar", "name", "code");
        const auto row = [](const char *title, const QJsonObject &sidecar, ErrorCode code,
                            const char *name = "run") {
            QTest::newRow(title) << sidecar << name << int(code);
        };
        row("being recorded", with("ended", QJsonValue()), ErrorCode::NotReady);
        row("another name", usual(), ErrorCode::InputOutput, "walk");
        row("a path", usual(), ErrorCode::InvalidParams, "../run");
        row("no sidecar", with("format", "x"), ErrorCode::InputOutput);
        row("no start", with("start", "now"), ErrorCode::InputOutput);
        row("a start beyond all stamps", with("start", 1e18), ErrorCode::InputOutput);
        row("a file elsewhere", with("files", QJsonArray{QJsonObject{{"name", "../secret"}}}),
            ErrorCode::InputOutput);
        row("a pipe", with("files", QJsonArray{QJsonObject{{"name", "pipe"}}}), ErrorCode::InputOutput);
        row("a link out", with("files", QJsonArray{QJsonObject{{"name", "link"}}}), ErrorCode::InputOutput);
        row("a file that is missing", with("files", QJsonArray{QJsonObject{{"name", "c"}}}),
            ErrorCode::InputOutput);
        row("a file without name", with("files", QJsonArray{1}), ErrorCode::InputOutput);
    }

    void refusals() {
        FETCH(QJsonObject, sidecar, QString, name);
        const Result<StoredRecording> found = find(sidecar, name);
        const Error error = !found ? found.error() : found->files() ? Error() : found->files().error();
        QTEST(error.code, "code");
        VERIFY_CONTAINS(error.message, name.section('/', -1));
    }

private:
    Result<StoredRecording> find(const QJsonObject &content, const QString &name = "run") {
        if (!Sidecar::write(Sidecar::path(folder_.filePath("run"), "logger"), content, false))
            qFatal("the sidecar cannot be written");
        return StoredRecording::find(folder_.path(), name, "logger");
    }

    QTemporaryDir folder_;
};
