#include "common/settings/DottedPath.h"
#include "daemons/supervisor/LidarProbe.h"
#include "daemons/supervisor/SettingsFiles.h"
#include "daemons/supervisor/SetupProposal.h"
#include "protocol/velodyne/SensorModel.h"
#include "tests/support/FreePort.h"

#include <future>

using namespace hermes;
using namespace hermes::supervisor;

static FoundSerial controllers(const QString &path, std::vector<int> addresses, bool anyAddress = false) {
    return {path, path, {}, "roboclaw", "RoboClaw", 115200, std::move(addresses), anyAddress, false};
}

/// "PATH ADDRESS" of both controllers in settings.
static QStringList numbered(const QJsonObject &settings) {
    QStringList both;
    for (const char *number : {"1", "2"}) {
        const QJsonValue one = settings["motorcontrol"]["controllers"][QLatin1String(number)];
        both.append(
            QString("%1 %2").arg(one["url"].toString().section('?', 0, 0)).arg(one["address"].toInt()));
    }
    return both;
}

static QJsonObject json(const char *text) {
    return QJsonDocument::fromJson(text).object();
}

Q_DECLARE_METATYPE(std::vector<hermes::FoundSerial>)

/// What setup makes of what was found, and how it writes it.
class TestSetup : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void twoControllersOnOneLine();
    void twoControllersOnUsb();
    void whichIsWhichStaysAsItIs_data();
    void whichIsWhichStaysAsItIs();
    void moreThanTwoControllersAreNotChosenFrom();
    void whatIsSimulatedIsNoRobot();
    void oneControllerIsNoRobot();
    void oneOfAnotherKindIs_data();
    void oneOfAnotherKindIs();
    void receiversAreAddedOnce();
    void lidarAndProcesses();
    void writesAndPutsBack();
    void writesOnlyWhatItCanReadAgain();
    void replacesNoPipe();
    void samplesNameTheFolder();
    void aFloodDoesNotHoldUpTheSearchForLidars();
};

void TestSetup::twoControllersOnOneLine() {
    const auto proposal = propose({{controllers("/dev/a", {0x80, 0x81})}, {}, {}, {}}, {}, "/etc/hermes");
    QCOMPARE(proposal.settings["motorcontrol"].toObject(),
             json(R"({"controllers": {"1": {"url": "serial:///dev/a?baud=115200", "address": 128},
                                      "2": {"url": "serial:///dev/a?baud=115200", "address": 129}}})"));
}

void TestSetup::twoControllersOnUsb() {
    const std::vector<int> all{128, 129, 130, 131, 132, 133, 134, 135};
    const auto proposal =
        propose({{controllers("/dev/a", all, true), controllers("/dev/b", all, true)}, {}, {}, {}}, {},
                "/etc/hermes");
    QCOMPARE(proposal.settings["motorcontrol"].toObject(),
             json(R"({"controllers": {"1": {"url": "serial:///dev/a?baud=115200", "address": 128},
                                      "2": {"url": "serial:///dev/b?baud=115200", "address": 128}}})"));
}

