#include "tests/gui/desktop/FakeDaemon.h"
#include "tests/gui/desktop/LayoutWindow.h"

#include <QComboBox>
#include <QRandomGenerator>
#include <QSettings>
#include <csignal>
#include <sys/resource.h>

using namespace hermes;
using namespace hermes::desktop;

/// Layouts of the window and robots, kept in a file that may be anything.
class TestLayouts : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void init();
    void savedSwitchedAndDeletedByHand();
    void badNamesAreTold();
    void switchingDropsNoConnectionAndNoBanner();
    void robotsAreKept();
    void anyFile_data();
    void anyFile();
    void anyState();
    void whatCannotBeWrittenIsTold();

private:
    QByteArray content() const {
        QFile file(file_);
        return file.open(QIODevice::ReadOnly) ? file.readAll() : QByteArray();
    }
    void write(const QByteArray &bytes) const {
        QFile file(file_);
        QVERIFY(file.open(QIODevice::WriteOnly) && file.write(bytes) == bytes.size());
    }

    std::unique_ptr<QTemporaryDir> folder_;
    QString file_;
};

void TestLayouts::init() {
    folder_ = std::make_unique<QTemporaryDir>();
    file_ = folder_->filePath("new/gui.ini");
}

void TestLayouts::savedSwitchedAndDeletedByHand() {
    const QJsonObject plotted{{"daemon", "127.0.0.1:1"}, {"topic", "a"}, {"field", "b"}};
    {
        LayoutWindow one(file_, {"127.0.0.1:1"});
        QVERIFY(one.dock("drive")->isVisible());
        one.saveAs("Bench & desk");
        one.dock("drive")->hide();
        one.window->findChild<PlotsPanel *>()->setState({{"panes", QJsonArray{QJsonArray{plotted}}}});
        one.pick("layout Usual");
        QTRY_VERIFY(one.dock("drive")->isVisible());
        QVERIFY(one.plots().isEmpty()); // they are of the other one
        one.pick("layout Bench & desk");
        QTRY_VERIFY(!one.dock("drive")->isVisible());
        one.window->close();
    }
    LayoutWindow next(file_);
    QVERIFY(!next.dock("drive")->isVisible());
    QCOMPARE(next.window->layouts().names(), QStringList({"Usual", "Bench & desk"}));
    QCOMPARE(next.window->layouts().current(), QString("Bench & desk"));
    QCOMPARE(next.plots(), QJsonArray{plotted});
    next.pick("resetLayout");
    QTRY_VERIFY(next.dock("drive")->isVisible());
    next.pick("removeLayout");
    QCOMPARE(next.window->layouts().names(), QStringList("Usual"));
    Q_EMIT next.menu().aboutToShow();
    auto *const removal = qobject_cast<QMenu *>(next.menu().findChild<QAction *>("removeLayout")->parent());
    QVERIFY(removal && !removal->menuAction()->isEnabled()); // the last
    QCOMPARE(next.notice(), QString());
}

void TestLayouts::badNamesAreTold() {
    LayoutWindow one(file_, {"127.0.0.1:1"});
    one.saveAs("  ");
    QCOMPARE(one.notice(), QString("A layout needs a name."));
    one.saveAs("Usual");
    QCOMPARE(one.notice(), QString("There is a layout Usual already."));
    for (int i = 1; i < Layouts::most; ++i)
        one.saveAs(QString("%1\n\u202e").arg(i) + QString(10000, 'x'));
    QCOMPARE(one.window->layouts().names().size(), Layouts::most);
    one.saveAs("one more");
    QVERIFY2(one.notice().startsWith("There are 50 layouts"), qPrintable(one.notice()));
    for (const QString &name : one.window->layouts().names())
        QVERIFY(name.size() <= Layouts::longestName && !name.contains('\n'));
}

