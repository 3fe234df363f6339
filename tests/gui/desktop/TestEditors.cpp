#include "gui/desktop/widgets/WheelGuard.h"
#include "tests/gui/desktop/OpenForm.h"

#include <QCheckBox>
#include <QToolButton>
#include <QWheelEvent>

using namespace hermes;
using namespace hermes::desktop;

/// Each kind of value is edited by mouse and keys, and comes out as its schema wants it.
class TestEditors : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void init();
    void cleanup();
    void textsAreRows();
    void numbersAreOneLine();
    void objectsFoldOut();
    void rowsMoveAndKeepTheFocus();
    void choicesHaveTitles();
    void whatMayBeAbsentIs();
    void numbersStepAndKeepTheirDigits();
    void amountsAreSpoken();
    void freeKeys();
    void patternsAndFormats_data();
    void patternsAndFormats();
    void whatNoRowsSuitIsText_data();
    void whatNoRowsSuitIsText();
    void textIsChecked();
    void anyValueKeepsItsType();
    void tabGoesThroughTheRows();
    void theWheelChangesNothing();
    void manyRowsAreShownSoon();

private:
    std::unique_ptr<OpenForm> open_;
    SchemaForm *form_ = nullptr;
};

void TestEditors::init() {
    open_ = std::make_unique<OpenForm>();
    form_ = &open_->form();
}

void TestEditors::cleanup() {
    open_.reset();
}

void TestEditors::textsAreRows() {
    open_->showOne(R"({"type":"array","items":{"type":"string"},"minItems":1})", R"(["/"])");
    QCOMPARE(open_->seen<QLineEdit>()->text(), QString("/"));
    open_->click("add");
    QVERIFY(!form_->isValid()); // nothing is typed yet
    QCOMPARE(QApplication::focusWidget(), open_->seen<QLineEdit>(1));
    QTest::keyClicks(QApplication::focusWidget(), "/home/robot");
    QCOMPARE(open_->value(), QByteArray(R"(["/","/home/robot"])"));
    QVERIFY(form_->isValid());
    QCOMPARE(open_->note(), QString("changed"));
    open_->click("up", 1);
    QCOMPARE(open_->value(), QByteArray(R"(["/home/robot","/"])"));
    open_->click("remove", 0);
    QCOMPARE(open_->value(), QByteArray(R"(["/"])"));
    QVERIFY(open_->note().isEmpty());
    open_->click("remove", 0);
    QVERIFY(!form_->isValid());
    QVERIFY2(open_->note().contains("at least 1"), qPrintable(open_->note()));
    form_->revert();
    QCOMPARE(open_->value(), QByteArray(R"(["/"])"));
}

void TestEditors::numbersAreOneLine() {
    open_->showOne(R"({"type":"array","items":{"type":"number","maximum":10},"maxItems":4})", "[1,2.5,0.1]");
    QCOMPARE(open_->seen<QLineEdit>()->text(), QString("1, 2.5, 0.1"));
    OpenForm::type(open_->seen<QLineEdit>(), "3 4,5.25");
    QCOMPARE(open_->value(), QByteArray("[3,4,5.25]"));
    QVERIFY(form_->isValid());
    OpenForm::type(open_->seen<QLineEdit>(), "3, 40");
    QVERIFY(!form_->isValid());
    QVERIFY2(open_->note().contains("at most 10"), qPrintable(open_->note()));
    OpenForm::type(open_->seen<QLineEdit>(), "3, x");
    QVERIFY(!form_->isValid());
    OpenForm::type(open_->seen<QLineEdit>(), "");
    QCOMPARE(open_->value(), QByteArray("")); // what has a value cannot be left without one
    QVERIFY(!form_->isValid());
}

static const char *const triggers = R"({"type":"array","maxItems":3,"items":{"type":"object",
    "required":["id","when"],"additionalProperties":false,"properties":{
        "id":{"type":"string","pattern":"^[a-z]{1,8}$","description":"Small letters"},
        "armed":{"type":"boolean","default":true},
        "when":{"type":"object","required":["kind"],"additionalProperties":false,"properties":{
            "kind":{"type":"string","enum":["period","command"]},
            "period_s":{"type":"number","unit":"s","minimum":0.001,"maximum":60}}},
        "actions":{"type":"array","items":{"type":"object","properties":{"text":{"type":"string"}}}}}}})";

