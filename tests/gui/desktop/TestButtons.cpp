#include "common/client/DaemonAddress.h"
#include "gui/desktop/model/Macro.h"
#include "tests/gui/desktop/OpenWindow.h"

#include <QJsonDocument>
#include <QLabel>
#include <QListWidget>
#include <QMenu>
#include <QToolBar>

using namespace hermes;
using namespace hermes::desktop;

/// Commands become buttons of the operator's own, which run, end and are kept.
class TestButtons : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void initTestCase();
    void init();
    void cleanup();
    void cleanupTestCase();
    void commandBecomesAButton();
    void commandBecomesAStep();
    void stepsRunOneAfterTheOther();
    void endsAtTheFirstError();
    void whatForgetsAsksOnce();
    void removedWhileItAsks();
    void runsOnlyOnceAtATime();
    void endedByHand();
    void stopEndsIt_data();
    void stopEndsIt();
    void isEdited();
    void isKeptAndGreyWithoutItsDaemon();
    void nonsenseInTheFile_data();
    void nonsenseInTheFile();

private:
    void open(const QJsonArray &buttons = {});
    /// As the buttons of the last window.
    void keep(const QByteArray &buttons) const {
        Layouts layouts(file_);
        layouts.setValue("buttons", QString::fromUtf8(buttons));
        QVERIFY(layouts.save().ok());
    }
    template <typename T>
    T *find(const QString &name) const {
        return window_->findChild<T *>(name);
    }
    void click(const QString &name) { OpenWindow::click(window_.get(), name); }
    QPushButton *button(int place) const {
        for (auto *const found : window_->findChildren<QPushButton *>(QString("macro%1").arg(place)))
            if (found->isVisible() && found->height() > 10) // is laid out
                return found;
        return nullptr;
    }
    QString title(int place) const { return button(place) ? button(place)->text() : QString(); }
    void press(int place) {
        QTRY_VERIFY(button(place) && button(place)->isEnabled());
        QTest::mouseClick(button(place), Qt::LeftButton);
    }
    QString text() const { return find<QLabel>("macroText")->text(); }
    void chooseMethod(const QString &daemon, const QString &method);
    void typeParameter(const QString &name, const QString &value) {
        auto *const call = find<QPushButton>("call")->parentWidget()->parentWidget();
        OpenWindow::type(call->findChild<QWidget *>(name)->findChild<QLineEdit *>(), value);
    }
    QJsonValue ask(const QString &method, const QJsonObject &params = {}) {
        const auto answer = client_->callAndWait(method, params);
        return answer ? *answer : QJsonValue();
    }
    /// Where the simulated robot is.
    double x() {
        Client simulator;
        simulator.connectTo(QString("127.0.0.1:%1").arg(robot_->port("simulator")));
        if (!simulator.waitConnected().ok())
            return qQNaN();
        const auto state = simulator.callAndWait("sim.state");
        return state ? (*state)["pose"]["x"].toDouble() : qQNaN();
    }
    static QJsonObject step(const QString &daemon, const QString &method, const QJsonObject &params = {},
                            double pause_s = 0) {
        return {{"robot", "127.0.0.1"},
                {"daemon", daemon},
                {"method", method},
                {"params", params},
                {"pause_s", pause_s}};
    }
    static QJsonObject place(double x, double pause_s = 0) {
        return step("simulator", "sim.place", {{"x", x}, {"y", 0}, {"theta", 0}}, pause_s);
    }
    static QJsonObject macro(const QString &name, const QJsonArray &steps) {
        return {{"name", name}, {"steps", steps}};
    }

    std::unique_ptr<RobotProcesses> robot_;
    std::unique_ptr<Fleet> fleet_;
    std::unique_ptr<DriveControl> drive_;
    std::unique_ptr<MainWindow> window_;
    std::unique_ptr<Client> client_; // an independent eye on the motors
    QString file_;
};

void TestButtons::initTestCase() {
    robot_ = std::make_unique<RobotProcesses>();
    robot_->startMotors();
}

void TestButtons::cleanupTestCase() {
    robot_.reset();
}

void TestButtons::init() {
    file_ = robot_->path("gui.ini");
    QFile::remove(file_);
    client_ = std::make_unique<Client>();
    client_->connectTo(QString("127.0.0.1:%1").arg(robot_->port("motorcontrol")));
    QVERIFY(client_->waitConnected().ok());
}

void TestButtons::cleanup() {
    window_.reset();
    drive_.reset();
    fleet_.reset();
    client_->callAndWait("motor.reset_estop");
    client_.reset();
}

