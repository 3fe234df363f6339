#include "common/capture/PcapWriter.h"
#include "daemons/recorder/Recorder.h"
#include "daemons/recorder/SessionExport.h"
#include "protocol/mcap/Reader.h"
#include "protocol/messages/Motion.h"
#include "protocol/messages/Turns.h"
#include "tests/support/DaemonClient.h"
#include "tests/support/FileSizeLimit.h"
#include "tests/support/Rows.h"
#include "tests/support/SessionFolder.h"
#include "tests/support/Texts.h"
#include "vectorlib/io/CarmenLog.h"

#include <sstream>
#include <sys/stat.h>

using namespace hermes;
using namespace hermes::recorder;

class TestSessionExport : public QObject, DaemonClient {
    Q_OBJECT

    SessionFolder folder_;

    Result<SessionFiles> exported(const QString &format, const QStringList &topics = {}) const {
        auto session = SessionReader::open(folder_.path());
        return session ? exportSession(*session, format, topics, folder_.filePath("export"))
                       : session.error();
    }
    /// What the only file of an export has.
    QByteArray textOf(const QString &format, const QStringList &topics) const {
        const auto files = exported(format, topics);
        if (!files)
            return files.error().message.toUtf8();
        return files->paths.size() == 1 ? contentOf(files->paths.first())
                                        : "files: " + files->paths.join(", ").toUtf8();
    }

    /// A packet each.
    static void writeCapture(const QString &path, const std::vector<std::string> &payloads) {
        PcapWriter writer;
        QVERIFY(writer.open(path.toStdString()));
        for (const std::string &payload : payloads) {
            const auto *bytes = reinterpret_cast<const std::uint8_t *>(payload.data());
            const auto stamp_ns = std::int64_t((SessionFolder::start + 0.5) * 1e9);
            QVERIFY(writer.write({stamp_ns, 1, 2, 2368, 2368, bytes, payload.size()}));
        }
        QVERIFY(writer.close());
    }

private Q_SLOTS:
    void initTestCase() {
        for (int i = 0; i < 10; ++i) {
            folder_.add(0.1 * i, "motorcontrol/odometry",
                        OdometryMessage{{0.1 * i, 0, 0.5}, {1, 0, 0}, {}, 7});
            folder_.add(0.1 * i, "scanmatcher/pose",
                        QByteArray(R"({"x":1,"y":2,"theta":3.141592653589793})"));
            ScanMessage scan;
            scan.header.stamp = SessionFolder::start + 0.1 * i;
            scan.header.duration_s = 0.1;
            scan.header.rays = 360;
            for (int degree = -170; degree < 170; degree += 2) {
                scan.x.push_back(float(5 * std::cos(degree * vectorlib::pi / 180)));
                scan.y.push_back(float(5 * std::sin(degree * vectorlib::pi / 180)));
            }
            folder_.add(0.1 * i + 0.05, "velodynelogger/scan2d", scan);
            if (i == 4) {
                folder_.add(0.5, "x/../../y", compactJson(QJsonObject{{"a", "q\"u,"}, {"b", QJsonValue()}}),
                            R"({"type":"object","properties":{"a":{},"b":{}}})");
                folder_.nextFile();
                folder_.add(0.5, "x/../../y", QByteArray(R"([1,2])"), "{}");
            }
        }
        folder_.add(2, "scanmatcher/settings", QByteArray(R"({"sensor":{"x_m":0.2,"y_m":0,"theta_rad":0}})"));
        folder_.finish();
    }

    void fieldsAreColumns() {
        const QList<QByteArray> rows = textOf("csv", {"motorcontrol/odometry"}).trimmed().split('\n');
        QCOMPARE(rows.size(), 11);
        QCOMPARE(rows[0],
                 QByteArray(
                     "stamp,t_s,seq,covariance,mono,pose.theta,pose.x,pose.y,twist.omega,twist.vx,twist.vy"));
        QCOMPARE(rows[2],
                 QByteArray("1700000000.100000,0.100000,4,\"[0,0,0,0,0,0,0,0,0]\",7,0.5,0.1,0,0,1,0"));
    }

