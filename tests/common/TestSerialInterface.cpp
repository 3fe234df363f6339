#include "common/interface/AdapterLatency.h"
#include "common/interface/InterfaceRegistry.h"
#include "common/interface/PtyInterface.h"
#include "common/interface/SerialInterface.h"

#include <termios.h>

using namespace hermes;

// A folder as sysfs has it, and a device that is a link to its port.
static void makeAdapter(const QTemporaryDir &system, const QByteArray &milliseconds) {
    QVERIFY(QDir(system.path()).mkpath("class/tty/ttyUSB7/device"));
    for (const auto &[name, text] : {std::pair("class/tty/ttyUSB7/device/latency_timer", milliseconds),
                                     std::pair("ttyUSB7", QByteArray())}) {
        put(system.filePath(name), text);
    }
    QVERIFY(QFile::link(system.filePath("ttyUSB7"), system.filePath("motors")));
}

/// Serial lines on real pseudo-terminals.
class TestSerialInterface : public QObject {
    Q_OBJECT

    static InterfaceUrl urlOf(const QString &text) { return *InterfaceUrl::parse(text); }

private Q_SLOTS:
    void latencyOfAnAdapterIsLowered() {
        const QTemporaryDir system;
        makeAdapter(system, "16\n");
        const AdapterLatency latency = AdapterLatency::lower(system.filePath("motors"), system.path());
        QCOMPARE(latency.milliseconds, 1);
        QCOMPARE(latency.advice, QString());
        QCOMPARE(AdapterLatency::lower(system.filePath("absent"), system.path()).milliseconds, 0);
        QCOMPARE(AdapterLatency::lower("/dev/null", system.path()).milliseconds, 0);
    }

    void latencyThatMayNotBeLoweredIsTold() {
        const QTemporaryDir system;
        makeAdapter(system, "16\n");
        const QString timer = system.filePath("class/tty/ttyUSB7/device/latency_timer");
        QFile::remove(timer);
        QVERIFY(QFile::link("/proc/sys/kernel/ngroups_max", timer)); // a number that not even root may write
        const AdapterLatency latency = AdapterLatency::lower(system.filePath("motors"), system.path());
        QCOMPARE(latency.milliseconds, 65536);
        QVERIFY2(latency.advice.contains("delays bytes by up to 65536 ms") &&
                     latency.advice.contains(timer) && latency.advice.contains("udev"),
                 qPrintable(latency.advice));
    }

    void init() {
        folder = std::make_unique<QTemporaryDir>();
        link = folder->filePath("devices/motors");
    }

    void carriesBothWays() {
        PtyInterface device(urlOf("pty://" + link), nullptr);
        device.open();
        QVERIFY(device.isOpen());
        QCOMPARE(QFile::symLinkTarget(link), device.device());
        SerialInterface host(urlOf("serial://" + link), nullptr);
        host.open();
        QVERIFY(host.isOpen());
        QByteArray atDevice;
        QByteArray atHost;
        connect(&device, &Interface::received, [&](const QByteArray &bytes) { atDevice += bytes; });
        connect(&host, &Interface::received, [&](const QByteArray &bytes) { atHost += bytes; });
        QVERIFY(host.write("to the device"));
        QVERIFY(device.write("to the host"));
        QTRY_COMPARE(atDevice, QByteArray("to the device"));
        QTRY_COMPARE(atHost, QByteArray("to the host"));
        QCOMPARE(host.counters().bytesIn, quint64(11));
        QCOMPARE(host.counters().bytesOut, quint64(13));
        QCOMPARE(host.bytesToWrite(), qint64(0));
        device.close();
        QVERIFY(!QFileInfo(link).isSymLink());
    }

    void carriesEveryByteInOrder() {
        PtyInterface device(urlOf("pty://" + link), nullptr);
        device.open();
        SerialInterface host(urlOf("serial://" + link), nullptr);
        host.open();
        QByteArray all;
        for (int i = 0; i < 100000; ++i)
            all += char(i * 7 + i / 256); // among them XON, XOFF, CR, LF, 0, 0xFF
        QByteArray atDevice;
        QByteArray atHost;
        connect(&device, &Interface::received, [&](const QByteArray &bytes) { // an echo
            atDevice += bytes;
            QVERIFY(device.write(bytes));
        });
        connect(&host, &Interface::received, [&](const QByteArray &bytes) { atHost += bytes; });
        for (int sent = 0; sent < all.size(); sent += 1000) {
            QVERIFY(host.write(all.mid(sent, 1000)));
            QTRY_COMPARE(atHost.size(), sent + 1000);
        }
        QVERIFY(atDevice == all && atHost == all);
    }