void TestEditors::objectsFoldOut() {
    open_->showOne(triggers, R"([{"id":"gate","when":{"kind":"command"}}])");
    QVERIFY(!open_->seen<QLineEdit>());
    QVERIFY(open_->seen<QPushButton>(0, "fold")->text().contains("gate"));
    open_->click("fold");
    OpenForm::type(open_->seen<QLineEdit>(), "door");
    QVERIFY(open_->seen<QPushButton>(0, "fold")->text().contains("door"));
    QTest::keyClick(open_->seen<QComboBox>(), Qt::Key_Up); // period
    open_->addField("period", 1);
    OpenForm::type(open_->seen<QLineEdit>(1), "100");
    QVERIFY(!form_->isValid());
    QVERIFY2(open_->note().startsWith("row 1, when, period_s: expected"), qPrintable(open_->note()));
    OpenForm::type(open_->seen<QLineEdit>(1), "2.5");
    QVERIFY2(form_->isValid(), qPrintable(open_->note()));
    QCOMPARE(open_->value(), QByteArray(R"([{"id":"door","when":{"kind":"period","period_s":2.5}}])"));
    OpenForm::type(open_->seen<QLineEdit>(), "Door");
    QCOMPARE(open_->seen<QLabel>(0, "note")->text(), QString("expected Small letters"));
    OpenForm::type(open_->seen<QLineEdit>(), "door");
    open_->click("remove", 1); // the period
    QCOMPARE(open_->value(), QByteArray(R"([{"id":"door","when":{"kind":"period"}}])"));
    open_->click("fold");
    QVERIFY(!open_->seen<QLineEdit>());
    QCOMPARE(open_->value(), QByteArray(R"([{"id":"door","when":{"kind":"period"}}])"));
    open_->click("add"); // folded out at once
    QVERIFY(!form_->isValid());
    OpenForm::type(open_->seen<QLineEdit>(), "lamp");
    QTest::keyClick(open_->seen<QComboBox>(), Qt::Key_Down);
    QVERIFY2(form_->isValid(), qPrintable(open_->note()));
    QCOMPARE(
        open_->value(),
        QByteArray(R"([{"id":"door","when":{"kind":"period"}},{"id":"lamp","when":{"kind":"period"}}])"));
    open_->click("add");
    QVERIFY(!open_->seen<QPushButton>(0, "add") ||
            !form_->findChild<QPushButton *>("add")->isEnabled()); // three
}

void TestEditors::rowsMoveAndKeepTheFocus() {
    open_->showOne(R"({"type":"array","items":{"type":"string"}})", R"(["a","b","c"])");
    open_->seen<QToolButton>(2, "up")->setFocus();
    open_->click("up", 2);
    QCOMPARE(open_->value(), QByteArray(R"(["a","c","b"])"));
    QCOMPARE(QApplication::focusWidget(), open_->seen<QToolButton>(1, "up"));
    open_->click("up", 1);
    QCOMPARE(open_->value(), QByteArray(R"(["c","a","b"])"));
    QCOMPARE(QApplication::focusWidget(), open_->seen<QToolButton>(0, "down")); // it is the first
    open_->click("down", 0);
    QCOMPARE(open_->value(), QByteArray(R"(["a","c","b"])"));
}

void TestEditors::choicesHaveTitles() {
    open_->showOne(R"({"enum":["a","b",3],"enumNames":["First","Second"],"default":"a"})");
    auto *list = open_->seen<QComboBox>();
    QCOMPARE(list->itemText(1), QString("Second"));
    QCOMPARE(list->itemText(2), QString("3"));
    QTest::keyClick(list, Qt::Key_Down);
    QCOMPARE(open_->value(), QByteArray(R"("b")"));
    QTest::keyClick(list, Qt::Key_Down);
    QCOMPARE(open_->value(), QByteArray("3"));
    open_->showOne(R"({"oneOf":[{"const":1,"title":"Slow"},{"const":2,"title":"Fast"}],"default":1})");
    list = open_->seen<QComboBox>();
    QCOMPARE(list->currentText(), QString("Slow"));
    QTest::keyClick(list, Qt::Key_Down);
    QCOMPARE(open_->value(), QByteArray("2"));
    open_->showOne(R"({"enum":["a","b"],"default":"a"})", R"("other")");
    QCOMPARE(open_->value(), QByteArray(R"("other")")); // not dropped in silence
    QVERIFY(!form_->isValid());
}

