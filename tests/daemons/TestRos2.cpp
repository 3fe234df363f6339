#include "common/ros/MapGrid.h"
#include "common/ros/Motion.h"
#include "common/ros/Scans.h"
#include "common/ros/States.h"
#include "daemons/ros2/Service.h"
#include "tests/support/Rows.h"
#include "tests/support/Seed.h"

#include <QXmlStreamReader>
#include <random>

using namespace hermes;
using namespace hermes::ros2;

namespace {

const QString scanner("scanner");

/// A revolution of this many rays in a round room; those of one direction (rad) come back from nowhere.
ScanMessage revolution(int rays, double radius, double open = 100, double openWidth = 0.3) {
    ScanMessage scan;
    scan.header.stamp = 1000.25;
    scan.header.duration_s = 0.1;
    scan.header.rays = quint64(rays);
    for (int i = 0; i < rays; ++i) {
        const double angle = -M_PI + 2 * M_PI * (i + 0.3) / rays;
        if (std::abs(angle - open) < openWidth / 2)
            continue;
        scan.x.push_back(float(radius * std::cos(angle)));
        scan.y.push_back(float(radius * std::sin(angle)));
        scan.intensity.push_back(7);
    }
    return scan;
}

MapEdgeMessage edge(qint64 id, double x1, double y1, double x2, double y2) {
    MapEdgeMessage made;
    made.id = id;
    made.x1 = x1;
    made.y1 = y1;
    made.x2 = x2;
    made.y2 = y2;
    return made;
}

/// A room of 4 m by 3 m about the origin.
void addRoom(ros::MapGrid &grid) {
    grid.set(edge(1, -2, -1.5, 2, -1.5));
    grid.set(edge(2, 2, -1.5, 2, 1.5));
    grid.set(edge(3, 2, 1.5, -2, 1.5));
    grid.set(edge(4, -1.98, 1.5, -1.98, -1.5));
}

int cellAt(const ros::OccupancyGrid &grid, double x, double y) {
    const auto column = int(std::floor((x - grid.info.origin.position.x) / double(grid.info.resolution)));
    const auto row = int(std::floor((y - grid.info.origin.position.y) / double(grid.info.resolution)));
    return grid.data.at(std::size_t(row) * grid.info.width + std::size_t(column));
}

/// In a domain of its own: other tests run beside it.
std::unique_ptr<Participant> joined() {
    ParticipantOptions options;
    options.domain = 1 + int(QCoreApplication::applicationPid() % 200);
    auto made = Participant::open(options);
    if (!made)
        qFatal("%s", qPrintable(made.error().message));
    return made.take();
}

} // namespace