    // A schema that changes gives another file; a name leads nowhere.
    void eachSchemaHasItsFile() {
        const auto files = exported("csv", {"x/*/*/y"});
        QVERIFY2(files.ok(), files ? "" : qPrintable(files.error().message));
        QCOMPARE(files->paths.size(), 2);
        QCOMPARE(QFileInfo(files->paths.at(0)).path(), folder_.filePath("export"));
        QCOMPARE(contentOf(files->paths.at(0)).split('\n')[1].split(',').mid(3).join(','),
                 QByteArray("\"q\"\"u,\","));
        QCOMPARE(contentOf(files->paths.at(1)).split('\n')[0], QByteArray("stamp,t_s,seq,data"));
        QVERIFY(contentOf(files->paths.at(1)).contains("\"[1,2]\""));
        QCOMPARE(exported("csv")->paths.size(), 6);
    }

    void textsAreNoFormulas() {
        SessionFolder folder;
        for (const char *text : {"=1+1", "@x", "+a,b", "-2", "a=b"})
            folder.add(1, "a/b", compactJson(QJsonObject{{"number", -2}, {"text", text}}),
                       R"({"type":"object","properties":{"number":{},"text":{}}})");
        folder.finish();
        auto session = SessionReader::open(folder.path());
        const auto files = exportSession(*session, "csv", {}, folder.filePath("export"));
        QStringList cells;
        for (const QByteArray &row : contentOf(files->paths.first()).trimmed().split('\n').mid(1))
            cells.append(row.split(',').mid(3).join(','));
        QCOMPARE(cells, QStringList({"-2,'=1+1", "-2,'@x", "-2,\"'+a,b\"", "-2,'-2", "-2,a=b"}));
    }

    // More topics than a process may have open files.
    void manyTopicsNeedFewOpenFiles() {
        struct rlimit usual {};
        QCOMPARE(::getrlimit(RLIMIT_NOFILE, &usual), 0);
        SessionFolder folder;
        for (int i = 0; i < 200; ++i)
            folder.add(1, QString("a/%1").arg(i), QByteArray("{}"));
        folder.finish();
        auto session = SessionReader::open(folder.path());
        const struct rlimit few { 100, usual.rlim_max };
        QCOMPARE(::setrlimit(RLIMIT_NOFILE, &few), 0);
        const auto files = exportSession(*session, "csv", {}, folder.filePath("export"));
        QCOMPARE(::setrlimit(RLIMIT_NOFILE, &usual), 0);
        QVERIFY2(files.ok(), files ? "" : qPrintable(files.error().message));
        QCOMPARE(files->paths.size(), 200);
        QCOMPARE(QDir(folder.filePath("export")).entryList(QDir::Files | QDir::Hidden).size(), 200);
    }

    void posesAreATrajectory() {
        const QList<QByteArray> rows = textOf("tum", {}).trimmed().split('\n');
        QCOMPARE(rows.size(), 10);
        QCOMPARE(rows[1], QByteArray("1700000000.100000 1.000000 2.000000 0 0 0 1.000000000 0.000000000"));
        QVERIFY(textOf("tum", {"motorcontrol/odometry"})
                    .startsWith("1700000000.000000 0.000000 0.000000 0 0 0 0.247"));
    }

    void carmenLogIsReadAgain() {
        std::istringstream in(textOf("carmen", {}).toStdString());
        const auto log = vectorlib::readCarmenLog(in, "log");
        QVERIFY2(log.ok(), log ? "" : log.error().message().c_str());
        QCOMPARE(log->odometry.size(), std::size_t(10));
        QCOMPARE(log->scans.size(), std::size_t(10));
        const vectorlib::CarmenScan &scan = log->scans[3];
        QVERIFY(std::abs(scan.stamp - SessionFolder::start - 0.35) < 1e-6);
        QVERIFY(std::abs(scan.robotPose.x - 0.35) < 0.06 && std::abs(scan.robotPose.theta - 0.5) < 1e-6);
        std::vector<vectorlib::Vector2D<double>> points;
        scan.appendPoints(points);
        QCOMPARE(points.size(), std::size_t(170));
        for (const auto &point : points)
            QVERIFY(std::abs(point.norm() - 5) < 1e-3);
        QVERIFY(std::abs(points[0].x - 5 * std::cos(170 * vectorlib::pi / 180)) < 1e-3);
        QVERIFY(std::abs(points[0].y + 5 * std::sin(170 * vectorlib::pi / 180)) < 1e-3);
    }