void TestEditors::whatMayBeAbsentIs() {
    for (const char *const schema :
         {R"({"type":"string"})", R"({"type":"number"})", R"({"type":"boolean"})", R"({"enum":["x","y"]})",
          R"({"type":"array","items":{"type":"string"}})", R"({"type":"array","items":{"type":"number"}})",
          R"({"type":"object"})", R"({})"}) {
        open_->showOne(schema);
        QVERIFY2(open_->value().isEmpty() && form_->isValid(), schema);
    }
    open_->showOne(R"({"type":"boolean"})");
    auto *const list = open_->seen<QComboBox>();
    QCOMPARE(list->currentText(), QString("not given"));
    QTest::keyClick(list, Qt::Key_Down);
    QCOMPARE(open_->value(), QByteArray("true"));
    QTest::keyClick(list, Qt::Key_Down);
    QCOMPARE(open_->value(), QByteArray("false"));
    QTest::keyClick(list, Qt::Key_Home);
    QVERIFY(open_->value().isEmpty());
    open_->showOne(R"({"type":"boolean"})", {}, R"(,"required":["a"])");
    QCOMPARE(open_->value(), QByteArray("false"));
    QTest::mouseClick(open_->seen<QCheckBox>(), Qt::LeftButton, {},
                      {8, open_->seen<QCheckBox>()->height() / 2});
    QCOMPARE(open_->value(), QByteArray("true"));
}

void TestEditors::numbersStepAndKeepTheirDigits() {
    open_->showOne(R"({"type":"number","default":0.1,"maximum":1})", "0.30000000000000004");
    auto *line = open_->seen<QLineEdit>();
    QCOMPARE(line->text(), QString("0.3"));
    QCOMPARE(form_->values()["a"].toDouble(), 0.30000000000000004);
    QVERIFY(form_->changes().isEmpty());
    QTest::keyClick(line, Qt::Key_Up); // a tenth of what is usual
    QCOMPARE(line->text(), QString("0.31"));
    QTest::keyClick(line, Qt::Key_PageDown);
    QCOMPARE(line->text(), QString("0.21"));
    for (int i = 0; i < 10; ++i)
        QTest::keyClick(line, Qt::Key_PageUp);
    QCOMPARE(line->text(), QString("1"));
    open_->showOne(R"({"type":"integer","default":100000000})");
    line = open_->seen<QLineEdit>();
    QCOMPARE(line->text(), QString("100000000"));
    QTest::keyClick(line, Qt::Key_Down);
    QCOMPARE(open_->value(), QByteArray("99999999"));
    open_->showOne(R"({"type":"number","increment":0.25,"default":1})");
    QTest::keyClick(open_->seen<QLineEdit>(), Qt::Key_Up);
    QCOMPARE(open_->value(), QByteArray("1.25"));
}

void TestEditors::amountsAreSpoken() {
    open_->showOne(R"({"type":"integer","unit":"B","minimum":1024,"maximum":67108864,"default":1048576})");
    QCOMPARE(open_->note(), QString("1.0 MiB (1.0 KiB to 64.0 MiB)"));
    OpenForm::type(open_->seen<QLineEdit>(), "6764573491");
    QVERIFY2(open_->note().startsWith("6.3 GiB (expected"), qPrintable(open_->note()));
    open_->showOne(R"({"type":"number","unit":"s","default":200})");
    QVERIFY2(open_->note().startsWith("3 min 20 s"), qPrintable(open_->note()));
}

void TestEditors::freeKeys() {
    open_->showOne(R"({"type":"object","additionalProperties":{"type":"integer","minimum":1}})",
                   R"({"x":1})");
    QCOMPARE(open_->seen<QLineEdit>(0, "key")->text(), QString("x"));
    open_->click("addFree");
    QCOMPARE(QApplication::focusWidget(), open_->seen<QLineEdit>(1, "key"));
    QTest::keyClicks(QApplication::focusWidget(), "x");
    OpenForm::type(open_->seen<QLineEdit>(3), "0");
    QVERIFY(!form_->isValid()); // there is one of that name
    OpenForm::type(open_->seen<QLineEdit>(1, "key"), "y");
    QVERIFY(!form_->isValid()); // below 1
    OpenForm::type(open_->seen<QLineEdit>(3), "7");
    QVERIFY2(form_->isValid(), qPrintable(open_->note()));
    QCOMPARE(open_->value(), QByteArray(R"({"x":1,"y":7})"));
    OpenForm::type(open_->seen<QLineEdit>(0, "key"), "");
    QVERIFY(!form_->isValid());
    open_->click("remove", 0);
    QVERIFY(form_->isValid());
    QCOMPARE(open_->value(), QByteArray(R"({"y":7})"));
}

