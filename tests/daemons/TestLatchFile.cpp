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
        LatchFile first;
        first.setPlace("/etc/hermes/motors.json", {"tcp://127.0.0.1:7420?protocol=json"},
                       {"serial:///dev/ttyACM0?baud=115200"});
        QVERIFY(first.reserve());
        QVERIFY(!first.read());
        QVERIFY(first.write(QString("emergency stop by\nport 7421")));
        LatchFile next;
        next.setPlace(settingsFile, {listen}, {line});
        QVERIFY(next.reserve());
        QCOMPARE(next.read().value_or(QString()),
                 isKept ? QString("emergency stop by port 7421") : QString());
        QVERIFY(next.write(std::nullopt));
        QCOMPARE(first.read().has_value(), !isKept);
    }

    /// It is told what it is known by before: the second finds it by the first one's line.
    void itGoesOnWhateverIsSetNext() {
        const QStringList usual{"serial:///dev/ttyACM0"};
        LatchFile a, b, c;
        a.setPlace({}, {"tcp://127.0.0.1:1"}, usual);
        b.setPlace({}, {"tcp://127.0.0.1:2"}, usual);
        c.setPlace({}, {"tcp://127.0.0.1:1"}, {"serial:///dev/ttyACM1"});
        QVERIFY(a.write(QString("stop")) && b.read());
        QVERIFY(b.write(b.read()));
        QCOMPARE(c.read().value_or(QString()), QString("stop"));
        QVERIFY(c.write(std::nullopt));
        QVERIFY(!a.read() && !b.read());
    }

    /// Another robot that is simulated here has the same.
    void linesOfSimulatedRobotsDoNotCount() {
        for (const QString &line : {QString("tcp://127.0.0.1:4000"), QString("serial:///dev/pts/0")}) {
            if (line.contains("pts") && !QFile::exists("/dev/pts/0"))
                continue;
            LatchFile first, next;
            first.setPlace({}, {"tcp://127.0.0.1:1"}, {line});
            next.setPlace({}, {"tcp://127.0.0.1:2"}, {line});
            QVERIFY(first.write(QString("stop")));
            QVERIFY(!next.read());
            QVERIFY(first.write(std::nullopt));
        }
    }

private:
    std::unique_ptr<QTemporaryDir> folder_;
};

QTEST_GUILESS_MAIN(TestLatchFile)
#include "TestLatchFile.moc"