    // Of two scanners that which the matcher took, as it hung.
    void carmenLogIsOfTheMatchersScanner() {
        SessionFolder folder;
        folder.addresses = {{"scanner@a", "tcp://127.0.0.1:7470"}, {"scanner", "tcp://127.0.0.1:7471"}};
        folder.add(0, "scanmatcher/settings",
                   QByteArray(R"({"sensor":{"x_m":0,"y_m":0,"theta_rad":0,"upside_down":true},)"
                              R"("source":{"address":"127.0.0.1:7470"}})"));
        folder.add(0.01, "motorcontrol/odometry", OdometryMessage{{}, {}, {}, 7});
        for (const char *name : {"scanner@a", "scanner"}) {
            ScanMessage scan;
            scan.header.stamp = SessionFolder::start + 0.02;
            scan.header.rays = 4;
            scan.x = {1, 0};
            scan.y = {0, name == QString("scanner") ? 3.0f : 2.0f}; // ahead and to the left, as it takes it
            folder.add(0.03, name + QString("/scan2d"), scan);
        }
        folder.finish();
        auto session = SessionReader::open(folder.path());
        const auto files = exportSession(*session, "carmen", {}, folder.filePath("export"));
        QVERIFY2(files.ok(), files ? "" : qPrintable(files.error().message));
        std::istringstream in(contentOf(files->paths.first()).toStdString());
        const auto log = vectorlib::readCarmenLog(in, "log");
        QVERIFY2(log.ok(), log ? "" : log.error().message().c_str());
        QCOMPARE(log->scans.size(), std::size_t(1));
        std::vector<vectorlib::Vector2D<double>> points;
        log->scans[0].appendPoints(points);
        QCOMPARE(points.size(), std::size_t(2));
        for (const auto &point : points) // to the right
            QVERIFY(std::abs(point.norm() - 1) < 1e-3 || std::abs(point.y + 2) < 1e-3);
    }

    void allPartsBecomeOneFile() {
        const auto files = exported("mcap");
        QVERIFY2(files.ok(), files ? "" : qPrintable(files.error().message));
        auto reader = mcap::Reader::open(files->paths.first().toStdString());
        QVERIFY(reader.ok() && reader->isWhole());
        QCOMPARE(reader->channels().size(), std::size_t(6));
        std::map<std::string, int> counts;
        while (const auto message = reader->next())
            ++counts[reader->channels().at(message->channel).topic];
        QCOMPARE(counts["velodynelogger/scan2d"], 10);
        QCOMPARE(counts["x/../../y"], 2);
        QCOMPARE(QString::fromStdString(reader->problem()), QString());
    }

    void whatIsNotThereIsTold_data() {
        const Rows<QString, QStringList, QString> row("format", "topics", "told");
        row("format", "xls", {}, "found xls, expected csv, tum, carmen, mcap or pcap");
        row("no lidar", "pcap", {}, "found no capture of a lidar");
        row("topic", "csv", {"a/b"}, "found no messages of these topics");
        row("no scan", "carmen", {"motorcontrol/odometry"}, "found no scan with odometry");
    }
    void whatIsNotThereIsTold() {
        FETCH(QString, format, QStringList, topics, QString, told);
        const auto files = exported(format, topics);
        QVERIFY(!files);
        QVERIFY2(files.error().message.contains(told), qPrintable(files.error().message));
    }

