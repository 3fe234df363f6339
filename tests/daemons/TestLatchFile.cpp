#include "daemons/motorcontrol/LatchFile.h"

#include <QTemporaryDir>

using namespace hermes;
using motorcontrol::LatchFile;

/// Which motor control begins with the emergency stop of one that was killed.
class TestLatchFile : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void init() {
        folder_ = std::make_unique<QTemporaryDir>();
        qputenv("STATE_DIRECTORY", folder_->path().toUtf8());
    }
    void cleanup() { qunsetenv("STATE_DIRECTORY"); }

    void itIsThatOfTheRobot_data() {
        QTest::addColumn<QString>("settingsFile");
        QTest::addColumn<QString>("listen");
        QTest::addColumn<QString>("line");
        QTest::addColumn<bool>("isKept");
        const QString file = "/etc/hermes/motors.json", port = "tcp://127.0.0.1:7420",
                      line = "serial:///dev/ttyACM0?baud=115200";
        QTest::newRow("the same") << file << port << line << true;
        QTest::newRow("another file") << "other" << port << line << true;
        QTest::newRow("the file alone") << file << "tcp://127.0.0.1:7421"
                                        << "tcp://10.0.0.2:4000" << true;
        QTest::newRow("the port alone") << ""
                                        << "tls://0.0.0.0:7420"
                                        << "serial:///dev/ttyUSB1" << true;
        QTest::newRow("the line alone") << ""
                                        << "tcp://127.0.0.1:1"
                                        << "serial:///dev/ttyACM0?baud=9600" << true;
        QTest::newRow("nothing") << "other"
                                 << "tcp://127.0.0.1:7421"
                                 << "serial:///dev/ttyACM1" << false;
        QTest::newRow("no address that lasts") << file << "tcp://127.0.0.1:0" << line << false;
    }
    void itIsThatOfTheRobot() {
        QFETCH(QString, settingsFile);
        QFETCH(QString, listen);
        QFETCH(QString, line);
        QFETCH(bool, isKept);
        killed({"/etc/hermes/motors.json", "tcp://127.0.0.1:7420?protocol=json",
                "serial:///dev/ttyACM0?baud=115200"},
               "emergency stop by\nport 7421");
        LatchFile next;
        next.setPlace(settingsFile, {listen}, {line});
        QVERIFY(next.reserve());
        QCOMPARE(next.read().value_or(QString()),
                 isKept ? QString("emergency stop by port 7421") : QString());
        QVERIFY(next.write(std::nullopt));
        LatchFile first;
        first.setPlace("/etc/hermes/motors.json", {"tcp://127.0.0.1:7420?protocol=json"}, {});
        QCOMPARE(first.read().has_value(), !isKept);
    }

    /// Two robots of one computer, with one settings file: neither takes the other's stop, nor its room.
    void whoRunsKeepsItsOwn() {
        LatchFile first, second, again;
        first.setPlace("file", {"tcp://127.0.0.1:1"}, {"serial:///dev/ttyACM0"});
        second.setPlace("file", {"tcp://127.0.0.1:2"}, {"serial:///dev/ttyACM1"});
        again.setPlace("file", {"tcp://127.0.0.1:1"}, {"serial:///dev/ttyACM0"});
        QVERIFY(first.reserve() && second.reserve());
        QVERIFY(!again.reserve());
        QVERIFY(first.write(QString("stop")) && !second.read());
        QVERIFY(second.write(QString("another")) && second.write(std::nullopt));
        QCOMPARE(again.read().value_or(QString()),
                 "an emergency stop of which nothing is known: " +
                     folder_->filePath("estop/tcp_127.0.0.1_1+serial_dev_ttyACM0"));
        QVERIFY(first.write(std::nullopt) && !again.read());
    }

    /// It is told what it is known by before: the second finds it by the first one's line.
    void itGoesOnWhateverIsSetNext() {
        const QString line = "serial:///dev/ttyACM0";
        killed({{}, "tcp://127.0.0.1:1", line}, "stop");
        killed({{}, "tcp://127.0.0.1:2", line}, {});
        LatchFile c;
        c.setPlace({}, {"tcp://127.0.0.1:1"}, {"serial:///dev/ttyACM1"});
        QCOMPARE(c.read().value_or(QString()), QString("stop"));
        QVERIFY(c.write(std::nullopt));
        LatchFile a;
        a.setPlace({}, {"tcp://127.0.0.1:2"}, {line});
        QVERIFY(!a.read());
    }

    /// Another robot that is simulated here has the same.
    void linesOfSimulatedRobotsDoNotCount() {
        for (const QString &line : {QString("tcp://127.0.0.1:4000"), QString("serial:///dev/pts/0")}) {
            if (line.contains("pts") && !QFile::exists("/dev/pts/0"))
                continue;
            killed({{}, "tcp://127.0.0.1:1", line}, "stop");
            LatchFile next;
            next.setPlace({}, {"tcp://127.0.0.1:2"}, {line});
            QVERIFY(!next.read());
            QFile::remove(folder_->filePath("estop"));
        }
    }

private:
    struct Place {
        QString settingsFile, listen, line;
    };
    /// One that latched this stop, or went on with what it found, and then was killed.
    static void killed(const Place &place, const std::optional<QString> &reason) {
        LatchFile file;
        file.setPlace(place.settingsFile, {place.listen}, {place.line});
        const auto found = file.read();
        QVERIFY(file.write(reason ? reason : found));
    }
    std::unique_ptr<QTemporaryDir> folder_;
};

QTEST_GUILESS_MAIN(TestLatchFile)
#include "TestLatchFile.moc"