void TestButtons::open(const QJsonArray &buttons) {
    if (!buttons.isEmpty())
        keep(QJsonDocument(buttons).toJson());
    fleet_ = std::make_unique<Fleet>();
    robot_->connectTo(*fleet_);
    drive_ = std::make_unique<DriveControl>(*fleet_);
    window_ = std::make_unique<MainWindow>(*fleet_, *drive_, file_);
    window_->show();
    window_->activateWindow();
    QVERIFY(QTest::qWaitForWindowActive(window_.get()));
    QTRY_VERIFY(!drive_->isStopped());
}

void TestButtons::chooseMethod(const QString &daemon, const QString &method) {
    auto *const dock = find<QDockWidget>("commands");
    dock->show();
    dock->raise();
    fleet_->choose(fleet_->robot()->withName(daemon));
    auto *const methods = find<QListWidget>("methods");
    QTRY_VERIFY(!methods->findItems(method, Qt::MatchExactly).isEmpty());
    QListWidgetItem *const found = methods->findItems(method, Qt::MatchExactly)[0];
    methods->scrollToItem(found);
    QTest::mouseClick(methods->viewport(), Qt::LeftButton, {}, methods->visualItemRect(found).center());
}

void TestButtons::commandBecomesAButton() {
    open();
    QVERIFY(!find<QToolBar>("buttonBar")->isVisible());
    chooseMethod("simulator", "sim.place");
    QVERIFY(!find<QPushButton>("addButton")->isEnabled()); // x and y are missing
    typeParameter("x", "0.75");
    typeParameter("y", "0");
    typeParameter("theta", "0");
    click("addButton");
    QVERIFY(find<QLineEdit>("buttonName")->hasFocus()); // to be named at once
    QTest::keyClicks(QApplication::focusWidget(), "Go home");
    QVERIFY(find<QToolBar>("buttonBar")->isVisible());
    QTRY_VERIFY(button(0));
    QCOMPARE(title(0), QString("Go home"));
    QVERIFY(button(0)->toolTip().contains("simulator, sim.place"));
    press(0);
    QTRY_COMPARE(text(), QString("Go home: done"));
    QCOMPARE(x(), 0.75);
}

void TestButtons::commandBecomesAStep() {
    open({macro("Twice", {place(0.1)})});
    chooseMethod("simulator", "sim.place");
    typeParameter("x", "0.5");
    typeParameter("y", "0");
    typeParameter("theta", "0");
    QMenu *const menu = find<QPushButton>("addStep")->menu();
    QCOMPARE(menu->actions().size(), 1);
    menu->popup(window_->mapToGlobal({400, 400}));
    QTest::mouseClick(menu, Qt::LeftButton, {}, menu->actionGeometry(menu->actions()[0]).center());
    press(0);
    QTRY_COMPARE(text(), QString("Twice: done"));
    QCOMPARE(x(), 0.5);
}

void TestButtons::stepsRunOneAfterTheOther() {
    open({macro("Tour", {place(0.1, 0.4), place(0.2, 0.4), place(0.3)})});
    QElapsedTimer clock;
    clock.start();
    press(0);
    QTRY_VERIFY2(text().contains("step 2 of 3"), qPrintable(text()));
    QCOMPARE(x(), 0.2);
    QTRY_COMPARE(text(), QString("Tour: done"));
    QVERIFY(clock.elapsed() >= 800);
    QCOMPARE(x(), 0.3);
}

// It does not take the control by itself, either.
void TestButtons::endsAtTheFirstError() {
    open({macro("Drive", {place(0.1), step("motorcontrol", "motor.drive", {{"vx", 0.1}}), place(0.9)})});
    press(0);
    QTRY_VERIFY2(text().startsWith("Drive ended at step 2 of 3, motorcontrol, motor.drive: "),
                 qPrintable(text()));
    QCOMPARE(x(), 0.1);
    QVERIFY(!ask("control.state")["held"].toBool(true));
    QVERIFY(button(0)->isEnabled());
}

void TestButtons::whatForgetsAsksOnce() {
    open({macro("Fresh",
                {place(0.1), step("simulator", "settings.reset", {{"paths", QJsonArray{"log.records"}}}),
                 step("simulator", "settings.reset", {{"paths", QJsonArray{"log.level"}}}), place(0.6)})});
    const double before = x();
    press(0);
    QVERIFY2(text().startsWith("Press Fresh once more: it replaces or forgets the settings"),
             qPrintable(text()));
    QTest::mouseClick(button(0), Qt::LeftButton); // a double click
    QTest::qWait(600);
    QVERIFY(text().startsWith("Press"));
    QCOMPARE(x(), before);
    press(0);
    QTRY_COMPARE(text(), QString("Fresh: done"));
    QCOMPARE(title(0), QString("Fresh"));
    QCOMPARE(x(), 0.6);
}