    void capturesAreJoined() {
        SessionFolder folder;
        folder.add(0, "a/b", QByteArray("1"));
        folder.finish();
        std::vector<std::string> written;
        // 9999 comes before 10000; the tail of one is torn.
        for (const char *name :
             {"velodynelogger-0001", "velodynelogger-9999", "velodynelogger-10000", "other-0001"}) {
            std::vector<std::string> payloads;
            for (int i = 0; i < 3; ++i)
                payloads.push_back(name + std::to_string(i));
            writeCapture(folder.filePath(QString(name) + ".pcap"), payloads);
            if (*name == 'v')
                written.insert(written.end(), payloads.begin(), payloads.end());
        }
        QFile torn(folder.filePath("velodynelogger-9999.pcap"));
        QVERIFY(torn.resize(torn.size() - 5));
        written.erase(written.begin() + 5);
        auto session = SessionReader::open(folder.path());
        const QString into = folder.filePath("export");
        QVERIFY(!exportSession(*session, "pcap", {"a/b"}, into)); // there are no topics in it
        QVERIFY(QFile::link("/etc/passwd", into + "/.velodynelogger.pcap.new"));
        const auto files = exportSession(*session, "pcap", {}, into);
        QVERIFY2(files.ok(), files ? "" : qPrintable(files.error().message));
        QCOMPARE(files->paths, QStringList({into + "/other.pcap", into + "/velodynelogger.pcap"}));
        std::vector<std::string> read;
        QVERIFY(readPcapTail(files->paths.last().toStdString(), 0, [&](const Datagram &datagram) {
            read.emplace_back(reinterpret_cast<const char *>(datagram.payload), datagram.size);
            return true;
        }));
        QVERIFY(read == written);
        QVERIFY2(files->problems.size() == 1 &&
                     files->problems[0].contains("velodynelogger-9999.pcap: only "),
                 qPrintable(files->problems.join('\n')));
        put(folder.filePath("velodynelogger-0002.pcap"), QByteArray(100, 'x'));
        const auto again = exportSession(*session, "pcap", {}, into); // without that one
        QVERIFY2(again.ok(), again ? "" : qPrintable(again.error().message));
        VERIFY_CONTAINS(again->problems.join('\n'), QString("velodynelogger-0002.pcap: it does not begin"));
        QCOMPARE(QDir(into).entryList(QDir::Files | QDir::Hidden),
                 QStringList({"other.pcap", "velodynelogger.pcap"}));
    }

    void whatIsMissingIsTold() {
        SessionFolder folder;
        folder.add(0, "a/b", QByteArray("1"));
        folder.nextFile();
        folder.add(1, "a/b", QByteArray("98765"));
        const QJsonArray files{QJsonObject{{"name", "recorder-0003.mcap"}, {"bytes", 100}}};
        folder.finish({{"a/b", 7}}, {{"files", files}});
        QByteArray bytes = contentOf(folder.filePath("recorder-0002.mcap"));
        bytes[bytes.indexOf("98765")] = '8';
        put(folder.filePath("recorder-0002.mcap"), bytes);
        QVERIFY(QFile::link(folder.filePath("recorder-0001.mcap"), folder.filePath("recorder-0004.mcap")));
        auto session = SessionReader::open(folder.path());
        const auto told = exportSession(*session, "csv", {}, folder.filePath("export"));
        QVERIFY2(told.ok(), told ? "" : qPrintable(told.error().message));
        QCOMPARE(contentOf(told->paths.first()).count('\n'), 2);
        const QStringList expected{
            "recorder: lost: a/b 7", "recorder-0003.mcap: it has 0 bytes, and 100 were recorded",
            "recorder-0004.mcap: it is a link, and is not read", "recorder-0002.mcap: byte "};
        QCOMPARE(told->problems.size(), expected.size());
        for (int i = 0; i < expected.size(); ++i)
            QVERIFY2(told->problems[i].contains(expected[i]), qPrintable(told->problems[i]));
        QVERIFY(QFile::remove(folder.filePath("recorder-0001.mcap")));
        session = SessionReader::open(folder.path());
        const auto none = exportSession(*session, "csv", {}, folder.filePath("export"));
        VERIFY_CONTAINS(none.error().message, "expected some: recorder: lost: a/b 7; ");
    }