void TestEditors::patternsAndFormats_data() {
    QTest::addColumn<QByteArray>("schema");
    QTest::addColumn<QString>("good");
    QTest::addColumn<QString>("bad");
    QTest::newRow("pattern") << QByteArray(R"({"type":"string","pattern":"^[a-z]+$"})") << "abc"
                             << "ab1";
    const auto format = [](const char *name, const char *good, const char *bad) {
        QTest::newRow(name) << QByteArray(R"({"type":"string","format":")") + name + R"("})" << QString(good)
                            << QString(bad);
    };
    format("date-time", "2026-01-31T12:00:00Z", "2026-02-31T12:00:00Z");
    format("date", "2026-01-31", "31.1.2026");
    format("ipv4", "192.168.1.20", "192.168.1.300");
    format("ipv6", "fe80::1", "fe80:::1");
    format("uri", "tcp://robot:7400", "robot");
}

void TestEditors::patternsAndFormats() {
    QFETCH(QByteArray, schema);
    QFETCH(QString, good);
    QFETCH(QString, bad);
    open_->showOne(schema);
    OpenForm::type(open_->seen<QLineEdit>(), bad);
    QVERIFY(!form_->isValid());
    QVERIFY2(open_->note().startsWith("expected"), qPrintable(open_->note()));
    OpenForm::type(open_->seen<QLineEdit>(), good);
    QVERIFY2(form_->isValid(), qPrintable(open_->note()));
    QCOMPARE(form_->values()["a"], QJsonValue(good));
}

static QByteArray nested(int depth) {
    QByteArray schema = R"({"type":"string"})";
    for (int i = 0; i < depth; ++i)
        schema = R"({"type":"object","required":["b"],"properties":{"b":)" + schema + "}}";
    return schema;
}

void TestEditors::whatNoRowsSuitIsText_data() {
    QTest::addColumn<QByteArray>("schema");
    QTest::addColumn<QByteArray>("given");
    QTest::addColumn<bool>("isLine");
    QTest::newRow("alternatives") << QByteArray(R"({"oneOf":[{"type":"number"},{"type":"object"}]})")
                                  << QByteArray(R"({"b":[1,{"c":null}]})") << true;
    QTest::newRow("any") << QByteArray("{}") << QByteArray(R"([1,"x",null])") << true;
    QByteArray rows = "[";
    for (int i = 0; i < 1000; ++i)
        rows += (i ? ",\"row " : "\"row ") + QByteArray::number(i) + '"';
    QTest::newRow("1000 rows") << QByteArray(R"({"type":"array","items":{"type":"string"}})") << rows + ']'
                               << false;
    QByteArray deep = R"("x")";
    for (int i = 0; i < 12; ++i)
        deep = R"({"b":)" + deep + '}';
    QTest::newRow("deep") << nested(12) << deep << false;
    QTest::newRow("another type") << QByteArray(R"({"type":"array","items":{"type":"string"}})")
                                  << QByteArray(R"({"b":1})") << false;
}

void TestEditors::whatNoRowsSuitIsText() {
    QFETCH(QByteArray, schema);
    QFETCH(QByteArray, given);
    QFETCH(bool, isLine);
    open_->showOne(schema, given);
    QCOMPARE(open_->value(), given);
    QCOMPARE(open_->seen<QPlainTextEdit>() == nullptr, isLine);
}

void TestEditors::textIsChecked() {
    open_->showOne(R"({"type":"array","items":{"type":"string"}})", R"({"b":1})");
    auto *const text = open_->seen<QPlainTextEdit>();
    QVERIFY(!form_->isValid()); // no list
    QTest::mouseClick(text->viewport(), Qt::LeftButton);
    QTest::keyClick(text, Qt::Key_A, Qt::ControlModifier);
    QTest::keyClicks(text, "[\"x\",");
    QTest::keyClick(text, Qt::Key_Return);
    QTest::keyClicks(text, "5");
    QVERIFY(!form_->isValid());
    QVERIFY2(open_->note().contains("bracket") && open_->note().contains("line"), qPrintable(open_->note()));
    QTest::keyClicks(text, "]");
    QVERIFY(!form_->isValid()); // 5 is no text
    QVERIFY2(open_->note().startsWith("row 2: expected a string"), qPrintable(open_->note()));
    QTest::keyClick(text, Qt::Key_Backspace);
    QTest::keyClick(text, Qt::Key_Backspace);
    QTest::keyClicks(text, "\"y\"]");
    QVERIFY2(form_->isValid(), qPrintable(open_->note()));
    QCOMPARE(open_->value(), QByteArray(R"(["x","y"])"));
}

void TestEditors::anyValueKeepsItsType() {
    const char *const any = R"({"type":["number","string","boolean","null"]})";
    for (const char *const given : {"5", R"("5")", "null", R"("null")", "true", R"("true")", R"("")",
                                    R"("a b")", R"(" a")", "1e300", R"("[")"}) {
        open_->showOne(any, given);
        QCOMPARE(open_->value(), QJsonDocument::fromJson(QByteArray("[") + given + ']').array()[0] ==
                                         QJsonDocument::fromJson("[" + open_->value() + "]").array()[0]
                                     ? open_->value()
                                     : QByteArray(given));
        auto *const line = open_->seen<QLineEdit>();
        const QString text = line->text();
        OpenForm::type(line, "other");
        QCOMPARE(open_->value(), QByteArray(R"("other")"));
        OpenForm::type(line, text); // as it was shown, it means the same
        QCOMPARE(QJsonDocument::fromJson("[" + open_->value() + "]").array()[0],
                 QJsonDocument::fromJson(QByteArray("[") + given + ']').array()[0]);
    }
}

void TestEditors::tabGoesThroughTheRows() {
    open_->showOne(R"({"type":"array","items":{"type":"string"}})", R"(["x"])");
    open_->click("add");
    QTest::keyClicks(QApplication::focusWidget(), "y");
    open_->seen<QLineEdit>(0)->setFocus();
    QWidgetList met;
    for (int i = 0; i < 8 && !met.contains(QApplication::focusWidget()); ++i) {
        met.append(QApplication::focusWidget());
        QTest::keyClick(QApplication::focusWidget(), Qt::Key_Tab);
    }
    const QWidgetList wanted{open_->seen<QLineEdit>(0),
                             open_->seen<QToolButton>(0, "down"),
                             open_->seen<QToolButton>(0, "remove"),
                             open_->seen<QLineEdit>(1),
                             open_->seen<QToolButton>(1, "up"),
                             open_->seen<QToolButton>(1, "remove"),
                             open_->seen<QPushButton>(0, "add")};
    QCOMPARE(met.mid(0, wanted.size()), wanted);
}

void TestEditors::theWheelChangesNothing() {
    open_->showOne(R"({"type":"array","items":{"type":"object","required":["k","n"],"properties":{
             "k":{"enum":["x","y","z"]},"n":{"type":"number"}}}})",
                   R"([{"k":"y","n":5}])");
    new WheelGuard(open_->window());
    open_->click("fold");
    const QByteArray before = open_->value();
    for (QWidget *const over : {static_cast<QWidget *>(open_->seen<QComboBox>()),
                                static_cast<QWidget *>(open_->seen<QLineEdit>())}) {
        over->setFocus();
        const QPointF at(over->rect().center());
        QWheelEvent event(at, over->mapToGlobal(at.toPoint()), {}, {0, -240}, {}, {}, {}, false);
        QApplication::sendEvent(over, &event);
        QCOMPARE(open_->value(), before);
    }
}

// As many as are shown as rows, in a form that has many such lists.
void TestEditors::manyRowsAreShownSoon() {
    QJsonObject properties, values;
    for (int i = 0; i < 20; ++i) {
        QJsonArray rows;
        for (int j = 0; j < 100; ++j)
            rows.append(QString("row %1").arg(j));
        properties[QString("list%1").arg(i)] =
            QJsonObject{{"type", "array"}, {"items", QJsonObject{{"type", "string"}}}};
        values[QString("list%1").arg(i)] = rows;
    }
    open_->show();
    QElapsedTimer clock;
    clock.start();
    form_->setSchema({{"type", "object"}, {"properties", properties}}, values);
    qInfo("the form took %lld ms", clock.elapsed());
    QCOMPARE(form_->values(), values);
    const int rows = form_->findChildren<QToolButton *>("up").size();
    QVERIFY2(rows >= 100 && rows <= 200, qPrintable(QString::number(rows)));
    QVERIFY(!form_->findChildren<QPlainTextEdit *>().isEmpty()); // the rest
}

QTEST_MAIN(TestEditors)
#include "TestEditors.moc"
