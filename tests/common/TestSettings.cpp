#include "common/settings/DottedPath.h"
#include "common/settings/Settings.h"
#include "common/settings/SettingsTable.h"

#include <cerrno>
#include <sys/sysmacros.h>

using namespace hermes;

struct ChargeSettings : SettingsTable {
    double low_v = 21, full_v = 25;
    std::uint16_t port = 7000;
    QString name = "left";
    bool on = true;

    ChargeSettings() {
        group("Battery");
        add("battery.low_v", low_v, "Low", "V", 0, 60);
        add("battery.full_v", full_v, "Full", "V", 0, 60);
        add("name", name, "Which").choices({"left", "right"});
        group("Net", Applies::OnRestart);
        add("port", port, "Where").range(1, 65535);
        add("on", on, "Whether");
    }
};

class TestSettings : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void init() {
        settings = std::make_unique<Settings>();
        settings->declare(Field::number("motor.radius_m", "Wheel").unit("m").range(0.01, 1).byDefault(0.1));
        settings->declare(Field::integer("motor.ticks", "A turn").minimum(1).byDefault(1024));
        settings->declare(
            Field::text("mode", "How").choices({"live", "file"}).byDefault("live").appliesOnRestart());
        settings->declare(Field::boolean("on", "Whether").byDefault(true));
        settings->declare(Field::array("listen", "Where", {{"type", "string"}}).byDefault(QJsonArray{"a"}));
    }

    void refusesAllOrNothing_data() {
        const Rows<QString, QJsonValue> row("path", "value");
        row("too small", "motor.radius_m", QJsonValue(0));
        row("too large", "motor.radius_m", QJsonValue(1.5));
        row("number as text", "motor.radius_m", QJsonValue("0.5"));
        row("not whole", "motor.ticks", QJsonValue(1.5));
        row("not a choice", "mode", QJsonValue("other"));
        row("choice of another type", "mode", QJsonValue(1));
        row("number for boolean", "on", QJsonValue(1));
        row("null", "on", QJsonValue());
        row("value for a group", "motor", QJsonValue(5));
        row("element of an array", "listen.1", QJsonValue(QJsonArray{"a", 5}));
        row("unknown at the top", "moter", QJsonValue(5));
        row("unknown in a group", "motor.radius", QJsonValue(0.5));
    }

    void refusesAllOrNothing() {
        FETCH(QString, path, QJsonValue, value);
        const QJsonObject before = settings->values();
        const QString target = path == "listen.1" ? "listen" : path;
        const QJsonObject good{{"motor", QJsonObject{{"ticks", 5}}}};
        QSignalSpy changed(settings.get(), &Settings::changed);
        const auto result = settings->set(merged(good, withValueAt({}, target, value)));
        QVERIFY(!result);
        QVERIFY(result.error().is(ErrorCode::InvalidSetting));
        const QJsonObject error = result.error().data["errors"][0].toObject();
        QCOMPARE(error["path"].toString(), path);
        QVERIFY(!error["expected"].toString().isEmpty());
        VERIFY_STARTS(result.error().message, path + " is ");
        QCOMPARE(settings->values(), before);
        QCOMPARE(changed.count(), 0);
    }

    void tableDeclaresAndFills() {
        Settings declared;
        ChargeSettings table;
        table.declareIn(declared);
        QCOMPARE(declared.values(), QJsonObject({{"battery", QJsonObject{{"low_v", 21}, {"full_v", 25}}},
                                                 {"name", "left"},
                                                 {"port", 7000},
                                                 {"on", true}}));
        QCOMPARE(declared.schema()["properties"].toObject()["port"].toObject(),
                 QJsonObject({{"type", "integer"},
                              {"description", "Where"},
                              {"minimum", 1},
                              {"maximum", 65535},
                              {"default", 7000},
                              {"group", "Net"},
                              {"x-applies", "restart"}}));
        QVERIFY(declared.set(
            {{"battery", QJsonObject{{"low_v", 26.5}}}, {"name", "right"}, {"port", 65535}, {"on", false}}));
        table.read(declared.inForce());
        QVERIFY(table.low_v == 26.5 && table.full_v == 25 && table.name == "right" && table.port == 65535 &&
                !table.on);
        table.notAbove(table.low_v, table.full_v);
        table.notBelow(table.low_v, table.full_v);
        table.require(false, table.name, "left");
        QCOMPARE(toString(table.violations()),
                 QString("battery.low_v is 26.5, expected at most battery.full_v; "
                         "name is \"right\", expected left"));
    }

    void appliesPartialObject() {
        QSignalSpy changed(settings.get(), &Settings::changed);
        const auto result =
            settings->set({{"motor", QJsonObject{{"ticks", 4e9}}}, {"mode", "file"}, {"on", true}});
        QVERIFY(result);
        QCOMPARE(*result, QStringList({"mode", "motor.ticks"}));
        QCOMPARE(changed.count(), 1);
        QCOMPARE(settings->number("motor.ticks"), 4e9);
        QCOMPARE(settings->number("motor.radius_m"), 0.1);
        QCOMPARE(settings->needRestart(*result), QStringList{"mode"});
        QCOMPARE(settings->changes(),
                 (QJsonObject{{"motor", QJsonObject{{"ticks", 4e9}}}, {"mode", "file"}}));
    }

    void restartMeansRestart() {
        const QString first = settings->text("mode");
        settings->begin();
        QVERIFY(settings->set({{"mode", "file"}, {"motor", QJsonObject{{"ticks", 7}}}}));
        QCOMPARE(settings->text("mode"), first);
        QCOMPARE(settings->integer("motor.ticks"), 7);
        QCOMPARE(settings->waiting(), QStringList{"mode"});
        QCOMPARE(settings->values()["mode"].toString(),
                 QString("file")); // what settings.get shows and save() keeps
        QCOMPARE(settings->inForce()["mode"].toString(), first);
        QVERIFY(settings->set({{"mode", first}})); // back to what is in force
        QVERIFY(settings->waiting().isEmpty());
        QVERIFY(settings->set({{"mode", "file"}}));
        settings->takeWaiting({"mode"});
        QCOMPARE(settings->text("mode"), first);
        settings->takeWaiting({});
        QCOMPARE(settings->text("mode"), QString("file"));
        QVERIFY(settings->waiting().isEmpty());
        QVERIFY(settings->set({{"mode", first}}));
        settings->takeWaiting({});
        QVERIFY(settings->set({{"mode", "file"}}) && settings->reset());
        QVERIFY(settings->waiting().isEmpty());
    }

    void namesEveryViolation() {
        const auto result =
            settings->set({{"on", 1}, {"x", 1}, {"motor", QJsonObject{{"ticks", 0}, {"y", 1}}}});
        QCOMPARE(result.error().data["errors"].toArray().size(), 4);
        QVERIFY(result.error().message.contains("an integer of at least 1"));
        QVERIFY(result.error().message.contains("known are: radius_m, ticks"));
    }

    void resetsSomeOrAll() {
        settings->set({{"motor", QJsonObject{{"ticks", 5}, {"radius_m", 0.5}}}, {"on", false}});
        QCOMPARE(*settings->reset({"motor.ticks"}), QStringList{"motor.ticks"});
        QCOMPARE(settings->number("motor.radius_m"), 0.5);
        QVERIFY(!settings->reset({"motor.foo"}));
        settings->reset();
        QCOMPARE(settings->values(), settings->defaults());
        QVERIFY(settings->changes().isEmpty());
    }

    void schemaTellsAll() {
        const QJsonObject radius =
            valueAt(settings->schema(), "properties.motor.properties.radius_m").toObject();
        QCOMPARE(radius["unit"].toString(), QString("m"));
        QCOMPARE(radius["default"].toDouble(), 0.1);
        QCOMPARE(radius["maximum"].toDouble(), 1.0);
        QCOMPARE(radius["x-applies"].toString(), QString("now"));
        QCOMPARE(valueAt(settings->schema(), "properties.mode.x-applies").toString(), QString("restart"));
    }

    void savesOnlyChangesAndReadsThemBack() {
        const QString file = folder.filePath("settings.json");
        settings->set({{"mode", "file"}});
        QCOMPARE(*settings->save(file), file);
        settings->reset();
        QVERIFY(settings->load(file));
        QCOMPARE(settings->text("mode"), QString("file"));
        QCOMPARE(*settings->save(), file); // remembered
        QCOMPARE(QJsonDocument::fromJson(contentOf(file)).object(), (QJsonObject{{"mode", "file"}}));
    }

    void readsWhatWindowsWrites() {
        put(folder.filePath("windows.json"), "\xef\xbb\xbf{\r\n\"on\": false\r\n}\r\n");
        QVERIFY(settings->load(folder.filePath("windows.json")));
        QVERIFY(!settings->flag("on"));
    }

    void insistsOnTheCommandLine() {
        const QString file = folder.filePath("own.json");
        QVERIFY(settings->set({{"on", false}, {"motor", QJsonObject{{"ticks", 3}}}}));
        QVERIFY(settings->save(file));
        settings->reset();
        QVERIFY(settings->insist({{"motor", QJsonObject{{"ticks", 7}}}}));
        QVERIFY(!settings->insist({{"motor", QJsonObject{{"ticks", 0}}}}));
        QVERIFY(settings->load(file));
        QVERIFY(!settings->flag("on"));
        QCOMPARE(settings->integer("motor.ticks"), 7);
    }

    void fileErrorsNameFileAndPlace_data() {
        const Rows<QByteArray, QString> row("text", "says");
        row("syntax", "{\n  \"on\": true,\n  oops\n}\n", "line 3");
        row("cut", "{\n\"on\": tr", "line 2");
        row("large number", "{\n\"motor\": {\"ticks\": 1e999}}",
            "line 2: Number too big to be stored in double");
        row("repeated key", "{\"on\": true,\n\"on\": false}", "line 2: the key \"on\" occurs twice");
        row("not an object", "[1]", "expected a JSON object");
        row("unknown key", "{\"motor\": {\"raduis\": 1}}", "motor.raduis is 1");
        row("bad value", "{\"mode\": \"x\"}", "mode is \"x\", expected one of \"live\", \"file\"");
        row("empty", "", "it has 0 bytes");
        row("UTF-16", QByteArray("\xff\xfe{\0}\0", 6), "line 1: found UTF-16, expected UTF-8");
        row("large", QByteArray((1 << 20) + 1, ' '), "it has 1048577 bytes");
    }

    void fileErrorsNameFileAndPlace() {
        FETCH(QByteArray, text, QString, says);
        const QString file = folder.filePath("bad.json");
        put(file, text);
        const auto result = settings->load(file);
        QVERIFY(!result);
        VERIFY_CONTAINS(result.error().message, file);
        VERIFY_CONTAINS(result.error().message, says);
        QVERIFY2(!result.error().message.endsWith('.'), "more may follow in the sentence");
        QCOMPARE(settings->values(), settings->defaults());
    }

    void failedSaveLeavesTheOldFile() {
        QVERIFY(!settings->save());
        const auto result = settings->save(folder.filePath("no/such/folder.json"));
        QVERIFY(!result);
        QVERIFY(result.error().is(ErrorCode::InputOutput));
        QVERIFY(!settings->load(folder.filePath("absent.json")));
    }

    void savesOnlyWhatItCanReadAgain() {
        const QString name = folder.filePath("growing.json");
        const auto setBytes = [&](int characters) {
            return settings->set({{"listen", QJsonArray{QString(characters, 'x')}}}).ok();
        };
        QVERIFY(setBytes(1) && settings->save(name));
        const int around = int(QFileInfo(name).size()) - 1; // what is written beside the characters
        QVERIFY(setBytes(int(maxSettingsBytes) - around));
        QVERIFY(settings->save(name) && settings->load(name));
        QCOMPARE(QFileInfo(name).size(), maxSettingsBytes);
        QVERIFY(setBytes(int(maxSettingsBytes) - around + 1));
        const auto result = settings->save(name);
        QVERIFY(!result);
        QCOMPARE(
            result.error().message,
            QString("settings file %1: it would have 1048577 bytes, expected at most 1048576").arg(name));
        QVERIFY(settings->load(name));
    }

    void replacesNoDevice_data() {
        Rows<mode_t, bool>("kind", "linked");
        for (const bool linked : {false, true}) {
            QTest::addRow("pipe%s", linked ? ", linked" : "") << mode_t(S_IFIFO) << linked;
            QTest::addRow("device%s", linked ? ", linked" : "") << mode_t(S_IFCHR) << linked;
            QTest::addRow("folder%s", linked ? ", linked" : "") << mode_t(S_IFDIR) << linked;
        }
    }

    void replacesNoDevice() {
        FETCH(mode_t, kind, bool, linked);
        const QTemporaryDir own;
        const QString target = own.filePath("target"), name = linked ? own.filePath("link.json") : target;
        const QByteArray path = QFile::encodeName(target);
        const int made = kind == S_IFDIR ? ::mkdir(path, 0700) : ::mknod(path, kind | 0600, makedev(1, 3));
        if (made != 0 && errno == EPERM)
            QSKIP("only root makes device nodes");
        QCOMPARE(made, 0);
        QVERIFY(!linked || QFile::link(target, name));
        const auto result = settings->save(name);
        QVERIFY(!result);
        QCOMPARE(result.error().message,
                 QString("settings file %1: %2not a regular file")
                     .arg(name, linked ? QString("this is %1, ").arg(target) : QString()));
        struct stat status {};
        QCOMPARE(::stat(path, &status), 0);
        QCOMPARE(status.st_mode & S_IFMT, kind);
        QCOMPARE(QFileInfo(name).isSymLink(), linked);
    }

    void ruleAcrossSettings() {
        settings->addRule([](const QJsonObject &values) -> std::vector<SchemaViolation> {
            if (values["mode"].toString() == "file" && values["on"].toBool())
                return {{"on", true, "false when mode is file"}};
            return {};
        });
        QVERIFY(!settings->set({{"mode", "file"}}));
        QVERIFY(settings->set({{"mode", "file"}, {"on", false}}));
    }

private:
    std::unique_ptr<Settings> settings;
    QTemporaryDir folder;
};
