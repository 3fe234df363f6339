// Files of maps: large ones, a disk that takes its time, a matcher that is killed while it writes.
#include "MatcherFixture.h"
#include "tests/support/PatientClient.h"

#include "tests/support/LoopWatch.h"
#include "vectorlib/io/MapCsv.h"

#include <sys/syscall.h>

using namespace hermes;

static std::atomic<bool> diskHolds{false}; // what is in slow.csv

static void writeMap(const QString &path, int edges) {
    std::vector<vectorlib::MapEdge> map;
    for (int i = 0; i < edges; ++i) {
        const double x = 2.5 * (i % 500) + 1e-9 * i, y = 2.5 * (i / 500) + 0.123456789;
        vectorlib::EdgeRaw2D edge;
        edge.segment = {{x, y}, {x + 1.3, y + 1.1}};
        edge.sums.n = 100;
        edge.sums.mean = {x + 0.65, y + 0.55};
        edge.sums.xx = edge.sums.xy = edge.sums.yy = 15.000001 + 1e-7 * i;
        edge.sigma = 0.0123456789;
        map.emplace_back(i, edge, 3);
    }
    std::ofstream out(path.toStdString());
    vectorlib::writeMapCsv(out, map);
    QVERIFY(out.flush().good());
}

/// In place of that of the system, for all of this process.
extern "C" ssize_t read(int file, void *to, size_t size) {
    char path[4096] = {};
    const auto length = ::readlink(("/proc/self/fd/" + std::to_string(file)).c_str(), path, sizeof(path) - 1);
    while (length > 0 && diskHolds && QByteArray(path).endsWith("/slow.csv"))
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return ::syscall(SYS_read, file, to, size);
}

class TestMapFiles : public QObject, MatcherFixture {
    Q_OBJECT
private Q_SLOTS:
    void init() { setUp(); }
    void cleanup() { tearDown(); }

    void largeMapsHoldNothingUp() {
        const int edges = std::max(150000 / slowness, qEnvironmentVariableIntValue("HERMES_MAP_EDGES"));
        writeMap(folder->filePath("large.csv"), edges);
        LoopWatch loop;
        const auto within = [&](const char *what) {
            const double ms = loop.longestCpu_ms();
            qInfo("%s of %d edges: the event loop was busy for at most %.1f ms", what, edges, ms);
            loop.restart();
            return ms < 50 * slowness;
        };
        loop.restart();
        QCOMPARE(answer("map.load", {{"path", "large.csv"}})["segments"].toInt(), edges);
        QVERIFY(within("map.load"));
        QCOMPARE(answer("map.save", {{"path", "saved.csv"}})["segments"].toInt(), edges);
        QVERIFY(within("map.save"));
        answer("map.export", {{"path", "saved.svg"}, {"format", "svg"}});
        QVERIFY(within("map.export"));
        answer("map.clear", {});
        QVERIFY(within("map.clear"));
        QCOMPARE(contentOf(folder->filePath("saved.csv")), contentOf(folder->filePath("large.csv")));
    }

    void aSlowDiskHoldsNothingUp() {
        writeMap(folder->filePath("slow.csv"), 10);
        diskHolds = true;
        const auto release = qScopeGuard([] { diskHolds = false; });
        std::optional<Result<QJsonValue>> loaded;
        client_->call("map.load", QJsonObject{{"path", "slow.csv"}},
                      [&](const Result<QJsonValue> &result) { loaded = result; });
        for (int i = 0; i < 20; ++i)
            QVERIFY(call("daemon.info").contains("name"));
        QVERIFY(!loaded);
        QCOMPARE(call("matcher.state")["map_segments"].toInt(), 0);
        diskHolds = false;
        QTRY_VERIFY(loaded);
        QCOMPARE((*loaded)->toObject()["segments"].toInt(), 10);
        QCOMPARE(call("matcher.state")["map_segments"].toInt(), 10);
    }