// Which is another one at that place then.
void TestButtons::removedWhileItAsks() {
    const QJsonObject reset = step("simulator", "settings.reset", {{"paths", QJsonArray{"log.level"}}});
    open({macro("Asks", {reset}), macro("Other", {reset})});
    click("editButtons");
    press(0);
    QVERIFY(text().startsWith("Press Asks once more"));
    click("buttonRemove");
    QTRY_COMPARE(title(0), QString("Other"));
    QVERIFY(text().isEmpty());
    press(0);
    QVERIFY(text().startsWith("Press Other once more"));
}

void TestButtons::runsOnlyOnceAtATime() {
    open({macro("Slow", {place(0.1, 1), place(0.2)}), macro("Other", {place(0.9)})});
    press(0);
    QTRY_VERIFY(text().startsWith("Slow: "));
    QVERIFY(!button(0)->isEnabled() && !button(1)->isEnabled());
    QTest::mouseClick(button(1), Qt::LeftButton);
    QTRY_COMPARE(text(), QString("Slow: done"));
    QCOMPARE(x(), 0.2);
    QVERIFY(button(0)->isEnabled() && button(1)->isEnabled());
}

void TestButtons::endedByHand() {
    open({macro("Slow", {place(0.1, 30), place(0.9)})});
    QVERIFY(!find<QPushButton>("endMacro")->isEnabled());
    press(0);
    QTRY_COMPARE(x(), 0.1);
    click("endMacro");
    QVERIFY2(text().startsWith("Slow ended at step"), qPrintable(text()));
    QVERIFY(!find<QPushButton>("endMacro")->isEnabled());
    QCOMPARE(x(), 0.1);
}

void TestButtons::stopEndsIt_data() {
    QTest::addColumn<QString>("by");
    for (const char *const by : {"button", "F12", "another client"})
        QTest::newRow(by) << QString(by);
}

void TestButtons::stopEndsIt() {
    QFETCH(QString, by);
    open({macro("Slow", {place(0.1, 30), place(0.9)})});
    press(0);
    QTRY_COMPARE(x(), 0.1);
    if (by == "button")
        QTest::mouseClick(find<QPushButton>("stop"), Qt::LeftButton);
    else if (by == "F12")
        QTest::keyClick(window_.get(), Qt::Key_F12);
    else
        QVERIFY(client_->callAndWait("motor.estop").ok());
    QTRY_VERIFY2(text().contains("ended at") && text().endsWith(": STOP"), qPrintable(text()));
    QVERIFY(!find<QPushButton>("endMacro")->isEnabled());
}

void TestButtons::isEdited() {
    open({macro("One", {place(0.1), place(0.2), place(0.3)}), macro("Two", {place(0.9)})});
    click("editButtons");
    auto *const list = find<QListWidget>("buttonList");
    auto *const steps = find<QListWidget>("buttonSteps");
    QTRY_VERIFY(list->isVisible());
    QCOMPARE(list->currentRow(), 0);
    OpenWindow::type(find<QLineEdit>("buttonName"), "First");
    QTest::keyClick(find<QLineEdit>("buttonName"), Qt::Key_Return);
    QTRY_COMPARE(title(0), QString("First"));
    QCOMPARE(list->item(0)->text(), QString("First"));
    click("buttonDown");
    QTRY_COMPARE(title(1), QString("First"));
    QCOMPARE(list->currentRow(), 1);
    QCOMPARE(steps->count(), 3);
    steps->setCurrentRow(1);
    click("stepDown"); // 0.1, 0.3, 0.2
    QCOMPARE(steps->currentRow(), 2);
    click("stepUp");
    click("stepDown");
    steps->setCurrentRow(1);
    click("stepRemove"); // 0.1, 0.2
    QCOMPARE(steps->count(), 2);
    steps->setCurrentRow(0);
    OpenWindow::type(find<QLineEdit>("stepPause"), "0.5");
    steps->setCurrentRow(1);
    auto *const page = window_->findChild<QWidget *>("aboutStep")->parentWidget();
    auto *const field = page->findChild<QWidget *>("x")->findChild<QLineEdit *>();
    QCOMPARE(field->text(), QString("0.2"));
    OpenWindow::type(field, "wrong");
    OpenWindow::type(field, "0.45");
    QElapsedTimer clock;
    clock.start();
    press(1);
    QTRY_COMPARE(text(), QString("First: done"));
    QVERIFY(clock.elapsed() >= 500);
    QCOMPARE(x(), 0.45);
    list->setCurrentRow(0);
    click("buttonRemove");
    QTRY_VERIFY(!button(1));
    QTRY_COMPARE(title(0), QString("First"));
    click("buttonRemove");
    QVERIFY(!find<QToolBar>("buttonBar")->isVisible());
    click("closeButtons");
    QTRY_VERIFY(find<QListWidget>("methods")->isVisible());
}

