#include "common/client/Client.h"
#include "common/client/DaemonAddress.h"
#include "common/settings/DottedPath.h"
#include "gui/desktop/model/MethodSchema.h"
#include "tests/gui/desktop/OpenForm.h"
#include "tests/gui/desktop/RobotProcesses.h"

using namespace hermes;

/// Every setting and parameter of every daemon can be shown and changed, and comes out as it went in.
class TestRealForms : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void initTestCase();
    void settings_data() { addDaemons(); }
    void settings();
    void parameters_data() { addDaemons(); }
    void parameters();

private:
    QJsonValue ask(const QString &daemon, const QString &method, const QJsonObject &params = {});
    static void addDaemons();

    std::unique_ptr<RobotProcesses> robot_;
    OpenForm open_;
};

static const QStringList daemons{"motorcontrol", "scanmatcher", "scanner",         "seriallogger",
                                 "simulator",    "supervisor",  "softwaretrigger", "velodynelogger"};

void TestRealForms::initTestCase() {
    robot_ = std::make_unique<RobotProcesses>();
    const QMap<QString, QStringList> given{
        {"seriallogger",
         {R"(ports=[{"name":"gps","url":"tcp://127.0.0.1:1","view":"nmea"},)"
          R"({"name":"imu","url":"tcp://127.0.0.1:2","silence_s":0.25}])"}},
        {"supervisor",
         {R"(processes=[{"name":"camera","program":"/opt/camera.py","arguments":["-v",""],)"
          R"("port":7480,"autostart":false},{"name":"arm","autostart":false}])"}},
        {"simulator", {"world=" + qEnvironmentVariable("HERMES_SOURCE") + "/deploy/worlds/pillars.json"}},
        {"softwaretrigger",
         {R"(triggers=[{"id":"gate","when":{"kind":"condition","daemon":"127.0.0.1:1","topic":"odometry",)"
          R"("path":"","op":"==","value":"5"},"actions":[{"do":"call","daemon":"motorcontrol","method":"y",)"
          R"("params":{"a":1,"b":"2","c":{"d":[null]}},"timeout_s":0.1}]},)"
          R"({"id":"lamp","armed":false,"when":{"kind":"command"},"actions":[]}])"}}};
    for (const QString &daemon : daemons)
        robot_->start(daemon, given.value(daemon));
}

QJsonValue TestRealForms::ask(const QString &daemon, const QString &method, const QJsonObject &params) {
    Client client;
    client.connectTo(asOwner(QString("127.0.0.1:%1").arg(robot_->port(daemon))));
    if (!client.waitConnected(std::chrono::seconds(20)).ok())
        return {};
    const auto answer = client.callAndWait(method, params);
    if (!answer)
        qWarning("%s: %s", qPrintable(method), qPrintable(answer.error().message));
    return answer ? *answer : QJsonValue();
}

void TestRealForms::addDaemons() {
    const Rows<QString> row("daemon");
    for (const QString &daemon : daemons)
        row(qPrintable(daemon), daemon);
}

/// Changes what has the focus in the way that it is made for; false: it is nothing to be changed.
static bool change(QWidget *input, int attempt) {
    if (auto *const box = qobject_cast<QCheckBox *>(input)) {
        QTest::mouseClick(box, Qt::LeftButton, {}, {8, box->height() / 2});
    } else if (auto *const list = qobject_cast<QComboBox *>(input)) {
        QTest::keyClick(list, list->currentIndex() > 0 ? Qt::Key_Up : Qt::Key_Down);
    } else if (auto *const line = qobject_cast<QLineEdit *>(input)) {
        bool isNumber = false;
        line->text().toDouble(&isNumber);
        if (isNumber)
            QTest::keyClick(line, attempt == 0 ? Qt::Key_Up : Qt::Key_Down);
        else
            QTest::keyClicks(line, "x");
    } else {
        return false;
    }
    return true;
}

// What comes out is what went in, to the daemon's own eyes; every value can be changed, and is valid then.
void TestRealForms::settings() {
    QFETCH(QString, daemon);
    const QJsonObject schema = ask(daemon, "settings.schema").toObject();
    const QJsonObject given = ask(daemon, "settings.get").toObject();
    QVERIFY(!schema.isEmpty() && !given.isEmpty());
    open_.show();
    open_.form().setSchema(schema, given);
    QCOMPARE(open_.form().values(), given);
    QVERIFY(open_.form().isValid() && open_.form().changes().isEmpty());
    QVERIFY(!open_.form().findChild<QPlainTextEdit *>()); // none has to be written as a text
    const QJsonObject set{{"values", open_.form().values()}};
    const QJsonValue answer = ask(daemon, "settings.set", set);
    QVERIFY2(answer["changed"].isArray() && answer["changed"].toArray().isEmpty(),
             QJsonDocument(answer.toObject()).toJson());
    SchemaValidator validator(schema);
    int count = 0;
    for (const QString &path : leafPaths(given)) {
        auto *const editor = open_.form().findChild<ValueEditor *>(path);
        QVERIFY2(editor, qPrintable(path));
        for (int attempt = 0; attempt < 2 && open_.form().changes().isEmpty(); ++attempt) {
            QWidget *input = editor->focusOrder().constFirst();
            open_.window().ensureWidgetVisible(input);
            if (input->objectName() == "fold" || input->objectName() == "add")
                QTest::mouseClick(input, Qt::LeftButton); // the first row
            const QWidgetList all = editor->focusOrder();
            for (QWidget *const one : all) // of the list: its first line
                if (input->objectName() == "fold" && qobject_cast<QLineEdit *>(one))
                    input = one;
            QVERIFY2(input->objectName() == "add" || change(input, attempt), qPrintable(path));
        }
        QCOMPARE(leafPaths(open_.form().changes()), QStringList(path));
        const bool isOk = validator.check(open_.form().values()).empty();
        QCOMPARE(open_.form().isValid(), isOk);
        if (!open_.form().isValid()) // the text that was added to it is refused
            QVERIFY2(open_.form().findChild<QLabel *>(path + "/note")->text().contains("expected"),
                     qPrintable(path));
        open_.form().revert();
        QVERIFY2(open_.form().changes().isEmpty(), qPrintable(path));
        ++count;
    }
    qInfo("%d settings", count);
    QVERIFY(count > 15);
}

// The examples of the descriptions can be put into the forms, and come out as they are.
void TestRealForms::parameters() {
    QFETCH(QString, daemon);
    int count = 0, examples = 0;
    const QJsonArray methods = ask(daemon, "rpc.discover")["methods"].toArray();
    QVERIFY(!methods.isEmpty());
    for (const QJsonValue &method : methods) {
        const QJsonObject schema = parametersOf(method.toObject());
        open_.form().setSchema(schema, {});
        const QByteArray name = method["name"].toString().toUtf8();
        const QJsonObject parameters = schema["properties"].toObject();
        for (auto parameter = parameters.begin(); parameter != parameters.end(); ++parameter, ++count) {
            QVERIFY2(open_.form().findChild<ValueEditor *>(parameter.key()), name);
            const bool isRequired = schema["required"].toArray().contains(parameter.key());
            const QJsonValue now = open_.form().values().value(parameter.key());
            const QJsonValue usual = parameter.value().toObject().value("default");
            if (!usual.isUndefined() || !isRequired)
                QVERIFY2(now == usual, name + ' ' + parameter.key().toUtf8());
        }
        for (const QJsonValue &example : method["examples"].toArray()) {
            QJsonObject given;
            for (const QJsonValue &param : example["params"].toArray())
                given[param["name"].toString()] = param["value"];
            open_.form().edit(given);
            QVERIFY2(open_.form().isValid(), name);
            const QJsonObject values = open_.form().values();
            for (auto one = given.begin(); one != given.end(); ++one)
                QVERIFY2(values[one.key()] == one.value(), name + ' ' + one.key().toUtf8());
            ++examples;
        }
    }
    qInfo("%d parameters, %d examples", count, examples);
    QVERIFY(count > 15);
}