void TestSetup::whichIsWhichStaysAsItIs_data() {
    Rows<QByteArray, std::vector<FoundSerial>, QStringList>("settings", "lines",
                                                            "expected"); // settings: of the controllers
    const std::vector<int> all{128, 129, 130, 131, 132, 133, 134, 135};
    const std::vector<FoundSerial> two{controllers("/dev/a", {128}), controllers("/dev/b", {128})};
    const QStringList exchanged{"serial:///dev/b 128", "serial:///dev/a 128"};
    QTest::newRow("the first is found last")
        << QByteArray(R"({"1": {"url": "serial:///dev/b?baud=115200"}})") << two << exchanged;
    QTest::newRow("the second is found first")
        << QByteArray(R"({"1": {"url": "serial:///dev/c"}, "2": {"url": "serial:///dev/a", "address": 128}})")
        << two << exchanged;
    QTest::newRow("one line, as it was written")
        << QByteArray(R"({"1": {"url": "serial:///dev/a?baud=115200", "address": 128},
                          "2": {"url": "serial:///dev/a?baud=115200", "address": 129}})")
        << std::vector<FoundSerial>{controllers("/dev/a", {128, 129})}
        << QStringList{"serial:///dev/a 128", "serial:///dev/a 129"};
    QTest::newRow("one line, the other way round")
        << QByteArray(R"({"1": {"url": "serial:///dev/a", "address": 129},
                          "2": {"url": "serial:///dev/a", "address": 128}})")
        << std::vector<FoundSerial>{controllers("/dev/a", {128, 129})}
        << QStringList{"serial:///dev/a 129", "serial:///dev/a 128"};
    QTest::newRow("the first by default") // as the sample mecanum has it
        << QByteArray(R"({"2": {"url": "serial:///dev/ttyACM1?baud=115200", "address": 128}})")
        << std::vector<FoundSerial>{controllers("/dev/ttyACM1", all, true),
                                    controllers("/dev/ttyACM0", all, true)}
        << QStringList{"serial:///dev/ttyACM0 128", "serial:///dev/ttyACM1 128"};
    QTest::newRow("without a baud rate")
        << QByteArray(R"({"1": {"url": "serial:///dev/b"}, "2": {"url": "serial:///dev/a", "address": 130}})")
        << std::vector<FoundSerial>{controllers("/dev/a", all, true), controllers("/dev/b", all, true)}
        << QStringList{"serial:///dev/b 128", "serial:///dev/a 130"};
}

void TestSetup::whichIsWhichStaysAsItIs() {
    FETCH(const QByteArray, settings, const std::vector<FoundSerial>, lines, const QStringList, expected);
    const QJsonObject base{
        {"motorcontrol", QJsonObject{{"controllers", QJsonDocument::fromJson(settings).object()}}}};
    const QJsonObject then = merged(base, propose({lines, {}, {}, {}}, base, "/etc/hermes").settings);
    QCOMPARE(numbered(then), expected);
    const QJsonObject again = propose({lines, {}, {}, {}}, then, "/etc/hermes").settings;
    QVERIFY2(again.isEmpty(), QJsonDocument(again).toJson().constData());
}

void TestSetup::moreThanTwoControllersAreNotChosenFrom() {
    const std::vector<FoundSerial> three{controllers("/dev/a", {128}), controllers("/dev/b", {128}),
                                         controllers("/dev/c", {128})};
    const auto proposal = propose({three, {}, {}, {}}, {}, "/etc/hermes");
    QVERIFY(proposal.settings.isEmpty());
    QVERIFY2(proposal.notes.first().contains("3 RoboClaws"), qPrintable(proposal.notes.join('\n')));
    const QJsonObject known = json(R"({"motorcontrol": {"controllers": {"1": {"url": "serial:///dev/c"},
                                       "2": {"url": "serial:///dev/a", "address": 128}}}})");
    QCOMPARE(numbered(merged(known, propose({three, {}, {}, {}}, known, "/etc/hermes").settings)),
             (QStringList{"serial:///dev/c 128", "serial:///dev/a 128"}));
}

void TestSetup::whatIsSimulatedIsNoRobot() {
    FoundSerial motors = controllers("/run/hermes/motors", {128, 129});
    motors.simulated = true;
    FoundLidar lidar{"127.0.0.1", "HDL-32E", "hdl32e", 2368, 1800, true, true};
    const QJsonObject simulator =
        json(R"({"supervisor": {"processes": [{"name": "simulator", "autostart": true}]}})");
    const Findings alone{{motors}, {lidar}, {}, {}};
    const QStringList numbers{"serial:///run/hermes/motors 128", "serial:///run/hermes/motors 129"};
    QCOMPARE(numbered(propose(alone, simulator, "/etc/hermes").settings), numbers);
    QVERIFY(propose(alone, {}, "/etc/hermes").settings.isEmpty()); // as that of another sample
    const Findings beside{{motors, controllers("/dev/a", {128, 129})}, {lidar}, {}, {}};
    const auto proposal = propose(beside, simulator, "/etc/hermes");
    QCOMPARE(numbered(proposal.settings), (QStringList{"serial:///dev/a 128", "serial:///dev/a 129"}));
    QVERIFY(!proposal.settings.contains("velodynelogger"));
    QVERIFY2(proposal.notes.first().contains("the simulator starts"), qPrintable(proposal.notes.join('\n')));
}