void TestLayouts::switchingDropsNoConnectionAndNoBanner() {
    Mischief motors;
    motors.isMotors = true;
    motors.hasTopics = false;
    const FakeDaemon daemon(motors);
    LayoutWindow one(file_, {QString("127.0.0.1:%1").arg(daemon.port())});
    QTRY_VERIFY(one.drive->isPossible());
    one.saveAs("other");
    DaemonLink *const link = one.fleet.robot()->daemons().front();
    QSignalSpy lost(&link->client(), &Client::disconnected);
    one.drive->stop();
    auto *const banner = one.window->findChild<QLabel *>("stopBanner");
    QTRY_VERIFY(banner->isVisible());
    for (const char *const next : {"layout Usual", "layout other", "resetLayout", "removeLayout"}) {
        one.pick(next); // in none of which there was a banner when it was kept
        QVERIFY2(banner->isVisible() && one.isWhole(), next);
        QVERIFY(one.drive->isStopped());
    }
    QCOMPARE(lost.count(), 0);
    QVERIFY(link->isConnected());
}

void TestLayouts::robotsAreKept() {
    Mischief supervisor;
    supervisor.topics["processes"] = R"({"robot":"rover","processes":[]})";
    const FakeDaemon one(supervisor), other(supervisor);
    const auto address = [](const FakeDaemon &daemon) { return QString("127.0.0.1:%1").arg(daemon.port()); };
    {
        LayoutWindow first(file_, {address(one), address(other)});
        QTRY_VERIFY(first.fleet.robotAt(address(one)) && first.fleet.robotAt(address(other)));
        first.fleet.rename(*first.fleet.robotAt(address(other)), "Blue, \"the\" second; [x]");
        first.fleet.choose(first.fleet.robotAt(address(other)));
        first.saveAs("desk");
        QTRY_COMPARE(Layouts(file_).robots().names.size(), 1); // before it is closed
    }
    LayoutWindow next(file_);
    QTRY_VERIFY(next.fleet.robotAt(address(other)) && next.fleet.robotAt(address(one)));
    QCOMPARE(next.fleet.robot(), next.fleet.robotAt(address(other)));
    QCOMPARE(next.fleet.robot()->name(), QString("Blue, \"the\" second; [x]"));
    next.pick("layout Usual");
    QCOMPARE(int(next.fleet.robots().size()), 2); // robots are of no layout
    QCOMPARE(next.window->findChild<QComboBox *>("robots")->currentText(), next.fleet.robot()->name());
}

void TestLayouts::anyFile_data() {
    QTest::addColumn<QByteArray>("bytes");
    QTest::addColumn<bool>("isOurs");
    QByteArray noise(10 << 20, 0);
    QRandomGenerator random(1);
    for (char &c : noise)
        c = char(random.bounded(256));
    QTest::newRow("empty") << QByteArray() << true;
    QTest::newRow("10 MB of noise") << noise << false;
    QTest::newRow("a little noise") << noise.left(1000) << false;
    QTest::newRow("10 MB of lines") << QByteArray("[window]\n") + QByteArray("a=b\n").repeated(2 << 20)
                                    << false;
    QTest::newRow("one long line") << "[window]\na=" + QByteArray(1000000, 'x') << true;
    QTest::newRow("another program's") << QByteArray("[Desktop Entry]\nName=x\n") << false;
    QTest::newRow("a text") << QByteArray("Dear diary,\ntoday I drove.\n") << false;
    QTest::newRow("types of Qt") << QByteArray("[window]\nstate=@Variant(\\0\\0\\0\\b\\xff\\xff\\xff\\xff)\n")
                                 << false;
    QTest::newRow("wrong types") << QByteArray(
                                        "[window]\ngeometry=1, 2, 3\nstate=@Rect(1 2 3 4)\nlayout=7, 8\n"
                                        "[layouts]\nsize=many\n1\\name=a, b\n[robots]\naddresses=5\nnames=x\n"
                                        "chosen=1, 2\n")
                                 << true;
    QTest::newRow("more than there are")
        << QByteArray("[layouts]\nsize=2000000000\n1\\name=x\n1\\state=@ByteArray(\\0\\0\\0\\xff)\n"
                      "1\\geometry=@ByteArray(\\x1\\xd9\\xd0)\n1\\plots={\\\"fields\\\":5}\n"
                      "[window]\nlayout=y\n")
        << true;
    QTest::newRow("addresses") << "[robots]\naddresses=:, robot:0, http://x, 127.0.0.1:1, " +
                                      QByteArray("x").repeated(10000) + "\nnames=127.0.0.1:1, " +
                                      QByteArray("w").repeated(10000) + "\n"
                               << true;
}