    void takesItsSettings_data() {
        const Rows<QString, int, int> row(
            "options", "speed", "flags"); // flags: of termios c_cflag, but for what a terminal always has
        row("nothing said", "", int(B115200), int(CS8));
        row("baud", "?baud=38400", int(B38400), int(CS8));
        row("stop bits", "?stop_bits=2&baud=9600", int(B9600), int(CS8 | CSTOPB));
        row("hardware flow", "?flow=hardware", int(B115200), int(CS8 | CRTSCTS));
    }

    void takesItsSettings() {
        QFETCH(QString, options);
        PtyInterface device(urlOf("pty://" + link), nullptr);
        device.open();
        SerialInterface host(urlOf("serial://" + link + options), nullptr);
        host.open();
        QVERIFY(host.isOpen());
        const int fd = ::open(QFile::encodeName(device.device()).constData(), O_RDWR | O_NOCTTY);
        termios found{};
        if (fd >= 0) { // as root; others are kept out while the line is in use
            QCOMPARE(tcgetattr(fd, &found), 0);
            ::close(fd);
            QTEST(int(cfgetospeed(&found)), "speed");
            QTEST(int(found.c_cflag & (CSIZE | CSTOPB | CRTSCTS)), "flags");
        } else {
            QCOMPARE(errno, EBUSY);
        }
    }

    void knowsHowFastItIs_data() {
        const Rows<QString, double> row("options", "bytesPerSecond");
        row("usual", "", 11520.0);
        row("baud", "?baud=9600", 960.0);
        row("longer frames", "?baud=57600&parity=even&stop_bits=2", 4800.0);
        row("shorter frames", "?baud=9600&data_bits=6", 1200.0);
        row("slow radio", "?baud=57600&pace=19200", 1920.0);
        row("fast radio", "?baud=9600&pace=19200", 960.0);
    }

    void knowsHowFastItIs() {
        FETCH(QString, options, double, bytesPerSecond);
        QCOMPARE(SerialInterface(urlOf("serial://" + link + options), nullptr).bytesPerSecond(),
                 bytesPerSecond);
    }

    void wrongSettingsAreNamed_data() {
        const Rows<QString, QString> row("options", "message");
        row("baud text", "?baud=fast", "baud \"fast\" is not a number above 0");
        row("baud negative", "?baud=-1", "baud \"-1\"");
        row("baud zero", "?baud=0", "baud \"0\"");
        row("pace", "?pace=0", "pace \"0\" is not a number above 0");
        row("data bits", "?data_bits=9", "data_bits is \"9\", expected one of: 5, 6, 7, 8");
        row("parity", "?parity=maybe", "parity is \"maybe\", expected one of: none, even, odd");
        row("stop bits", "?stop_bits=3", "stop_bits is \"3\", expected one of: 1, 2");
        row("flow", "?flow=rts", "flow is \"rts\", expected one of: none, hardware, software");
    }

    void wrongSettingsAreNamed() {
        FETCH(QString, options, QString, message);
        PtyInterface device(urlOf("pty://" + link), nullptr);
        device.open();
        SerialInterface host(urlOf("serial://" + link + options), nullptr);
        QSignalSpy closed(&host, &Interface::closed);
        host.open();
        QCOMPARE(closed.count(), 1);
        const QString reason = closed[0][0].toString();
        QVERIFY2(reason.contains(message) && reason.contains(link), qPrintable(reason));
        QCOMPARE(host.counters().errors, quint64(1));
    }

    void missingDeviceIsNamed() {
        for (const QString &url : {QString("serial://" + link), QString("serial://")}) {
            SerialInterface host(urlOf(url), nullptr);
            QSignalSpy closed(&host, &Interface::closed);
            host.open();
            QCOMPARE(closed.count(), 1);
            const QString reason = closed[0][0].toString();
            QVERIFY2(reason.contains(url) &&
                         (reason.contains("no such device") || reason.contains("missing")),
                     qPrintable(reason));
            QVERIFY(!host.write("x"));
        }
    }

