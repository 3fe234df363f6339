#include "common/capture/PcapWriter.h"
#include "daemons/recorder/SessionExport.h"
#include "protocol/mcap/Reader.h"
#include "protocol/messages/Motion.h"
#include "protocol/messages/Turns.h"
#include "tests/support/Rows.h"
#include "tests/support/SessionFolder.h"
#include "vectorlib/io/CarmenLog.h"

#include <sstream>
#include <sys/resource.h>

using namespace hermes;
using namespace hermes::recorder;

class TestSessionExport : public QObject {
    Q_OBJECT

    SessionFolder folder_;

    Result<QStringList> exported(const QString &format, const QStringList &topics = {}) const {
        auto session = SessionReader::open(folder_.path());
        return session ? exportSession(*session, format, topics, folder_.filePath("export"))
                       : session.error();
    }
    /// What the only file of an export has.
    QByteArray textOf(const QString &format, const QStringList &topics) const {
        const auto paths = exported(format, topics);
        if (!paths)
            return paths.error().message.toUtf8();
        return paths->size() == 1 ? contentOf(paths->first()) : "files: " + paths->join(", ").toUtf8();
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
        const auto paths = exported("csv", {"x/*/*/y"});
        QVERIFY2(paths.ok(), paths ? "" : qPrintable(paths.error().message));
        QCOMPARE(paths->size(), 2);
        QCOMPARE(QFileInfo(paths->at(0)).path(), folder_.filePath("export"));
        QCOMPARE(contentOf(paths->at(0)).split('\n')[1].split(',').mid(3).join(','),
                 QByteArray("\"q\"\"u,\","));
        QCOMPARE(contentOf(paths->at(1)).split('\n')[0], QByteArray("stamp,t_s,seq,data"));
        QVERIFY(contentOf(paths->at(1)).contains("\"[1,2]\""));
        QCOMPARE(exported("csv")->size(), 6);
    }

    void textsAreNoFormulas() {
        SessionFolder folder;
        for (const char *text : {"=1+1", "@x", "+a,b", "-2", "a=b"})
            folder.add(1, "a/b", compactJson(QJsonObject{{"number", -2}, {"text", text}}),
                       R"({"type":"object","properties":{"number":{},"text":{}}})");
        folder.finish();
        auto session = SessionReader::open(folder.path());
        const auto paths = exportSession(*session, "csv", {}, folder.filePath("export"));
        QStringList cells;
        for (const QByteArray &row : contentOf(paths->first()).trimmed().split('\n').mid(1))
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
        const auto paths = exportSession(*session, "csv", {}, folder.filePath("export"));
        QCOMPARE(::setrlimit(RLIMIT_NOFILE, &usual), 0);
        QVERIFY2(paths.ok(), paths ? "" : qPrintable(paths.error().message));
        QCOMPARE(paths->size(), 200);
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
        const auto paths = exportSession(*session, "carmen", {}, folder.filePath("export"));
        QVERIFY2(paths, paths ? "" : qPrintable(paths.error().message));
        std::istringstream in(contentOf(paths->first()).toStdString());
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
        const auto paths = exported("mcap");
        QVERIFY2(paths.ok(), paths ? "" : qPrintable(paths.error().message));
        auto reader = mcap::Reader::open(paths->first().toStdString());
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
        const auto paths = exported(format, topics);
        QVERIFY(!paths);
        QVERIFY2(paths.error().message.contains(told), qPrintable(paths.error().message));
    }

    void capturesAreJoined() {
        SessionFolder folder;
        folder.add(0, "a/b", QByteArray("1"));
        folder.finish();
        std::vector<std::string> written;
        // 9999 comes before 10000; the tail of one is torn.
        for (const char *name :
             {"velodynelogger-0001", "velodynelogger-9999", "velodynelogger-10000", "other-0001"}) {
            PcapWriter writer;
            const QString path = folder.filePath(QString(name) + ".pcap");
            QVERIFY(writer.open(path.toStdString()));
            for (int i = 0; i < 3; ++i) {
                const std::string payload = name + std::to_string(i);
                const auto *bytes = reinterpret_cast<const std::uint8_t *>(payload.data());
                QVERIFY(writer.write({1000 + i, 1, 2, 2368, 2368, bytes, payload.size()}));
                if (payload[0] == 'v')
                    written.push_back(payload);
            }
            QVERIFY(writer.close());
        }
        QFile torn(folder.filePath("velodynelogger-9999.pcap"));
        QVERIFY(torn.resize(torn.size() - 5));
        written.erase(written.begin() + 5);
        auto session = SessionReader::open(folder.path());
        const QString into = folder.filePath("export");
        QVERIFY(!exportSession(*session, "pcap", {"a/b"}, into)); // there are no topics in it
        QVERIFY(QFile::link("/etc/passwd", into + "/.velodynelogger.pcap.new"));
        const auto paths = exportSession(*session, "pcap", {}, into);
        QVERIFY2(paths, paths ? "" : qPrintable(paths.error().message));
        QCOMPARE(*paths, QStringList({into + "/other.pcap", into + "/velodynelogger.pcap"}));
        std::vector<std::string> read;
        QVERIFY(readPcapTail(paths->last().toStdString(), 0, [&](const Datagram &datagram) {
            read.emplace_back(reinterpret_cast<const char *>(datagram.payload), datagram.size);
        }));
        QVERIFY(read == written);
        QFile foreign(folder.filePath("other-0002.pcap")); // nothing is replaced then
        QVERIFY(foreign.open(QIODevice::WriteOnly) && foreign.write(QByteArray(100, 'x')) == 100);
        foreign.close();
        const auto refused = exportSession(*session, "pcap", {}, into);
        QVERIFY(!refused && refused.error().message.contains("other-0002.pcap: it does not begin"));
        QCOMPARE(QDir(into).entryList(QDir::Files | QDir::Hidden),
                 QStringList({"other.pcap", "velodynelogger.pcap"}));
    }

    void aFolderThatIsALinkIsRefused() {
        QVERIFY(QFile::link("/tmp", folder_.filePath("link")));
        auto session = SessionReader::open(folder_.path());
        QVERIFY(!exportSession(*session, "csv", {}, folder_.filePath("link")));
    }
};