class TestRos2 : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void scansHaveTheSameRaysEachTime_data() {
        const Rows<int, int> row("rays", "bins");
        row("HDL-32E at 10 Hz", 2172, 1800);
        row("few", 404, 360);
        row("as many as a number that is usual", 1800, 1440);
        row("hardly any", 5, 90);
    }
    void scansHaveTheSameRaysEachTime() {
        FETCH(int, rays, int, bins);
        ros::ScanBins convert;
        ros::RobotModel robot("r1/");
        ros::LaserScan scan;
        for (const int changed : {rays, rays + 3, rays / 2 + 1}) {
            QVERIFY(convert(revolution(changed, 2), {scanner, 5, robot}, scan));
            QCOMPARE(int(scan.ranges.size()), bins);
        }
        QCOMPARE(scan.header.frameId, std::string("r1/scanner"));
        QCOMPARE(scan.header.stamp.sec, 1000);
        QCOMPARE(scan.header.stamp.nanosec, 250000000u);
        QVERIFY(std::abs(scan.angleMin + scan.angleIncrement * float(bins - 1) - scan.angleMax) < 1e-5f);
    }

    void nothingComesBackOnlyFromWhereSomethingDidOnce() {
        ros::ScanBins convert;
        const ros::RobotModel robot("");
        const ros::Told told{scanner, 5, robot};
        ros::LaserScan scan;
        QVERIFY(convert(revolution(2172, 2, 1), told, scan));
        const auto at = [&](double angle) {
            return scan.ranges[std::size_t((angle + M_PI) / double(scan.angleIncrement) + 0.5)];
        };
        QCOMPARE(at(0), 2.0f);
        QVERIFY(std::isnan(at(1))); // the scanner may not look there
        QVERIFY(convert(revolution(2172, 2), told, scan));
        QCOMPARE(at(1), 2.0f);
        QVERIFY(convert(revolution(2172, 2, 1), told, scan));
        QVERIFY(std::isinf(at(1)));
        QCOMPARE(
            std::count_if(scan.ranges.begin(), scan.ranges.end(), [](float r) { return std::isinf(r); }) > 70,
            true);
        ScanMessage torn = revolution(2172, 2, 1);
        torn.header.lostPackets = 3;
        QVERIFY(convert(torn, told, scan));
        QVERIFY(std::isnan(at(1)));
    }

    void aMapIsUnknownWhereNobodySaw() {
        ros::MapGrid grid(0.05);
        addRoom(grid);
        grid.set(edge(5, 0.5, -1.5, 0.5, 0)); // a screen
        grid.addPlace(-1, -1);
        ros::OccupancyGrid cells;
        grid.draw(cells);
        QCOMPARE(cellAt(cells, -1.98, 0), 100);
        QCOMPARE(cellAt(cells, -1, 1), 0);
        QCOMPARE(cellAt(cells, 1, -1), -1);  // behind the screen
        QCOMPARE(cellAt(cells, 0, 1.8), -1); // outside
        grid.addPlace(1.5, -1);
        grid.draw(cells);
        QCOMPARE(cellAt(cells, 1, -1), 0);
        grid.remove(2); // what is beyond, nobody knows
        grid.draw(cells);
        QCOMPARE(cellAt(cells, 1.9, -1), -1);
    }

    /// In drawn rooms: walls within a cell, what is seen is free, what is not is unknown.
    void drawnRoomsBecomeCells() {
        std::mt19937 bits(newSeed());
        std::uniform_real_distribution<double> side(1, 6), turn(0, M_PI);
        for (int round = 0; round < 20; ++round) {
            ros::MapGrid grid(0.05);
            const double a = side(bits), b = side(bits), angle = turn(bits);
            const double c = std::cos(angle), s = std::sin(angle);
            const std::array<std::array<double, 2>, 4> corners{{{-a, -b}, {a, -b}, {a, b}, {-a, b}}};
            const auto x = [&](std::size_t i) { return c * corners[i % 4][0] - s * corners[i % 4][1]; };
            const auto y = [&](std::size_t i) { return s * corners[i % 4][0] + c * corners[i % 4][1]; };
            for (std::size_t i = 0; i < 4; ++i)
                grid.set(edge(qint64(i), x(i), y(i), x(i + 1), y(i + 1)));
            grid.addPlace(0, 0);
            ros::OccupancyGrid cells;
            grid.draw(cells);
            int inside = 0, isFree = 0, wrong = 0;
            for (std::uint32_t row = 0; row < cells.info.height; ++row)
                for (std::uint32_t column = 0; column < cells.info.width; ++column) {
                    const double px = cells.info.origin.position.x + (column + 0.5) * 0.05;
                    const double py = cells.info.origin.position.y + (row + 0.5) * 0.05;
                    const double u = std::abs(c * px + s * py) - a, v = std::abs(c * py - s * px) - b;
                    const double distance = std::max(u, v); // to the wall; negative: inside
                    const int cell = cells.data[row * cells.info.width + column];
                    inside += distance < -0.08;
                    isFree += distance < -0.08 && cell == 0;
                    wrong += (distance > 0.08 && cell != -1) || (distance < -0.08 && cell == 100);
                }
            QCOMPARE(wrong, 0);
            QVERIFY2(isFree > 0.98 * inside, qPrintable(QString("%1 of %2").arg(isFree).arg(inside)));
        }
    }

    void poseIsThatOfTheRobot() {
        ros::RobotModel robot("");
        robot.addScanner("velodynelogger", "127.0.0.1:7420");
        robot.takeSettings(
            "scanmatcher",
            {{"source", QJsonObject{{"address", "127.0.0.1:7420"}}},
             {"sensor", QJsonObject{{"x_m", 0.5}, {"theta_rad", M_PI / 2}, {"upside_down", true}}}});
        PoseMessage pose;
        pose.pose = {1, 2, M_PI / 2};
        pose.outcome = "matched";
        pose.trust = 0.9;
        pose.covariance = Covariance{0.01, 0, 0, 0, 0.02, 0, 0, 0, 0.04};
        ros::MapPose convert;
        ros::PoseWithCovarianceStamped out;
        QVERIFY(convert(pose, {scanner, 5, robot}, out));
        // The robot looks along x; its centre is half a metre behind the sensor.
        QVERIFY(std::abs(out.pose.pose.position.x - 0.5) < 1e-9 &&
                std::abs(out.pose.pose.position.y - 2) < 1e-9);
        QVERIFY(std::abs(out.pose.pose.orientation.w - 1) < 1e-9);
        QVERIFY(std::abs(out.pose.covariance[0] - 0.01) < 1e-9);
        QVERIFY(std::abs(out.pose.covariance[7] - (0.02 + 0.25 * 0.04)) < 1e-9); // the lever adds
        QVERIFY(std::abs(out.pose.covariance[11] + 0.5 * 0.04) < 1e-9);
        QCOMPARE(out.pose.covariance[35], 0.04);
        pose.covariance.reset();
        pose.trust = 0.1;
        QVERIFY(convert(pose, {scanner, 5, robot}, out));
        QVERIFY(out.pose.covariance[0] > 1e4);
        ros::FixedTransforms fixed;
        std::string cdr;
        QVERIFY(fixed.refresh(robot, 5, cdr));
        const auto frames = ros::fromCdr<ros::TfMessage>(cdr);
        QVERIFY(frames);
        QCOMPARE(frames->transforms.size(), std::size_t(1));
        QVERIFY(std::abs(frames->transforms[0].transform.rotation.x - std::sqrt(0.5)) < 1e-9);
        QVERIFY(!fixed.refresh(robot, 5, cdr)); // nothing has changed
    }

    void theDescriptionIsXmlWithAJointForEachWheel_data() {
        const Rows<QString, int> row("layout", "wheels");
        row("mecanum", "mecanum", 4);
        row("two", "two_wheels", 2);
        row("three", "omni3", 3);
        row("four", "omni4", 4);
    }
    void theDescriptionIsXmlWithAJointForEachWheel() {
        FETCH(QString, layout, int, wheels);
        ros::RobotModel robot("<&\"/");
        robot.addScanner("a&b", "127.0.0.1:1");
        robot.takeSettings("motorcontrol", {{"frame", QJsonObject{{"layout", layout}}}});
        QXmlStreamReader xml(QByteArray::fromStdString(ros::urdfOf(robot)));
        int joints = 0;
        while (!xml.atEnd())
            if (xml.readNext() == QXmlStreamReader::StartElement && xml.name() == "joint")
                joints += xml.attributes().value("type") == "continuous";
        QVERIFY2(!xml.hasError(), qPrintable(xml.errorString()));
        QCOMPARE(joints, wheels);
    }

    void networksAreNamesAndNoConfiguration() {
        ParticipantOptions options;
        QVERIFY(configurationOf(options)->contains("address=\"127.0.0.1\""));
        options.networks = QStringList{"eth0", "192.168.1.5"};
        QVERIFY(configurationOf(options)->contains(
            "<NetworkInterface name=\"eth0\"/><NetworkInterface address=\"192.168.1.5\"/>"));
        options.networks = QStringList{"\"/><Tracing/>"};
        QVERIFY(!configurationOf(options));
        options.networks.clear();
        options.peers = QStringList{"a b"};
        QVERIFY(!configurationOf(options));
    }

    void bytesArriveAsTheyWereWritten() {
        const auto participant = joined();
        const QString topic = QString("rt/test_%1").arg(QCoreApplication::applicationPid());
        std::vector<std::string> got;
        double stamp = 0;
        Guid from{};
        auto reader = participant->read(topic, "std_msgs/msg/String", {true, false, 50},
                                        [&](const Reader::Sample &sample) {
                                            got.emplace_back(sample.cdr);
                                            stamp = sample.stamp;
                                            from = sample.writer;
                                        });
        // Of another type, on the same topic.
        auto other =
            participant->read(topic, "std_msgs/msg/Bool", {}, [&](const Reader::Sample &) { got.clear(); });
        auto writer =
            participant->write(topic, "std_msgs/msg/String", {true, false, 50}, "typehash=RIHS01_0;");
        QVERIFY(reader && other && writer);
        QTRY_COMPARE((*writer)->readers(), 1);
        std::vector<std::string> sent;
        for (const std::size_t size : {0, 1, 3, 70000, 2000000})
            sent.push_back(ros::toCdr(ros::String{std::string(size, 'x')}));
        for (const std::string &cdr : sent)
            (*writer)->write(cdr);
        QTRY_COMPARE(got.size(), sent.size());
        for (std::size_t i = 0; i < sent.size(); ++i) {
            QCOMPARE(ros::fromCdr<ros::String>(got[i])->data, ros::fromCdr<ros::String>(sent[i])->data);
            QCOMPARE(got[i].size() % 4, std::size_t(0));
        }
        QCOMPARE(from, (*writer)->guid());
        QVERIFY(std::abs(stamp - double(QDateTime::currentMSecsSinceEpoch()) * 1e-3) < 60);
    }

    void servicesAnswerWhomTheyCanTellApart() {
        Bridge::Options options;
        options.network.domain = 1 + int(QCoreApplication::applicationPid() % 200);
        options.space = QString("/test_%1").arg(QCoreApplication::applicationPid());
        RobotDaemons robot("");
        auto bridge = Bridge::open(options, robot);
        QVERIFY(bridge);
        using Trigger = Service<ros::TriggerRequest, ros::TriggerResponse>;
        int served = 0;
        Trigger::Answer later;
        auto service =
            Trigger::open(**bridge, "stop", [&](const ros::TriggerRequest &, const Trigger::Answer &answer) {
                if (++served == 2)
                    later = answer;
                else
                    answer({true, "done"});
            });
        QVERIFY(service);
        Participant &participant = (*bridge)->participant();
        std::vector<ros::Numbered<ros::TriggerResponse>> replies;
        const std::string type = "std_srvs/srv/Trigger_";
        auto reader = participant.read(
            "rr" + options.space + "/stopReply", type + "Response", {true, false, 10},
            [&](const Reader::Sample &sample) {
                replies.push_back(*ros::fromCdr<ros::Numbered<ros::TriggerResponse>>(sample.cdr));
            });
        auto client = participant.write("rq" + options.space + "/stopRequest", type + "Request",
                                        {true, false, 10}, "clientid=1.2;");
        auto stranger =
            participant.write("rq" + options.space + "/stopRequest", type + "Request", {true, false, 10});
        QTRY_VERIFY((*client)->readers() == 1 && (*stranger)->readers() == 1);
        (*stranger)->write(ros::toCdr(ros::Numbered<ros::TriggerRequest>{7, 1, {}}));
        (*client)->write(ros::toCdr(ros::Numbered<ros::TriggerRequest>{7, 2, {}}));
        QTRY_COMPARE(replies.size(), std::size_t(1));
        QCOMPARE(replies[0].client, quint64(7));
        QCOMPARE(replies[0].number, qint64(2));
        QVERIFY(replies[0].body.success && replies[0].body.message == "done");
        (*client)->write(ros::toCdr(ros::Numbered<ros::TriggerRequest>{7, 3, {}}));
        QTRY_COMPARE(served, 2); // nothing of the stranger's
        service->reset();
        later({true, "too late"}); // nobody is there any more
    }

    void whoComesLaterGetsTheLatchedState() {
        const auto participant = joined();
        const QString topic = QString("rt/latched_%1").arg(QCoreApplication::applicationPid());
        const Quality latched{true, true, 1};
        auto writer = participant->write(topic, "std_msgs/msg/String", latched);
        (*writer)->write(ros::toCdr(ros::String{"old"}));
        (*writer)->write(ros::toCdr(ros::String{"new"}));
        std::string got;
        auto reader =
            participant->read(topic, "std_msgs/msg/String", latched, [&](const Reader::Sample &sample) {
                got += ros::fromCdr<ros::String>(sample.cdr)->data;
            });
        QTRY_COMPARE(got, std::string("new"));
    }
};