    void fileIsNoDevice() {
        QFile file(folder->filePath("file"));
        QVERIFY(file.open(QIODevice::WriteOnly));
        SerialInterface host(urlOf("serial://" + file.fileName()), nullptr);
        QSignalSpy closed(&host, &Interface::closed);
        host.open();
        QCOMPARE(closed.count(), 1);
        VERIFY_STARTS(closed[0][0].toString(), "cannot open serial://" + file.fileName() + ": ");
    }

    void pulledLineIsNamedAndFoundAgain() {
        PtyInterface device(urlOf("pty://" + link), nullptr);
        device.open();
        SerialInterface host(urlOf("serial://" + link), nullptr);
        host.setReconnecting(true);
        host.open();
        QVERIFY(host.isOpen());
        for (quint64 round = 1; round <= 5; ++round) {
            QSignalSpy closed(&host, &Interface::closed);
            device.close();
            QTRY_VERIFY(closed.count() > 0);
            VERIFY_CONTAINS(closed[0][0].toString(), "serial://" + link);
            QVERIFY(!host.isOpen());
            QTRY_VERIFY(closed.count() > 1); // a try in vain
            QVERIFY(closed[1][0].toString().contains("no such device"));
            device.open(); // another pseudo-terminal under the same link
            QTRY_VERIFY(host.isOpen());
            QCOMPARE(host.counters().opened, round + 1);
            QSignalSpy received(&device, &Interface::received);
            QVERIFY(host.write("again"));
            QTRY_COMPARE(received.count(), 1);
        }
        host.close();
        QCOMPARE(host.state(), Interface::State::Closed);
    }

    void whatCameBeforeIsDropped() {
        PtyInterface device(urlOf("pty://" + link), nullptr);
        device.open();
        while (device.write(QByteArray(512, 'o'))) // until the system takes no more
            ;
        QVERIFY(device.isOpen());
        SerialInterface host(urlOf("serial://" + link), nullptr);
        QByteArray atHost;
        connect(&host, &Interface::received, [&](const QByteArray &bytes) { atHost += bytes; });
        host.open();
        QVERIFY(host.isOpen());
        bool written = false;
        QTRY_VERIFY(written || (written = device.write("new")));
        QTRY_VERIFY(atHost.contains("new"));
        QCOMPARE(atHost, QByteArray("new"));
    }

    void nearEndOpensAgainAfterAKill() {
        PtyInterface device(urlOf("pty://" + link), nullptr);
        device.open();
        SerialInterface first(urlOf("serial://" + link), nullptr);
        first.open();
        QSignalSpy received(&device, &Interface::received);
        first.write("claimed");
        QTRY_COMPARE(received.count(), 1);
        // What a killed program leaves is an open near end that nobody gave back.
        const int fd = ::open(QFile::encodeName(device.device()).constData(), O_RDWR | O_NOCTTY);
        QVERIFY2(fd >= 0, strerror(errno));
        ::close(fd);
    }

    void linkReplacesAnOldOneOnly() {
        QVERIFY(QDir().mkpath(folder->filePath("devices")));
        QVERIFY(QFile::link("/nonexistent", link));
        PtyInterface device(urlOf("pty://" + link), nullptr);
        device.open();
        QVERIFY(device.isOpen());
        device.close();
        QFile file(link);
        QVERIFY(file.open(QIODevice::WriteOnly));
        QSignalSpy closed(&device, &Interface::closed);
        device.open();
        QCOMPARE(closed.count(), 1);
        QVERIFY(closed[0][0].toString().contains(link) && closed[0][0].toString().contains("not a link"));
        QVERIFY(file.exists());
    }

    void registryKnowsBoth() {
        const auto serial = makeInterface(urlOf("serial:///dev/ttyS99"), this);
        QVERIFY(serial);
        QVERIFY(qobject_cast<SerialInterface *>(*serial));
        QVERIFY(!isOpenToNetwork(urlOf("serial:///dev/ttyS99")));
        QVERIFY(interfaceSchemes().contains("serial") && interfaceSchemes().contains("pty"));
    }

private:
    std::unique_ptr<QTemporaryDir> folder;
    QString link;
};