void TestSetup::oneControllerIsNoRobot() {
    const auto proposal = propose({{controllers("/dev/a", {128})}, {}, {}, {}}, {}, "/etc/hermes");
    QVERIFY(proposal.settings.isEmpty());
    QVERIFY2(proposal.notes.first().contains("1 RoboClaws were found, two drive a robot"),
             qPrintable(proposal.notes.join('\n')));
    const auto none = propose({{}, {}, {}, {}}, {}, "/etc/hermes");
    QVERIFY2(none.notes.first().contains("no motor controllers were found"),
             qPrintable(none.notes.join('\n')));
}

void TestSetup::oneOfAnotherKindIs_data() {
    const Rows<QString, double> row("kind", "timeout_s");
    row("arduino", "arduino", 2);
    row("vesc", "vesc", 1);
    row("opencr", "opencr", 0.5);
    row("roboteq", "roboteq", 0.2);
}

void TestSetup::oneOfAnotherKindIs() {
    FETCH(QString, kind, double, timeout_s);
    FoundSerial line = controllers("/dev/a", {});
    line.kind = kind;
    const QJsonObject motors =
        propose({{line}, {}, {}, {}}, {}, "/etc/hermes").settings["motorcontrol"].toObject();
    const QJsonObject expected{
        {"kind", kind}, {"timeout_s", timeout_s}, {"1", QJsonObject{{"url", "serial:///dev/a?baud=115200"}}}};
    QCOMPARE(motors["controllers"].toObject(), expected);
    QCOMPARE(motors["frame"]["layout"].toString(), QString("two_wheels"));
    const QJsonObject counted =
        merged({{"motorcontrol", motors}}, json(R"({"motorcontrol": {"controllers": {"count": 1}}})"));
    const auto back = propose({{controllers("/dev/a", {0x80, 0x81})}, {}, {}, {}}, counted, "/etc/hermes");
    const QJsonObject then = merged(counted, back.settings)["motorcontrol"].toObject();
    QCOMPARE(then["controllers"]["kind"].toString(), QString("roboclaw"));
    QCOMPARE(then["controllers"]["timeout_s"].toDouble(), 0.2);
    QCOMPARE(then["controllers"]["count"].toInt(-1), 0);
    QCOMPARE(then["frame"]["layout"].toString(), QString("two_wheels"));
}