void TestButtons::isKeptAndGreyWithoutItsDaemon() {
    open();
    chooseMethod("simulator", "sim.place");
    typeParameter("x", "0.35");
    typeParameter("y", "0");
    typeParameter("theta", "0");
    click("addButton");
    QTest::keyClicks(QApplication::focusWidget(), "Kept & fine");
    window_.reset(); // not closed in order
    drive_.reset();
    fleet_.reset();
    fleet_ = std::make_unique<Fleet>(); // with nobody
    drive_ = std::make_unique<DriveControl>(*fleet_);
    window_ = std::make_unique<MainWindow>(*fleet_, *drive_, file_);
    window_->show();
    QTRY_VERIFY(button(0));
    QTRY_COMPARE(title(0), QString("Kept && fine (simulator away)"));
    QVERIFY(!button(0)->isEnabled());
    QVERIFY2(button(0)->toolTip().contains("simulator of 127.0.0.1 is away"),
             qPrintable(button(0)->toolTip()));
    robot_->connectTo(*fleet_);
    QTRY_VERIFY(button(0)->isEnabled());
    QCOMPARE(title(0), QString("Kept && fine"));
    press(0);
    QTRY_COMPARE(text(), QString("Kept & fine: done"));
    QCOMPARE(x(), 0.35);
}

void TestButtons::nonsenseInTheFile_data() {
    QTest::addColumn<QByteArray>("kept");
    QTest::addColumn<int>("shown");
    const QByteArray step = R"({"robot":"a","daemon":"b","method":"c"})";
    QByteArray many = "[", steps, deep = "1";
    for (int i = 0; i < 5000; ++i)
        many += (i ? ",{\"name\":\"n\",\"steps\":[" : "{\"name\":\"n\",\"steps\":[") + step + "]}";
    for (int i = 0; i < 51; ++i)
        steps += (i ? "," : "") + step;
    for (int i = 0; i < 90; ++i)
        deep = '[' + deep + ']';
    QTest::newRow("no JSON") << QByteArray("{[") << 0;
    QTest::newRow("an object") << QByteArray("{}") << 0;
    QTest::newRow("numbers") << QByteArray("[1,null,\"x\",{}]") << 0;
    QTest::newRow("no steps") << QByteArray(R"([{"name":"x","steps":[]}])") << 0;
    QTest::newRow("steps of a wrong kind") << QByteArray(R"([{"name":"x","steps":[5]}])") << 0;
    QTest::newRow("one wrong step of two")
        << R"([{"name":"x","steps":[)" + step + R"(,{"method":5}]}])" << 0; // would be another macro
    QTest::newRow("many steps") << R"([{"name":"x","steps":[)" + steps + "]}]" << 0;
    QTest::newRow("many buttons") << many + ']' << Buttons::most;
    QTest::newRow("long names") << R"([{"name":")" + QByteArray(100000, 'W') + R"(","steps":[)" + step + "]}]"
                                << 1;
    QTest::newRow("markup") << R"([{"name":"<h1>&\u202e\u0000x","steps":[)" + step + "]}]" << 1;
    QTest::newRow("large parameters") << R"([{"name":"x","steps":[{"robot":"a","daemon":"b","method":"c",)"
                                         R"("params":{"p":")" +
                                             QByteArray(30000, 'x') + R"("}}]}])"
                                      << 0;
    QTest::newRow("deep parameters") << R"([{"name":"x","steps":[{"robot":"a","daemon":"b","method":"c",)"
                                        R"("params":{"p":)" +
                                            deep + "}}]}]"
                                     << 1;
    QTest::newRow("an endless pause")
        << QByteArray(R"([{"name":"x","steps":[{"method":"c","pause_s":1e300}]}])") << 1;
}

void TestButtons::nonsenseInTheFile() {
    QFETCH(QByteArray, kept);
    QFETCH(int, shown);
    keep(kept);
    open();
    QCOMPARE(window_->findChildren<QPushButton *>(QRegularExpression("^macro\\d+$")).size(), shown);
    QVERIFY(window_->minimumSizeHint().width() < 1024);
    QCOMPARE(find<QToolBar>("buttonBar")->isVisible(), shown > 0);
    if (shown > 0) {
        click("editButtons");
        QTRY_VERIFY(button(0) && !button(0)->isEnabled());
    }
}

QTEST_MAIN(TestButtons)
#include "TestButtons.moc"
