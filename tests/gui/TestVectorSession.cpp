// hermes-vector takes a session as a robot recorded it: a capture in several files, odometry and settings.
#include "VectorProgram.h"
#include "daemons/simulator/Simulation.h"
#include "protocol/messages/Motion.h"
#include "tests/daemons/Pillars.h"
#include "tests/support/SessionFolder.h"
#include "vectorlib/io/Tum.h"
#include "vectorlib/observation/SimulatedScanner.h"

#include <tuple>

namespace simulator = hermes::simulator;
namespace velodyne = hermes::velodyne;
using hermes::Datagram;
using hermes::OdometryMessage;
using hermes::PcapWriter;

class TestVectorSession : public QObject {
    Q_OBJECT

    static constexpr double mount_m = 0.2; // the sensor ahead of the robot's centre
    SessionFolder session_;
    std::vector<vectorlib::StampedPose> truth_; // of the sensor
    int messages_ = 0;
    const QByteArray settings_ =
        R"({"matcher":{"compensate_motion":true,"expected_deviation_m":0.05,"expected_deviation_rad":0.1,"permitted_m":0.5,"permitted_rad":0.4,"min_matched_share":0.15,"relocalize_after":10,"relocalize_s":3,"sigma_m":0.02},"sensor":{"x_m":0.2,"y_m":0,"theta_rad":0}})";

    /// A drive through the room with pillars; its wheels slip by 1 %.
    void record() {
        simulator::Simulation simulation(pillars(), {}, std::int64_t(SessionFolder::start * 1e9));
        QVERIFY(simulation.drive());
        const vectorlib::Pose2D sensor{mount_m, 0, 0};
        PcapWriter writer;
        double due = 0, way = 0, before = 0;
        for (int packet = 0; !simulation.truth().finished; ++packet) {
            if (packet % 12000 == 0)
                QVERIFY(writer.open(partPath(packet / 12000 + 1).toStdString()).ok());
            Datagram d;
            d.stamp_ns = simulation.now_ns();
            const auto bytes = simulation.nextPacket();
            d.source = 0xC0A801C9;
            d.sourcePort = d.destinationPort = velodyne::dataPort;
            d.payload = bytes.data();
            d.size = bytes.size();
            QVERIFY(writer.write(d).ok());
            const auto truth = simulation.truth();
            const double t = double(truth.stamp_ns) * 1e-9 - SessionFolder::start;
            if (t >= due) { // the lidar's pose is that of the simulation
                due += 0.02;
                truth_.push_back({truth.stamp_ns * 1e-9, truth.pose});
                way += (t - before) * std::hypot(truth.twist.vx, truth.twist.vy);
                before = t;
                const vectorlib::Pose2D robot = truth.pose * sensor.inverse();
                const vectorlib::Pose2D told{1.01 * robot.x, 1.01 * robot.y, robot.theta};
                const vectorlib::Twist2D twist{truth.twist.vx, -mount_m * truth.twist.omega,
                                               truth.twist.omega};
                const double variance = 1e-4 * way;
                session_.add(
                    t, "motorcontrol/odometry",
                    OdometryMessage{told, twist, {variance, 0, 0, 0, variance, 0, 0, 0, variance}, t});
                if (++messages_ == 300)
                    session_.nextFile();
            }
        }
        QVERIFY(writer.close().ok());
    }
    QString partPath(int number) const {
        return session_.filePath(QString("velodynelogger-%1.pcap").arg(number, 4, 10, QChar('0')));
    }
    Result mapped(const QStringList &options, const QString &path) const {
        return ran(QStringList{"map", path, "--loops", "leave", "--out-trajectory",
                               session_.filePath("t.tum"), "--force"} +
                   options);
    }
    /// The largest distance of a pose from the truth, where the first is in place; metres.
    double worst() const {
        std::ifstream file(session_.filePath("t.tum").toStdString());
        const auto poses = vectorlib::readTum(file, "t.tum");
        if (!poses || poses->empty())
            return 1e9;
        const auto at = [&](double stamp) {
            const auto next = std::lower_bound(truth_.begin(), truth_.end(), stamp,
                                               [](const auto &p, double s) { return p.stamp < s; });
            return (next == truth_.end() ? truth_.back() : *next).pose;
        };
        const vectorlib::Pose2D frame = at(poses->front().stamp) * poses->front().pose.inverse();
        double result = 0;
        for (const auto &found : *poses) {
            const vectorlib::Pose2D off = at(found.stamp).inverse() * (frame * found.pose);
            result = std::max(result, std::hypot(off.x, off.y));
        }
        return result;
    }

private Q_SLOTS:
    void initTestCase() {
        session_.add(0, "scanmatcher/settings", settings_);
        for (const char *const wrong : {"", "[", R"({"pose":1})", R"({"pose":{"x":1e999}})"})
            session_.add(0, "motorcontrol/odometry", QByteArray(wrong));
        record();
        session_.finish();
    }