void TestSetup::receiversAreAddedOnce() {
    FoundSerial receiver{"/dev/g", "/dev/g", {}, "nmea", "$GPGGA", 9600, {}, false, false};
    const QJsonObject base =
        json(R"({"seriallogger": {"ports": [{"name": "gps", "url": "tcp://10.0.0.1:4001"}]}})");
    const auto proposal = propose({{receiver}, {}, {}, {}}, base, "/etc/hermes");
    const QJsonArray ports = proposal.settings["seriallogger"]["ports"].toArray();
    QCOMPARE(ports.size(), 2);
    QCOMPARE(ports[1].toObject(),
             json(R"({"name": "gps2", "url": "serial:///dev/g?baud=9600", "view": "nmea"})"));
    const QJsonObject then{{"seriallogger", proposal.settings["seriallogger"]}};
    QVERIFY(!propose({{receiver}, {}, {}, {}}, then, "/etc/hermes").settings.contains("seriallogger"));
    // Under another name of the same device, and at another baud rate.
    const QTemporaryDir folder;
    QFile device(folder.filePath("device"));
    QVERIFY(device.open(QIODevice::WriteOnly) && device.link(folder.filePath("name")));
    receiver.path = folder.filePath("name");
    receiver.device = QFileInfo(folder.filePath("device")).canonicalFilePath();
    const QJsonObject named{
        {"seriallogger",
         QJsonObject{{"ports", QJsonArray{QJsonObject{{"url", "serial://" + receiver.device}}}}}}};
    QVERIFY(!propose({{receiver}, {}, {}, {}}, named, "/etc/hermes").settings.contains("seriallogger"));
}

void TestSetup::lidarAndProcesses() {
    const FoundLidar lidar{"192.168.1.201", "VLP-16", "vlp16", 2368, 754, true, false};
    const QJsonObject base = json(
        R"({"supervisor": {"processes": [{"name": "scanmatcher", "arguments": ["--config", "/a.json"]}]}})");
    const auto proposal = propose({{}, {lidar}, {}, {}}, base, "/srv/h");
    QCOMPARE(proposal.settings["velodynelogger"].toObject(), json(R"({"decode": {"model": "vlp16"}})"));
    QCOMPARE(
        proposal.settings["supervisor"]["processes"].toArray(),
        json(R"({"all": [{"name": "scanmatcher", "arguments": ["--config", "/a.json"], "autostart": true},
                              {"name": "velodynelogger", "arguments": ["--config", "/srv/h/velodynelogger.json"],
                               "autostart": true}]})")["all"]
            .toArray());
}

void TestSetup::writesAndPutsBack() {
    const QTemporaryDir folder;
    const SettingsFiles files(folder.path(), folder.path());
    QVERIFY(!files.undo().ok());
    QCOMPARE(files.write({{"scanmatcher", json(R"({"a": 1})")}}).value(),
             QStringList(files.path("scanmatcher")));
    QVERIFY(files.write({{"scanmatcher", json(R"({"a": 2})")}, {"simulator", json(R"({"b": 1})")}}).ok());
    QCOMPARE(files.current().value(), json(R"({"scanmatcher": {"a": 2}, "simulator": {"b": 1}})"));
    QCOMPARE(files.undoable().size(), 2);
    QVERIFY(files.undo().ok());
    QCOMPARE(files.current().value(), json(R"({"scanmatcher": {"a": 1}, "simulator": {}})"));
    QVERIFY(files.undoable().isEmpty());
    QCOMPARE(QJsonDocument::fromJson(contentOf(files.path("scanmatcher") + ".undone")).object(),
             json(R"({"a": 2})"));
    // One that cannot be written: nothing changes, what can be undone neither.
    QVERIFY(files.write({{"scanmatcher", json(R"({"a": 3})")}}).ok());
    QVERIFY(QDir().mkdir(files.path("supervisor")));
    const auto half =
        files.write({{"scanmatcher", json(R"({"a": 4})")}, {"supervisor", json(R"({"b": 2})")}});
    QVERIFY(!half.ok() && half.error().message.contains("supervisor.json"));
    QVERIFY(QDir().rmdir(files.path("supervisor")));
    QCOMPARE(files.current().value(), json(R"({"scanmatcher": {"a": 3}, "simulator": {}})"));
    QCOMPARE(files.undoable(), QStringList("scanmatcher"));
    QVERIFY(files.undo().ok());
    QCOMPARE(files.current().value(), json(R"({"scanmatcher": {"a": 1}, "simulator": {}})"));
    const SettingsFiles nowhere(folder.filePath("none"), {});
    const auto refused = nowhere.write({{"scanmatcher", QJsonObject()}});
    QVERIFY(!refused.ok() && refused.error().message.contains("none/scanmatcher.json"));
}

void TestSetup::writesOnlyWhatItCanReadAgain() {
    const QTemporaryDir folder;
    const SettingsFiles files(folder.path(), folder.path());
    const auto large = files.write(
        {{"scanmatcher", json(R"({"a": 1})")}, {"simulator", QJsonObject{{"a", QString(1 << 20, 'x')}}}});
    QVERIFY(!large);
    VERIFY_CONTAINS(large.error().message, "simulator.json: it would have 1048");
    QCOMPARE(files.current().value(), QJsonObject());
}

void TestSetup::replacesNoPipe() {
    const QTemporaryDir folder;
    const SettingsFiles files(folder.path(), folder.path());
    const auto makePipe = [](const QString &path) {
        QFile::remove(path);
        return ::mkfifo(QFile::encodeName(path), 0600) == 0;
    };
    const auto isRefused = [](const Result<QStringList> &result) {
        return !result && result.error().message.contains("not a regular file");
    };
    const QJsonObject some{{"scanmatcher", json(R"({"a": 1})")}};
    const QString pipe = folder.filePath("pipe"), own = files.path("scanmatcher");
    QVERIFY(makePipe(pipe) && QFile::link(pipe, own));
    QVERIFY(isRefused(files.write(some)));
    QVERIFY(QFile::remove(own) && files.write(some).ok());
    QVERIFY(QFile::remove(own) && QFile::link(pipe, own));
    QVERIFY(isRefused(files.undo()));
    QVERIFY(!QFileInfo(pipe).isFile() && QFileInfo::exists(pipe));
    QCOMPARE(files.undoable(), QStringList("scanmatcher"));
    QVERIFY(QFile::remove(own) && files.undo().ok());
    QVERIFY(makePipe(own + ".previous"));
    QVERIFY(isRefused(files.write(some)));
    QVERIFY(!QFileInfo(own + ".previous").isFile());
    // Of what tells that it was cut off
    QVERIFY(QFile::remove(own + ".previous") && files.write(some).ok());
    QVERIFY(makePipe(folder.filePath("setup.unfinished")));
    QVERIFY(isRefused(files.undo()));
}

void TestSetup::samplesNameTheFolder() {
    const QTemporaryDir folder;
    QVERIFY(QDir(folder.path()).mkpath("samples/one"));
    put(folder.filePath("samples/one/supervisor.json"),
        R"({"processes": [{"name": "simulator", "arguments": ["--config", "/etc/hermes/simulator.json"]}]})");
    const SettingsFiles files(folder.path(), folder.filePath("samples"));
    QCOMPARE(files.sampleNames(), QStringList("one"));
    const QJsonObject sample = *files.sample("one");
    QCOMPARE(sample["supervisor"]["processes"][0]["arguments"][1].toString(),
             folder.filePath("simulator.json"));
    const auto missing = files.sample("two");
    QVERIFY(!missing.ok() && missing.error().message.contains("expected one of: one"));
}

void TestSetup::aFloodDoesNotHoldUpTheSearchForLidars() {
    const quint16 port = reservePort();
    std::atomic<bool> isOver{false};
    std::vector<std::future<void>> senders;
    for (int i = 0; i < 3; ++i)
        senders.push_back(std::async(std::launch::async, [&isOver, port] {
            QUdpSocket socket;
            const QByteArray packet(velodyne::packetSize, '\xff');
            while (!isOver)
                socket.writeDatagram(packet, QHostAddress::LocalHost, port);
        }));
    const std::atomic<bool> isCancelled{false};
    QStringList problems;
    auto took = runningTimer();
    auto search = std::async(std::launch::async,
                             [&] { return LidarProbe(port, reservePort(), isCancelled).run(problems); });
    const bool hasEnded = search.wait_for(std::chrono::seconds(10)) == std::future_status::ready;
    isOver = true;
    const auto found = search.get();
    QVERIFY2(hasEnded, saying("the search took %1 ms", took.elapsed()));
    QVERIFY2(problems.isEmpty(), qPrintable(problems.join('\n')));
    QCOMPARE(int(found.size()), 1);
    QVERIFY2(found[0].rate_hz > 3000, saying(found[0].rate_hz));
}
