#include "tests/gui/desktop/OpenForm.h"

using namespace hermes;

static const char *const triggers = R"({"type":"array","maxItems":3,"items":{"type":"object",
    "required":["id","when"],"additionalProperties":false,"properties":{
        "id":{"type":"string","pattern":"^[a-z]{1,8}$","description":"Small letters"},
        "armed":{"type":"boolean","default":true},
        "when":{"type":"object","required":["kind"],"additionalProperties":false,"properties":{
            "kind":{"type":"string","enum":["period","command"]},
            "period_s":{"type":"number","unit":"s","minimum":0.001,"maximum":60}}},
        "actions":{"type":"array","items":{"type":"object","properties":{"text":{"type":"string"}}}}}}})";

static QByteArray nested(int depth) {
    QByteArray schema = R"({"type":"string"})";
    for (int i = 0; i < depth; ++i)
        schema = R"({"type":"object","required":["b"],"properties":{"b":)" + schema + "}}";
    return schema;
}

/// The inputs for lists and objects.
class TestEditors : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void init() {
        open_ = std::make_unique<OpenForm>();
        form_ = &open_->form();
    }

    void cleanup() { open_.reset(); }

    void textsAreRows() {
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
        VERIFY_CONTAINS(open_->note(), "at least 1");
        form_->revert();
        QCOMPARE(open_->value(), QByteArray(R"(["/"])"));
    }

    void objectsFoldOut() {
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
        VERIFY_STARTS(open_->note(), "row 1, when, period_s: expected");
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

    void rowsMoveAndKeepTheFocus() {
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

    void whatMayBeAbsentIs() {
        for (const char *const schema :
             {R"({"type":"string"})", R"({"type":"number"})", R"({"type":"boolean"})",
              R"({"enum":["x","y"]})", R"({"type":"array","items":{"type":"string"}})",
              R"({"type":"array","items":{"type":"number"}})", R"({"type":"object"})", R"({})"}) {
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

    void freeKeys() {
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

    void whatNoRowsSuitIsText_data() {
        const Rows<QByteArray, QByteArray, bool> row("schema", "given", "isLine");
        row("alternatives", R"({"oneOf":[{"type":"number"},{"type":"object"}]})", R"({"b":[1,{"c":null}]})",
            true);
        row("any", "{}", R"([1,"x",null])", true);
        QByteArray rows = "[";
        for (int i = 0; i < 1000; ++i)
            rows += (i ? ",\"row " : "\"row ") + QByteArray::number(i) + '"';
        row("1000 rows", R"({"type":"array","items":{"type":"string"}})", rows + ']', false);
        QByteArray deep = R"("x")";
        for (int i = 0; i < 12; ++i)
            deep = R"({"b":)" + deep + '}';
        row("deep", nested(12), deep, false);
        row("another type", R"({"type":"array","items":{"type":"string"}})", R"({"b":1})", false);
    }

    void whatNoRowsSuitIsText() {
        FETCH(QByteArray, schema, QByteArray, given, bool, isLine);
        open_->showOne(schema, given);
        QCOMPARE(open_->value(), given);
        QCOMPARE(open_->seen<QPlainTextEdit>() == nullptr, isLine);
    }

    void tabGoesThroughTheRows() {
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

    // As many as are shown as rows, in a form that has many such lists.
    void manyRowsAreShownSoon() {
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
        auto clock = runningTimer();
        form_->setSchema({{"type", "object"}, {"properties", properties}}, values);
        qInfo("the form took %lld ms", clock.elapsed());
        QCOMPARE(form_->values(), values);
        const int rows = form_->findChildren<QToolButton *>("up").size();
        QVERIFY2(rows >= 100 && rows <= 200, saying(rows));
        QVERIFY(!form_->findChildren<QPlainTextEdit *>().isEmpty()); // the rest
    }

private:
    std::unique_ptr<OpenForm> open_;
    SchemaForm *form_ = nullptr;
};
