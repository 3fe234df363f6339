#include "gui/desktop/widgets/WheelGuard.h"
#include "tests/gui/desktop/OpenForm.h"

using namespace hermes;

/// The inputs for single values: numbers, texts, choices, and any value.
class TestValueEditors : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void init() {
        open_ = std::make_unique<OpenForm>();
        form_ = &open_->form();
    }

    void cleanup() { open_.reset(); }

    void numbersAreOneLine() {
        open_->showOne(R"({"type":"array","items":{"type":"number","maximum":10},"maxItems":4})",
                       "[1,2.5,0.1]");
        QCOMPARE(open_->seen<QLineEdit>()->text(), QString("1, 2.5, 0.1"));
        OpenForm::type(open_->seen<QLineEdit>(), "3 4,5.25");
        QCOMPARE(open_->value(), QByteArray("[3,4,5.25]"));
        QVERIFY(form_->isValid());
        OpenForm::type(open_->seen<QLineEdit>(), "3, 40");
        QVERIFY(!form_->isValid());
        VERIFY_CONTAINS(open_->note(), "at most 10");
        OpenForm::type(open_->seen<QLineEdit>(), "3, x");
        QVERIFY(!form_->isValid());
        OpenForm::type(open_->seen<QLineEdit>(), "");
        QCOMPARE(open_->value(), QByteArray("")); // what has a value cannot be left without one
        QVERIFY(!form_->isValid());
    }

    void choicesHaveTitles() {
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

    void numbersStepAndKeepTheirDigits() {
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

    void digitsThatWouldBeLostAreRefused_data() {
        const Rows<QByteArray, QString> row("schema", "text");
        row("number", R"({"type":"integer","default":1})", "9007199254740995");
        row("list", R"({"type":"array","items":{"type":"integer"}})", "1, -9007199254740993");
        row("any", R"({"default":0})", R"({"a": 12345678901234567})");
    }

    void digitsThatWouldBeLostAreRefused() {
        FETCH(QByteArray, schema, QString, text);
        open_->showOne(schema);
        OpenForm::type(open_->seen<QLineEdit>(), text);
        QVERIFY2(!form_->isValid(), open_->value());
        VERIFY_CONTAINS(open_->note(), "15 digits");
        OpenForm::type(open_->seen<QLineEdit>(), QString(text).replace(QRegularExpression("\\d{16,}"),
                                                                       "9007199254740992")); // 2^53
        QVERIFY2(form_->isValid(), qPrintable(open_->note()));
    }

    void secretsAreHidden() {
        for (const char *const schema : {R"({"type":"string","writeOnly":true,"default":"pass123"})",
                                         R"({"type":"string","format":"password","default":"pass123"})"}) {
            open_->showOne(schema);
            auto *const line = open_->seen<QLineEdit>();
            QVERIFY(!line->displayText().contains("pass123"));
            QVERIFY(!line->placeholderText().contains("pass123"));
            QVERIFY2(!line->parentWidget()->toolTip().contains("pass123"),
                     qPrintable(line->parentWidget()->toolTip()));
            OpenForm::type(line, "other");
            QCOMPARE(open_->value(), QByteArray("\"other\""));
        }
    }

    void whatIsOnlyToldIsNotEdited() {
        open_->showOne(R"({"type":"integer","readOnly":true,"default":1})", "5");
        auto *const line = open_->seen<QLineEdit>();
        QVERIFY(!line->isEnabled());
        QCOMPARE(line->text(), QString("5"));
        form_->setDefaults();
        QVERIFY(form_->changes().isEmpty());
    }

    void amountsAreSpoken() {
        open_->showOne(
            R"({"type":"integer","unit":"B","minimum":1024,"maximum":67108864,"default":1048576})");
        QCOMPARE(open_->note(), QString("1.0 MiB (1.0 KiB to 64.0 MiB)"));
        OpenForm::type(open_->seen<QLineEdit>(), "6764573491");
        VERIFY_STARTS(open_->note(), "6.3 GiB (expected");
        open_->showOne(R"({"type":"number","unit":"s","default":200})");
        VERIFY_STARTS(open_->note(), "3 min 20 s");
    }

    void patternsAndFormats_data() {
        const Rows<QByteArray, QString, QString> row("schema", "good", "bad");
        row("pattern", R"({"type":"string","pattern":"^[a-z]+$"})", "abc", "ab1");
        const auto format = [&](const char *name, const char *good, const char *bad) {
            row(name, QByteArray(R"({"type":"string","format":"%1"})").replace("%1", name), QString(good),
                QString(bad));
        };
        format("date-time", "2026-01-31T12:00:00Z", "2026-02-31T12:00:00Z");
        format("date", "2026-01-31", "31.1.2026");
        format("ipv4", "192.168.1.20", "192.168.1.300");
        format("ipv6", "fe80::1", "fe80:::1");
        format("uri", "tcp://robot:7400", "robot");
    }

    void patternsAndFormats() {
        FETCH(QByteArray, schema, QString, good, QString, bad);
        open_->showOne(schema);
        OpenForm::type(open_->seen<QLineEdit>(), bad);
        QVERIFY(!form_->isValid());
        VERIFY_STARTS(open_->note(), "expected");
        OpenForm::type(open_->seen<QLineEdit>(), good);
        QVERIFY2(form_->isValid(), qPrintable(open_->note()));
        QCOMPARE(form_->values()["a"], QJsonValue(good));
    }

    void textIsChecked() {
        open_->showOne(R"({"type":"array","items":{"type":"string"}})", R"({"b":1})");
        auto *const text = open_->seen<QPlainTextEdit>();
        QVERIFY(!form_->isValid()); // no list
        QTest::mouseClick(text->viewport(), Qt::LeftButton);
        QTest::keyClick(text, Qt::Key_A, Qt::ControlModifier);
        QTest::keyClicks(text, "[\"x\",");
        QTest::keyClick(text, Qt::Key_Return);
        QTest::keyClicks(text, "5");
        QVERIFY(!form_->isValid());
        QVERIFY2(open_->note().contains("bracket") && open_->note().contains("line"),
                 qPrintable(open_->note()));
        QTest::keyClicks(text, "]");
        QVERIFY(!form_->isValid()); // 5 is no text
        VERIFY_STARTS(open_->note(), "row 2: expected a string");
        QTest::keyClick(text, Qt::Key_Backspace);
        QTest::keyClick(text, Qt::Key_Backspace);
        QTest::keyClicks(text, "\"y\"]");
        QVERIFY2(form_->isValid(), qPrintable(open_->note()));
        QCOMPARE(open_->value(), QByteArray(R"(["x","y"])"));
    }

    void anyValueKeepsItsType() {
        const char *const any = R"({"type":["number","string","boolean","null"]})";
        for (const char *const given : {"5", R"("5")", "null", R"("null")", "true", R"("true")", R"("")",
                                        R"("a b")", R"(" a")", "1e300", "\"[\""}) {
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

    void theWheelChangesNothing() {
        open_->showOne(R"({"type":"array","items":{"type":"object","required":["k","n"],"properties":{)"
                       R"("k":{"enum":["x","y","z"]},"n":{"type":"number"}}}})",
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

private:
    std::unique_ptr<OpenForm> open_;
    SchemaForm *form_ = nullptr;
};
