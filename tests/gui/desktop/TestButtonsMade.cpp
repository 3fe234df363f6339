#include "tests/gui/desktop/ButtonsWindow.h"

using namespace hermes;

Q_DECLARE_METATYPE(hermes::desktop::MacroStep)

/// Commands become buttons of the operator's own, which are changed and kept.
class TestButtonsMade : public QObject, protected ButtonsWindow {
    Q_OBJECT
private Q_SLOTS:
    void initTestCase() { startRobot(); }
    void init() { begin(); }
    void cleanup() { close(); }

    void commandBecomesAButton() {
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

    void commandBecomesAStep() {
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

    void whatCannotBeKeptIsNotTaken_data() {
        rowsOf("letter", {"x", "ä", "字"}); // of one, two and three bytes
    }

    void whatCannotBeKeptIsNotTaken() {
        QFETCH(QString, letter);
        open(
            {macro("Old", {step("motorcontrol", "settings.get", {{"path", "wheels"}, {"changes", false}})})});
        const QString most = letter.repeated((MacroStep::maxParams - bytesOf({})) / letter.toUtf8().size());
        const QString large = most + letter;
        QVERIFY(bytesOf(most) <= MacroStep::maxParams && bytesOf(large) > MacroStep::maxParams);
        const QString found =
            QString("settings.get have %1 bytes; a button keeps 20000 at most").arg(bytesOf(large));
        chooseMethod("motorcontrol", "settings.get");
        paste(callForm(), "path", large);
        click("addButton");
        QVERIFY2(answer().startsWith("Not added. ") && answer().contains(found), qPrintable(answer()));
        QVERIFY(!button(1));
        QVERIFY(find<QListWidget>("methods")->isVisible()); // nothing to be named
        find<QPlainTextEdit>("answer")->clear();
        find<QPushButton>("addStep")->menu()->actions()[0]->trigger();
        QVERIFY2(answer().startsWith("Not added. ") && answer().contains(found), qPrintable(answer()));

        click("editButtons");
        QCOMPARE(find<QListWidget>("buttonSteps")->count(), 1);
        auto *const notKept = find<QLabel>("stepNotKept");
        paste(notKept->parentWidget(), "path", large);
        QTRY_VERIFY(notKept->isVisible());
        VERIFY_CONTAINS(notKept->text(), found);
        find<QListWidget>("buttonSteps")->setCurrentRow(-1); // away from it, and back
        find<QListWidget>("buttonSteps")->setCurrentRow(0);
        QVERIFY(!notKept->isVisible());
        QCOMPARE(notKept->parentWidget()->findChild<QWidget *>("path")->findChild<QLineEdit *>()->text(),
                 QString("wheels"));
        paste(notKept->parentWidget(), "path", most);
        QVERIFY(!notKept->isVisible());
        QTRY_COMPARE(kept(0).steps.size(), std::size_t(1));
        QTRY_COMPARE(kept(0).steps[0].params["path"].toString(), most);
    }

    void whatIsTakenIsKept_data() { whatCannotBeKeptIsNotTaken_data(); }

    void whatIsTakenIsKept() {
        QFETCH(QString, letter);
        open(
            {macro("Old", {step("motorcontrol", "settings.get", {{"path", "wheels"}, {"changes", false}})})});
        const QString most = letter.repeated((MacroStep::maxParams - bytesOf({})) / letter.toUtf8().size());
        chooseMethod("motorcontrol", "settings.get");
        paste(callForm(), "path", most);
        find<QPushButton>("addStep")->menu()->actions()[0]->trigger();
        VERIFY_STARTS(answer(), "Added to");
        click("addButton");
        QTRY_VERIFY(button(1));
        QTRY_COMPARE(kept(1).steps.size(), std::size_t(1));
        QCOMPARE(kept(1).steps[0].params["path"].toString(), most);
        QCOMPARE(kept(0).steps.size(), std::size_t(2));
        QCOMPARE(kept(0).steps[1].params["path"].toString(), most);
    }

    // What each step may be is what a file may hold.
    void whatTheStepSaysHoldsForTheFile_data() {
        const Rows<MacroStep, QString> row("step", "problem");
        const auto nested = [](int depth) {
            QJsonValue value = 1;
            for (int i = 0; i < depth; ++i)
                value = QJsonArray{value};
            return QJsonObject{{"list", value}};
        };
        row("usual", {"a", "b", "c", {{"x", 1}}}, QString());
        row("deep", {"a", "b", "c", nested(1000)}, QString());
        row("too deep", {"a", "b", "c", nested(1023)}, "too many lists in lists");
        row("long name", {"a", "b", QString(200, 'c'), {}}, QString());
        row("too long a name", {"a", "b", QString(201, 'c'), {}},
            "has a name of 201 characters; a button keeps one line of 200");
        row("two lines", {"a", "b\nb", "c", {}}, "keeps one line");
    }

    void whatTheStepSaysHoldsForTheFile() {
        FETCH(MacroStep, step, QString, problem);
        const QString told = step.problem();
        QVERIFY2(told.isEmpty() == problem.isEmpty() && told.contains(problem), qPrintable(told));
        Buttons before, after;
        before.add({"name", {step}});
        after.setState(QJsonDocument::fromJson(QJsonDocument(before.state()).toJson()).array());
        const bool isTheSame = after.state() == before.state();
        QCOMPARE(isTheSame, told.isEmpty());
    }

    void isEdited() {
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
        auto clock = runningTimer();
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

    void isKeptAndGreyWithoutItsDaemon() {
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
        QTRY_COMPARE(title(0), QString("Kept && fine"));
        QVERIFY(!button(0)->isEnabled());
        const int width = button(0)->sizeHint().width();
        VERIFY_CONTAINS(button(0)->toolTip(), "simulator of 127.0.0.1 is away");
        robot_->connectTo(*fleet_);
        QTRY_VERIFY(button(0)->isEnabled());
        QCOMPARE(button(0)->sizeHint().width(), width); // what is beside it does not move
        press(0);
        QTRY_COMPARE(text(), QString("Kept & fine: done"));
        QCOMPARE(x(), 0.35);
    }

    void nonsenseInTheFile_data() {
        const Rows<QByteArray, int> row("kept", "shown");
        const QByteArray step = R"({"robot":"a","daemon":"b","method":"c"})";
        QByteArray many = "[", steps, deep = "1";
        for (int i = 0; i < 5000; ++i)
            many += (i ? ",{\"name\":\"n\",\"steps\":[" : "{\"name\":\"n\",\"steps\":[") + step + "]}";
        for (int i = 0; i < 51; ++i)
            steps += (i ? "," : "") + step;
        for (int i = 0; i < 90; ++i)
            deep = '[' + deep + ']';
        row("no JSON", "{[", 0);
        row("an object", "{}", 0);
        row("numbers", "[1,null,\"x\",{}]", 0);
        row("no steps", R"([{"name":"x","steps":[]}])", 0);
        row("steps of a wrong kind", R"([{"name":"x","steps":[5]}])", 0);
        row("one wrong step of two", R"([{"name":"x","steps":[)" + step + R"(,{"method":5}]}])",
            0); // would be another macro
        row("many steps", R"([{"name":"x","steps":[)" + steps + "]}]", 0);
        row("many buttons", many + ']', Buttons::most);
        row("long names", R"([{"name":")" + QByteArray(100000, 'W') + R"(","steps":[)" + step + "]}]", 1);
        row("markup", R"([{"name":"<h1>&\u202e\u0000x","steps":[)" + step + "]}]", 1);
        row("large parameters",
            R"([{"name":"x","steps":[{"robot":"a","daemon":"b","method":"c",)"
            R"("params":{"p":")" +
                QByteArray(30000, 'x') + R"("}}]}])",
            0);
        row("deep parameters",
            R"([{"name":"x","steps":[{"robot":"a","daemon":"b","method":"c",)"
            R"("params":{"p":)" +
                deep + "}}]}]",
            1);
        row("an endless pause", R"([{"name":"x","steps":[{"method":"c","pause_s":1e300}]}])", 1);
    }

    void nonsenseInTheFile() {
        FETCH(QByteArray, kept, int, shown);
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

private:
    /// Into the field of a parameter, as from the clipboard.
    void paste(QWidget *form, const QString &parameter, const QString &text) {
        auto *const field = form->findChild<QWidget *>(parameter)->findChild<QLineEdit *>();
        QTRY_VERIFY(field && field->isVisible());
        field->setMaxLength(100000);
        field->setFocus();
        field->selectAll();
        field->insert(text);
        QVERIFY(field->text() == text);
    }
    QWidget *callForm() const { return find<QPushButton>("call")->parentWidget()->parentWidget(); }
    QString answer() const { return find<QPlainTextEdit>("answer")->toPlainText(); }
    static int bytesOf(const QString &text) {
        return QJsonDocument(QJsonObject{{"path", text}, {"changes", false}})
            .toJson(QJsonDocument::Compact)
            .size();
    }
    Macro kept(int place) const {
        Buttons buttons;
        buttons.setState(QJsonDocument::fromJson(Layouts(file_).value("buttons").toUtf8()).array());
        return place < int(buttons.all().size()) ? buttons.all()[std::size_t(place)] : Macro();
    }
};