    void noMapIsWrittenIntoAJournal() {
        for (const QString format : {"csv", "svg"}) {
            const auto error =
                failure("map.export", {{"path", "a.journal"}, {"format", format}, {"force", true}});
            QVERIFY2(error.is(ErrorCode::InvalidParams), qPrintable(error.message));
            QVERIFY2(error.message.contains("a.journal"), qPrintable(error.message));
        }
        QVERIFY(failure("map.save", {{"path", "a.journal"}}).is(ErrorCode::InvalidParams));
        QVERIFY(!QFileInfo::exists(folder->filePath("a.journal")));
    }

    void filesAreWrittenInTheOrderOfTheCommands() {
        writeMap(folder->filePath("ten.csv"), 10);
        writeMap(folder->filePath("five.csv"), 5);
        const auto send = [&](const char *method, const QJsonObject &params) {
            client_->call(method, params, [](const Result<QJsonValue> &) {});
        };
        send("map.load", {{"path", "ten.csv"}});
        send("map.save", {{"path", "a.csv"}});
        send("map.load", {{"path", "five.csv"}});
        send("map.save", {{"path", "a.csv"}, {"force", true}});
        send("map.save", {{"path", "b.csv"}});
        send("map.clear", {});
        QCOMPARE(answer("map.export", {{"path", "c.csv"}, {"format", "csv"}})["segments"].toInt(), 0);
        QCOMPARE(contentOf(folder->filePath("a.csv")), contentOf(folder->filePath("five.csv")));
        QCOMPARE(contentOf(folder->filePath("b.csv")), contentOf(folder->filePath("five.csv")));
    }

    void aMatcherKilledWhileItWritesLeavesAWholeMap() {
        writeMap(folder->filePath("new.csv"), 20000);
        const QByteArray after = contentOf(folder->filePath("new.csv"));
        const QString path = folder->filePath("map.csv");
        const int last = 6;
        for (int trial = 0; trial <= last; ++trial) {
            QFile::remove(path);
            writeMap(path, 10);
            const QByteArray before = contentOf(path);
            QProcess process;
            process.setProcessChannelMode(QProcess::MergedChannels);
            process.start(qEnvironmentVariable("HERMES_BIN") + "/hermes-scanmatcher",
                          {"--listen", "tcp://127.0.0.1:0", "--set", "map.folder=" + folder->path()});
            QVERIFY(process.waitForStarted());
            QString log;
            const QRegularExpression listens("127.0.0.1:(\\d+),");
            QTRY_VERIFY((log += process.readAll()).contains(listens));
            ConnectedClient other(asOwner("127.0.0.1:" + listens.match(log).captured(1)));
            QVERIFY(other.callAndWait("map.load", QJsonObject{{"path", "new.csv"}}).ok());
            bool saved = false;
            other.call("map.save", QJsonObject{{"path", "map.csv"}, {"force", true}},
                       [&](const Result<QJsonValue> &result) { saved = result.ok(); });
            if (trial < last)
                QTest::qWait(8 * trial); // somewhere between the call and the answer
            else
                QTRY_VERIFY(saved);
            process.kill();
            QVERIFY(process.waitForFinished());
            const QByteArray found = contentOf(path);
            QVERIFY2(found == after || (found == before && !saved),
                     saying("%1: %2 bytes", trial, found.size()));
        }
    }

private:
    /// Calls, and waits in the event loop for the result.
    QJsonObject answer(const QString &method, const QJsonObject &params) {
        std::optional<Result<QJsonValue>> got;
        client_->call(method, params, [&](const Result<QJsonValue> &result) { got = result; });
        if (!QTest::qWaitFor([&] { return got.has_value(); }, 60000) || !got->ok())
            qFatal("%s: %s", qPrintable(method), got ? qPrintable(got->error().message) : "no answer");
        return (*got)->toObject();
    }
};
