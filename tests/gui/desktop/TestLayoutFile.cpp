#include "tests/gui/desktop/LayoutWindow.h"

#include <QJsonDocument>
#include <QRandomGenerator>

using namespace hermes;

/// The file of layouts and robots, which may be anything, or nothing that can be written.
class TestLayoutFile : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void init() {
        folder_ = std::make_unique<QTemporaryDir>();
        file_ = folder_->filePath("new/gui.json");
    }

    void anyFile_data() {
        const Rows<QByteArray, bool> row("bytes", "isOurs");
        QByteArray noise(10 << 20, 0);
        QRandomGenerator random(1);
        for (char &c : noise)
            c = char(random.bounded(256));
        row("empty", QByteArray(), true);
        row("10 MB of noise", noise, false);
        row("a little noise", noise.left(1000), false);
        const QByteArray own = "{\"layout\":\"x\",\"layouts\":[],\"kept\":{\"a\":\"", end = "\"}}";
        row("10 MB of spaces", own + end + QByteArray(10 << 20, ' '), false);
        row("nearly as large as it may be", own + QByteArray((1 << 20) - 20000, 'x') + end, true);
        row("a byte larger", own + QByteArray((1 << 20) + 1 - own.size() - end.size(), 'x') + end, false);
        row("cut", own + "x", false);
        row("deep", "{\"layouts\":" + QByteArray(5000, '[') + "}", false);
        row("another program's", "[Desktop Entry]\nName=x\n", false);
        row("JSON of another program", R"({"version":1,"settings":{}})", false);
        row("a list", "[1,2]", false);
        row("a text", "Dear diary,\ntoday I drove.\n", false);
        row("wrong types",
            R"({"layout":7,"layouts":[5,{"name":[]},{"name":"x","plots":5}],"robots":[1],"kept":"x"})", true);
        row("no list of layouts", R"({"layouts":{"a":1},"layout":"y"})", true);
        row("a wrong state", R"({"layouts":[{"name":"x","geometry":"Advo","state":"AAAA","plots":{}}]})",
            true);
        const QByteArray longText = '"' + QByteArray("x").repeated(10000) + '"';
        row("addresses",
            "{\"layouts\":[],\"robots\":{\"addresses\":[\":\",\"robot:0\",\"http://x\",5,\"127.0.0.1:1\"," +
                longText + "],\"names\":{\"127.0.0.1:1\":" + longText + "}}}",
            true);
        // As earlier versions kept it.
        row("ini", "[window]\nlayout=x\n[kept]\na=b\n", true);
        row("types of Qt in an ini", "[window]\nstate=@Variant(\\0\\0\\0\\b\\xff\\xff\\xff\\xff)\n", false);
        row("wrong types in an ini",
            "[window]\ngeometry=1, 2, 3\nstate=@Rect(1 2 3 4)\nlayout=7, 8\n"
            "[layouts]\nsize=many\n1\\name=a, b\n[robots]\naddresses=5\nnames=x\n"
            "chosen=1, 2\n",
            true);
        row("more than there are in an ini",
            "[layouts]\nsize=2000000000\n1\\name=x\n1\\state=@ByteArray(\\0\\0\\0\\xff)\n"
            "1\\geometry=@ByteArray(\\x1\\xd9\\xd0)\n1\\plots={\\\"fields\\\":5}\n"
            "[window]\nlayout=y\n",
            true);
    }

    void anyFile() {
        FETCH(QByteArray, bytes, bool, isOurs);
        QVERIFY(QDir().mkpath(QFileInfo(file_).path()));
        write(bytes);
        auto clock = runningTimer();
        {
            LayoutWindow one(file_);
            QVERIFY(one.isWhole());
            QVERIFY(one.dock("daemons")->isVisible());
            QCOMPARE(one.notice().isEmpty(),
                     isOurs && !bytes.contains("name\":\"x") && !bytes.contains("1\\state"));
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
    void anyState() {
        QRandomGenerator random(newSeed());
        { LayoutWindow(file_, {"127.0.0.1:1"}).window->close(); }
        QVERIFY(Layouts(file_).damage().isEmpty());
        const QJsonObject good = QJsonDocument::fromJson(content()).object();
        for (int round = 0; round < 40; ++round) {
            const QString key = round % 2 ? "geometry" : "state";
            QJsonObject layout = good["layouts"][0].toObject();
            QByteArray bytes = QByteArray::fromBase64(layout[key].toString().toLatin1());
            const int place = random.bounded(bytes.size());
            bytes[place] = char(bytes[place] + 1 + random.bounded(255));
            if (random.bounded(4) == 0)
                bytes.truncate(random.bounded(bytes.size()));
            layout[key] = QString::fromLatin1(bytes.toBase64());
            QJsonObject damaged = good;
            damaged["layouts"] = QJsonArray{layout};
            write(QJsonDocument(damaged).toJson());
            LayoutWindow one(file_, {"127.0.0.1:1"});
            QVERIFY(one.isWhole() && one.dock("daemons")->isVisible());
            VERIFY_CONTAINS(one.notice(), "damaged");
        }
    }

    // As this program wrote it, but for some bytes, or the rest.
    void ownFileDamaged() {
        QRandomGenerator random(newSeed());
        {
            LayoutWindow one(file_, {"127.0.0.1:1"});
            one.saveAs("Bench");
            one.window->close();
        }
        const QByteArray good = content();
        for (int round = 0; round < 40; ++round) {
            QByteArray bytes = good;
            for (int i = random.bounded(4); i >= 0; --i)
                bytes[random.bounded(bytes.size())] = char(random.bounded(256));
            if (random.bounded(2) == 0)
                bytes.truncate(random.bounded(bytes.size()));
            write(bytes);
            const bool isRefused = !Layouts(file_).problem().isEmpty();
            LayoutWindow one(file_);
            QVERIFY(one.isWhole() && one.dock("daemons")->isVisible());
            QVERIFY(one.window->minimumSizeHint().width() < 1024);
            QCOMPARE(one.notice().contains("It is left as it is"), isRefused);
            one.window->close();
            QVERIFY(!isRefused || content() == bytes);
        }
    }

    void anyValue_data() {
        Rows<QString, QByteArray>("key", "value");
        QByteArray deep = "1";
        for (int i = 0; i < 900; ++i)
            deep = "{\"a\":[" + deep + "]}";
        const QList<QPair<const char *, QByteArray>> values{{"no JSON", "{[\"\\"},
                                                            {"another kind", "[[1,null],{\"a\":[]}]"},
                                                            {"deep", deep},
                                                            {"long", '"' + QByteArray(500000, 'W') + '"'},
                                                            {"wrong ticks", "{\"gridLayer\":[7],\"\":null}"}};
        for (const char *const key : {"layers", "plotSets", "buttons", "sounds", "escape", "gamepads/a"})
            for (const auto &[name, value] : values)
                QTest::addRow("%s: %s", key, name) << QString(key) << value;
    }

    void anyValue() {
        FETCH(QString, key, QByteArray, value);
        Layouts layouts(file_);
        layouts.setValue(key, QString::fromUtf8(value));
        QVERIFY(layouts.save());
        LayoutWindow one(file_, {"127.0.0.1:1"});
        QVERIFY(one.isWhole() && one.notice().isEmpty());
        QVERIFY(!one.window->findChild<QAction *>("escapeStops")->isChecked());
        QVERIFY(one.window->minimumSizeHint().width() < 1024);
        one.window->close();
        QVERIFY(Layouts(file_).problem().isEmpty());
    }

    void programBeginsWithNonsense() {
        QVERIFY(QDir().mkpath(QFileInfo(file_).path()));
        const QByteArray nonsense = QByteArray("\0\xff[window]\n@Variant(", 20).repeated(200000);
        write(nonsense);
        QProcess program;
        program.setProcessChannelMode(QProcess::MergedChannels);
        program.start(qEnvironmentVariable("HERMES_BIN") + "/hermes-gui",
                      {"--connect", "127.0.0.1:1", "--layout", file_});
        QByteArray told;
        QTRY_VERIFY2_WITH_TIMEOUT((told += program.readAll()).contains("It is left as it is"),
                                  told.constData(), 20000);
        QTest::qWait(1000); // in which it would keep what is set
        QCOMPARE(program.state(), QProcess::Running);
        program.terminate();
        QVERIFY(program.waitForFinished());
        QCOMPARE(program.exitStatus(), QProcess::NormalExit); // in order
        QCOMPARE(content(), nonsense);
    }

    void whatCannotBeWrittenIsTold() {
        {
            LayoutWindow folder(folder_->path(), {"127.0.0.1:1"}); // which is no file
            VERIFY_CONTAINS(folder.notice(), "is no file");
            QVERIFY(folder.isWhole());
        }
        {
            LayoutWindow device("/dev/null", {"127.0.0.1:1"});
            QVERIFY(!device.notice().isEmpty());
            device.window->close();
            QVERIFY(QFileInfo::exists("/dev/null") && !QFileInfo("/dev/null").isFile());
        }
        file_ = folder_->filePath("gui.json");
        write({});
        {
            LayoutWindow below(file_ + "/gui.json", {"127.0.0.1:1"}); // where no folder can be
            TRY_CONTAINS(below.notice(), "could not be written");
        }
        LayoutWindow full(file_, {"127.0.0.1:1"});
        std::optional<FileSizeLimit> disk(0);
        full.saveAs("more");
        const bool isTold =
            QTest::qWaitFor([&full] { return full.notice().contains("could not be written"); });
        full.window->close();
        const bool isAsked =
            QTest::qWaitFor([&full] { return full.notice().contains("Close the window once more"); });
        disk.reset();
        QVERIFY2(isTold, qPrintable(full.notice()));
        QVERIFY2(isAsked, qPrintable(full.notice()));
        full.saveAs("when there is room");
        QTRY_VERIFY(Layouts(file_).names().contains("when there is room"));
        QVERIFY(Layouts(file_).names().contains("more")); // the window had it
    }

    void aLockOfNobodyHoldsNothingUp_data() {
        const Rows<QByteArray> row("lock");
        row("empty", QByteArray());
        row("no lock", QByteArray(10000, 'x'));
        row("of another host", QByteArray("1\nhermes-gui\nelsewhere\n\n\n"));
        row("of a program that was killed", QByteArray("hermes-gui"));
    }

    void aLockOfNobodyHoldsNothingUp() {
        QFETCH(QByteArray, lock);
        QVERIFY(QDir().mkpath(QFileInfo(file_).path()));
        if (lock == "hermes-gui") {
            QProcess program;
            program.start(qEnvironmentVariable("HERMES_BIN") + "/hermes-gui",
                          {"--connect", "127.0.0.1:1", "--layout", file_});
            QTRY_VERIFY_WITH_TIMEOUT(QFileInfo::exists(file_), 20000);
            program.kill();
            QVERIFY(program.waitForFinished());
            QVERIFY(QFileInfo::exists(file_ + ".lock"));
        } else {
            put(file_ + ".lock", lock);
        }
        LayoutWindow one(file_, {"127.0.0.1:1"});
        QCOMPARE(one.notice(), QString());
        one.saveAs("mine");
        QTRY_VERIFY(Layouts(file_).names().contains("mine"));
    }

    void iniOfBeforeIsTakenOver() {
        const QString ini = folder_->filePath("gui.ini");
        put(ini, "[window]\nlayout=Bench\n[layouts]\nsize=1\n1\\name=Bench\n1\\plots=\"{\\\"panes\\\":[]}\"\n"
                 "[robots]\naddresses=127.0.0.1:1, 127.0.0.1:2\nnames=127.0.0.1:1, Blue\nchosen=127.0.0.1:1\n"
                 "[kept]\nescape=true\n");
        file_ = folder_->filePath("gui.json");
        const Layouts before(file_);
        QCOMPARE(before.problem(), QString());
        QCOMPARE(before.current(), QString("Bench"));
        QCOMPARE(before.layout().plots, QJsonObject({{"panes", QJsonArray()}}));
        QCOMPARE(before.robots().addresses, QStringList({"127.0.0.1:1", "127.0.0.1:2"}));
        QCOMPARE(before.robots().names.value("127.0.0.1:1"), QString("Blue"));
        QCOMPARE(before.value("escape"), QString("true"));
        const QByteArray kept = contentOf(ini);
        LayoutWindow(file_).window->close();
        QTRY_VERIFY(QFileInfo::exists(file_));
        QCOMPARE(Layouts(file_).robots(), before.robots());
        QCOMPARE(contentOf(ini), kept); // as it was
    }

    void linkStaysOne() {
        const QString link = folder_->filePath("link.ini"), second = folder_->filePath("second.ini");
        QVERIFY(QFile::link(file_, second) && QFile::link("second.ini", link)); // where nothing is as yet
        for (const char *const name : {"first", "then"}) {
            LayoutWindow one(link, {"127.0.0.1:1"});
            one.saveAs(name);
            QTRY_VERIFY(Layouts(file_).names().contains(name));
            QVERIFY(QFileInfo(link).isSymLink() && QFileInfo(second).isSymLink());
        }
    }

private:
    QByteArray content() const { return contentOf(file_); }
    void write(const QByteArray &bytes) const { put(file_, bytes); }

    std::unique_ptr<QTemporaryDir> folder_;
    QString file_;
};