    void odometryAndSettingsAreThoseOfTheRobot() {
        const Result map = mapped({}, session_.path());
        const QJsonObject summary = json(map.out);
        QVERIFY2(summary["scans"].toInt() > 200, map.out);
        QCOMPARE(summary["by_odometry"].toInt(), summary["matched"].toInt() - 1);
        QCOMPARE(summary["odometry_refused"].toInt(), 4);
        QCOMPARE(summary["sensor"].toArray()[0].toDouble(), mount_m);
        QVERIFY(!summary.contains("contradicted"));
        QVERIFY2(map.err.contains("0001.pcap: read on to") && map.err.contains("0006.pcap"), map.err);
        QVERIFY2(worst() < 0.1, qPrintable(QString::number(worst())));
    }

    void optionsGoBeforeSettings() {
        const Result map = mapped({"--sensor", "0.1,0,0"}, session_.path());
        QCOMPARE(json(map.out)["sensor"].toArray()[0].toDouble(), 0.1);
        QCOMPARE(json(mapped({"--odometry", "ignore"}, session_.path()).out)["by_odometry"].toInt(), 0);
    }

    // Whatever takes a capture takes all files of a recording.
    void numberedFilesAreOneRecording() {
        const int all = json(mapped({}, session_.path()).out)["scans"].toInt();
        const Result first = mapped({}, partPath(1)), second = mapped({}, partPath(2));
        QCOMPARE(json(first.out)["scans"].toInt(), all);
        QVERIFY(json(second.out)["scans"].toInt() < all);
        const QByteArray ring = ran({"ring", session_.path()}).out;
        QCOMPARE(ran({"ring", partPath(1)}).out, ring);
        QVERIFY(ring.size() > ran({"ring", partPath(2)}).out.size());
    }

    void twoCapturesInAFolderAreTold() {
        const QString other = session_.filePath("other-0001.pcap");
        QVERIFY(QFile::copy(partPath(1), other));
        refused(run({"map", session_.path()}), 1, "found two captures");
        QVERIFY(QFile::remove(other));
    }