    void theEndOfASessionIsNoProblemAndOneThatGoesOnIs_data() {
        const Rows<QJsonValue, QStringList> row("ended", "problems");
        row("stopped", "stopped", {});
        row("shut down", "shut down", {});
        row("goes on", QJsonValue(), {"being recorded"});
        row("cut off", "cut off", {"recorder: cut off"});
    }
    void theEndOfASessionIsNoProblemAndOneThatGoesOnIs() {
        FETCH(QJsonValue, ended, QStringList, problems);
        SessionFolder folder;
        folder.add(0, "a/b", QByteArray("1"));
        folder.finish({}, {{"ended", ended}});
        auto session = SessionReader::open(folder.path());
        const auto files = exportSession(*session, "csv", {}, folder.filePath("export"));
        QVERIFY2(files.ok(), files ? "" : qPrintable(files.error().message));
        QCOMPARE(files->problems, problems);
    }

    void damagedCapturesAreTold() {
        SessionFolder folder;
        folder.add(0, "a/b", QByteArray("1"));
        folder.finish();
        put(folder.filePath("short-0001.pcap"), QByteArray(10, 'x'));
        auto session = SessionReader::open(folder.path());
        VERIFY_CONTAINS(exportSession(*session, "pcap", {}, folder.filePath("export")).error().message,
                        "found no packets, expected some: " + folder.filePath("short-0001.pcap") +
                            ": only 0 of its 10 bytes could be read, 0 packets");
        const QString damaged = folder.filePath("damaged-0001.pcap");
        writeCapture(damaged, std::vector<std::string>(100, "payload"));
        QByteArray bytes = contentOf(damaged);
        bytes[24 + 65 + 8] = '\xFF'; // the length of the second packet
        put(damaged, bytes);
        const QByteArray odd = folder.path().toUtf8() + "/\xE9-0001.pcap";
        writeCapture(folder.filePath("odd-0001.pcap"), {"payload"});
        QCOMPARE(std::rename(qPrintable(folder.filePath("odd-0001.pcap")), odd.constData()), 0);
        session = SessionReader::open(folder.path());
        const auto files = exportSession(*session, "pcap", {}, folder.filePath("export"));
        QVERIFY2(files.ok(), files ? "" : qPrintable(files.error().message));
        QCOMPARE(files->problems.size(), 2);
        QCOMPARE(
            files->problems[0],
            QString("%1: only 89 of its %2 bytes could be read, 1 packets, the last at 0.50 s of the session")
                .arg(damaged)
                .arg(bytes.size()));
        QCOMPARE(files->paths.size(), 3);
        QCOMPARE(contentOf(folder.filePath("export/-.pcap")).size(), 24 + 65);
        QCOMPARE(std::remove(odd.constData()), 0); // Qt does not see it
    }

    /// Nobody waits for who would write into a pipe, and what is elsewhere stays there.
    void pipesAndLinksAreNotRead() {
        SessionFolder folder, other;
        folder.add(0, "a/b", QByteArray("1"));
        folder.finish();
        const QString pipe = folder.filePath("lidar-0001.pcap");
        QCOMPARE(::mkfifo(qPrintable(pipe), 0600), 0);
        auto session = SessionReader::open(folder.path());
        const auto refused = [&] {
            return exportSession(*session, "pcap", {}, folder.filePath("export")).error().message;
        };
        VERIFY_CONTAINS(refused(), pipe + ": not a regular file");
        QVERIFY(QFile::rename(pipe, other.filePath("pipe")));
        writeCapture(other.filePath("own.pcap"), {"payload"});
        for (const char *target : {"pipe", "own.pcap"}) {
            QVERIFY(QFile::link(other.filePath(target), pipe));
            VERIFY_CONTAINS(refused(), pipe + ": cannot be read: it is a link");
            QVERIFY(QFile::remove(pipe));
        }
        QVERIFY(QFile::link(other.filePath("own.pcap"), pipe));
        writeCapture(folder.filePath("lidar-0002.pcap"), {"payload"}); // is exported without that one
        const auto rest = exportSession(*session, "pcap", {}, folder.filePath("export"));
        QVERIFY2(rest.ok(), rest ? "" : qPrintable(rest.error().message));
        VERIFY_CONTAINS(rest->problems.join('\n'), pipe + ": cannot be read: it is a link");
        session = SessionReader::open(folder.path());
        QCOMPARE(::mkfifo(qPrintable(folder.filePath("recorder-0002.mcap")), 0600), 0);
        session = SessionReader::open(folder.path());
        const auto files = exportSession(*session, "csv", {}, folder.filePath("export"));
        QVERIFY2(files.ok(), files ? "" : qPrintable(files.error().message));
        QCOMPARE(files->problems,
                 QStringList(folder.filePath("recorder-0002.mcap") + ": is no regular file"));
    }