void TestLayouts::anyFile() {
    QFETCH(QByteArray, bytes);
    QFETCH(bool, isOurs);
    QVERIFY(QDir().mkpath(QFileInfo(file_).path()));
    write(bytes);
    QElapsedTimer clock;
    clock.start();
    {
        LayoutWindow one(file_);
        QVERIFY(one.isWhole());
        QVERIFY(one.dock("daemons")->isVisible());
        QCOMPARE(one.notice().isEmpty(), isOurs && !bytes.contains("1\\state"));
        QVERIFY(one.fleet.robots().size() <= 2);
        one.saveAs("mine");
        QVERIFY(one.isWhole());
        one.window->close();
    }
    QVERIFY(clock.elapsed() < 10000);
    QCOMPARE(content() == bytes, !isOurs);
    QCOMPARE(Layouts(file_).names().contains("mine"), isOurs);
}

// Bytes of a layout, changed or cut at random.
void TestLayouts::anyState() {
    const quint32 seed = QRandomGenerator::global()->generate();
    qInfo("seed %u", seed);
    QRandomGenerator random(seed);
    { LayoutWindow(file_, {"127.0.0.1:1"}).window->close(); }
    QVERIFY(Layouts(file_).damage().isEmpty());
    QSettings file(file_, QSettings::IniFormat);
    const QStringList keys{"layouts/1/state", "layouts/1/geometry"};
    const QList<QByteArray> good{file.value(keys[0]).toByteArray(), file.value(keys[1]).toByteArray()};
    for (int round = 0; round < 40; ++round) {
        const int which = round % 2;
        QByteArray bytes = good[which];
        const int place = random.bounded(bytes.size());
        bytes[place] = char(bytes[place] + 1 + random.bounded(255));
        if (random.bounded(4) == 0)
            bytes.truncate(random.bounded(bytes.size()));
        file.setValue(keys[which], bytes);
        file.setValue(keys[1 - which], good[1 - which]);
        file.sync();
        LayoutWindow one(file_, {"127.0.0.1:1"});
        QVERIFY(one.isWhole() && one.dock("daemons")->isVisible());
        QVERIFY2(one.notice().contains("damaged"), qPrintable(one.notice()));
    }
}

void TestLayouts::whatCannotBeWrittenIsTold() {
    {
        LayoutWindow folder(folder_->path(), {"127.0.0.1:1"}); // which is no file
        QVERIFY2(folder.notice().contains("is no file"), qPrintable(folder.notice()));
        QVERIFY(folder.isWhole());
    }
    {
        LayoutWindow device("/dev/null", {"127.0.0.1:1"});
        QVERIFY(!device.notice().isEmpty());
        device.window->close();
        QVERIFY(QFileInfo::exists("/dev/null") && !QFileInfo("/dev/null").isFile());
    }
    file_ = folder_->filePath("gui.ini");
    write({});
    {
        LayoutWindow below(file_ + "/gui.ini", {"127.0.0.1:1"}); // where no folder can be
        QTRY_VERIFY2(below.notice().contains("could not be written"), qPrintable(below.notice()));
    }
    LayoutWindow full(file_, {"127.0.0.1:1"});
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit before{};
    QCOMPARE(getrlimit(RLIMIT_FSIZE, &before), 0);
    const rlimit none{0, before.rlim_max};
    QCOMPARE(setrlimit(RLIMIT_FSIZE, &none), 0); // as on a full disk
    full.saveAs("more");
    const bool isTold = QTest::qWaitFor([&full] { return full.notice().contains("could not be written"); });
    QCOMPARE(setrlimit(RLIMIT_FSIZE, &before), 0);
    QVERIFY2(isTold, qPrintable(full.notice()));
    full.saveAs("when there is room");
    QTRY_VERIFY(Layouts(file_).names().contains("when there is room"));
    QVERIFY(Layouts(file_).names().contains("more")); // the window had it
}

QTEST_MAIN(TestLayouts)
#include "TestLayouts.moc"