    // One ahead, one back; a third is on no robot that the matcher knows.
    void twoScannersMakeOneMap_data() { falseAndTrue("both", "the first alone", "both"); }
    void twoScannersMakeOneMap() {
        QFETCH(bool, both);
        using Point = vectorlib::Vector2D<float>;
        const std::vector<vectorlib::LineSegment2D<float>> room{{Point(-3, -2), Point(6, -2)},
                                                                {Point(6, -2), Point(6, 3)},
                                                                {Point(6, 3), Point(-3, 2)},
                                                                {Point(-3, 2), Point(-3, -2)}};
        SessionFolder folder;
        folder.addresses = {{"scanner@127.0.0.1:7470", "tcp://127.0.0.1:7470"},
                            {"scanner", "tcp://127.0.0.1:7471"},
                            {"laser", "tcp://127.0.0.1:7472"}};
        QByteArray settings = settings_;
        settings.chop(1);
        folder.add(0, "scanmatcher/settings",
                   settings + R"(,"source":{"address":"127.0.0.1:7470"},"source2":{"address":")" +
                       (both ? "127.0.0.1:7471" : "") +
                       R"("},"sensor2":{"x_m":-0.2,"y_m":0,"theta_rad":3.141592654}})");
        vectorlib::SimulatedScanner<> scanner;
        scanner.rays = 401;
        scanner.fieldOfView = 200 * vectorlib::pi / 180;
        for (int i = 0; i < 60; ++i)
            for (const auto &[daemon, mount, late] :
                 {std::tuple("scanner", vectorlib::Pose2D{-0.2, 0, vectorlib::pi}, 0.03),
                  {"laser", vectorlib::Pose2D{0, 0, 1}, 0.05},
                  {"scanner@127.0.0.1:7470", vectorlib::Pose2D{0.2, 0, 0}, 0.08}}) {
                const double t = 0.1 * i + late;
                QJsonArray x, y;
                for (const Point &p : scanner(room, vectorlib::Pose2D{0.5 * t, 0, 0.1 * t} * mount)) {
                    x.append(double(p.x));
                    y.append(double(p.y));
                }
                folder.add(
                    t, QString(daemon) + "/scan2d",
                    QJsonDocument(QJsonObject{{"stamp", t}, {"rays", 720}, {"x", x}, {"y", y}}).toJson());
            }
        folder.finish();
        const Result map = ran({"map", folder.path(), "--out-map", folder.filePath("map.csv"), "--force"});
        QCOMPARE(json(map.out)["matched"].toInt(), 60);
        const QByteArray told =
            both ? "scanner@127.0.0.1:7470/scan2d and scanner/scan2d are two scanners of one robot; "
                   "left out: laser/scan2d"
                 : "left out: laser/scan2d, scanner/scan2d";
        QVERIFY2(map.err.contains(told), map.err);
        QByteArray walls = contentOf(folder.filePath("map.csv"));
        QCOMPARE(std::count_if(walls.begin(), walls.end(), [](char c) { return c == '\n'; }), both ? 5 : 4);
    }

    // Without odometry, what hung upside down gives the way of the same capture, mirrored.
    void aLidarThatHangsUpsideDownIsTurned() {
        std::vector<vectorlib::Pose2D> ends;
        for (const bool hangs : {false, true}) {
            SessionFolder folder;
            QByteArray settings = settings_;
            settings.replace("\"x_m\":0.2", hangs ? "\"upside_down\":true,\"x_m\":0" : "\"x_m\":0");
            folder.add(0, "scanmatcher/settings", settings);
            folder.finish();
            QVERIFY(QFile::copy(partPath(2), folder.filePath("velodynelogger-0001.pcap")));
            const Result map = mapped({}, folder.path());
            QVERIFY2(map.status == 0, map.err);
            std::ifstream file(session_.filePath("t.tum").toStdString());
            const auto poses = vectorlib::readTum(file, "t.tum");
            QVERIFY(poses && poses->size() > 20);
            ends.push_back(poses->back().pose);
        }
        QVERIFY(std::hypot(ends[0].x, ends[0].y) > 0.2 && std::abs(ends[0].theta) > 0.05);
        QVERIFY(std::hypot(ends[0].x - ends[1].x, ends[0].y + ends[1].y) < 0.02);
        QVERIFY(std::abs(ends[0].theta + ends[1].theta) < 0.02);
    }

    void settingsThatCannotBeReadAreTold() {
        SessionFolder folder;
        folder.add(0, "scanmatcher/settings", QByteArray("[]"));
        folder.finish();
        QVERIFY(QFile::copy(partPath(2), folder.filePath("velodynelogger-0001.pcap")));
        refused(run({"map", folder.path()}), 1, "found no setting matcher.compensate_motion");
    }
};