    void aFolderThatIsALinkIsRefused() {
        QVERIFY(QFile::link("/tmp", folder_.filePath("link")));
        auto session = SessionReader::open(folder_.path());
        QVERIFY(!exportSession(*session, "csv", {}, folder_.filePath("link")));
        SessionFolder other;
        QVERIFY(QFile::link(folder_.path(), other.filePath("linked")));
        session = SessionReader::open(other.filePath("linked"));
        VERIFY_CONTAINS(exportSession(*session, "csv", {}, session->folder() + "/export").error().message,
                        "linked: it is a link");
    }

    void whatIsToEndReplacesNothing_data() {
        const Rows<QString> row("format");
        for (const char *format : {"csv", "tum", "carmen", "mcap", "pcap"})
            row(format, format);
    }
    void whatIsToEndReplacesNothing() {
        QFETCH(QString, format);
        SessionFolder folder;
        folder.add(0, "scanmatcher/pose", QByteArray(R"({"x":1,"y":2,"theta":3})"));
        folder.finish();
        writeCapture(folder.filePath("lidar-0001.pcap"), {"payload"});
        const std::atomic<bool> stop{true};
        auto session = SessionReader::open(folder.path(), &stop);
        QVERIFY(!exportSession(*session, format, {}, folder.filePath("export")));
        QVERIFY(QDir(folder.filePath("export")).isEmpty(QDir::Files | QDir::Hidden));
    }

    void aFullDiskIsTold() {
        SessionFolder folder;
        folder.add(0, "a/b", QByteArray("1"));
        folder.finish();
        auto session = SessionReader::open(folder.path());
        const FileSizeLimit limit(10);
        VERIFY_CONTAINS(exportSession(*session, "csv", {}, folder.filePath("export")).error().message,
                        "cannot be written: File too large");
    }

    /// Such as that of a client that was ended, and its repeat.
    void twoAtOnceAreAsOneAlone() {
        QTemporaryDir root;
        SessionFolder folder;
        for (int i = 0; i < 20000; ++i)
            folder.add(1e-3 * i, "a/b", QByteArray(R"({"text":"some words"})"),
                       R"({"properties":{"text":{}}})");
        folder.finish();
        QVERIFY(QDir().rename(folder.path(), root.filePath("run")));
        Recorder recorder;
        launch(recorder,
               {"record.folder=" + root.path(), "record.free_floor_bytes=0", "daemons=[\"127.0.0.1:1\"]"});
        connectTo(recorder);
        const QJsonObject params{{"name", "run"}, {"format", "csv"}};
        const QString path = call("session.export", params)["paths"][0].toString();
        const QByteArray alone = contentOf(path);
        QCOMPARE(alone.count('\n'), 20001);
        std::vector<QByteArray> found;
        for (int i = 0; i < 2; ++i)
            client_->call(
                "session.export", params,
                [&](const Result<QJsonValue> &result) {
                    found.push_back(result ? contentOf(path) : result.error().message.toUtf8());
                },
                std::chrono::minutes(1));
        QTRY_COMPARE_WITH_TIMEOUT(found.size(), std::size_t(2), 60000);
        for (const QByteArray &content : found)
            QVERIFY2(content == alone, content.left(200).constData());
        client_.reset();
        recorder.shutDown();
    }
};
