#include "common/schema/Angles.h"
#include "common/schema/CheckableSchema.h"
#include "common/schema/Field.h"
#include "common/schema/SchemaValidator.h"
#include "vectorlib/geometry/Angle.h"

using namespace hermes;

/// Schemas that come from elsewhere.
class TestSchemaValidator : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void refused_data();
    void refused();
    void patterns_data();
    void patterns();
    void costIsBounded();
    void anglesBeyondATurn();
    void anglesInDegrees();

private:
    static QJsonObject object(const char *json) { return QJsonDocument::fromJson(json).object(); }
};

void TestSchemaValidator::refused_data() {
    const Rows<QString, QString> row("schema", "why");
    row("type", R"({"type":5})", "string");
    row("inner type", R"({"properties":{"a":{"type":5}}})", "string");
    row("properties", R"({"properties":5})", "object");
    row("minimum", R"({"properties":{"a":{"minimum":"x"}}})", "minimum");
    row("length", R"({"minLength":1e300})", "minLength");
    row("enum", R"({"enum":5})", "array");
    row("expression", R"({"properties":{"a":{"pattern":"("}}})", "a: pattern");
    row("far reference", R"({"$ref":"http://far/away"})", "$ref");
    row("circle", R"({"items":{"anyOf":[{"$ref":"#"}]}})", "$ref");
    row("multiple of nothing", R"({"properties":{"a":{"multipleOf":0.0}}})", "a: multipleOf");
    row("unique", R"({"uniqueItems":true})", "uniqueItems");
}

void TestSchemaValidator::refused() {
    FETCH(QString, schema, QString, why);
    const auto made = SchemaValidator::make(object(schema.toUtf8()));
    QVERIFY(!made);
    VERIFY_CONTAINS(made.error().message, why);
}

void TestSchemaValidator::patterns_data() {
    const Rows<QString, QString, bool> row("pattern", "text", "isRight");
    row("right", "^[a-z]{1,3}$", "abc", true);
    row("wrong", "^[a-z]{1,3}$", "abcd", false);
    row("anywhere", "b", "abc", true);
    row("ends with a line feed", "^[a-z]+$", "abc\n", false);
    row("dollar", "^[$]\\$$", "$$", true);
    row("a long text", "^(.|\\n)*$", QString(1000000, 'a'), true);
    // Too much to be decided: whoever applies the value decides.
    row("without end", "^(a+)+$", QString(100, 'a') + 'b', true);
}

void TestSchemaValidator::patterns() {
    FETCH(QString, pattern, QString, text, bool, isRight);
    const auto made = SchemaValidator::make({{"type", "string"}, {"pattern", pattern}});
    QVERIFY(made);
    QCOMPARE(made->check(text).empty(), isRight);
}

void TestSchemaValidator::costIsBounded() {
    const QJsonObject schema = object(R"({"type":"array","items":{"anyOf":[{"minimum":1},{"maximum":-1}]}})");
    QJsonArray values;
    for (int i = 0; i < 1000; ++i)
        values.append(i + 1);
    QVERIFY(isCheapToCheck(schema, values, 100000));
    QVERIFY(!isCheapToCheck(schema, values, 1000));
}

void TestSchemaValidator::anglesBeyondATurn() {
    const QJsonObject schema = object(R"({"properties":{
        "x":{"type":"number","unit":"m"}, "rate":{"type":"number","unit":"rad/s"},
        "pose":{"properties":{"theta":{"type":"number","unit":"rad"}}},
        "turns":{"items":{"type":"number","unit":"rad"}}, "ways":{"items":{"unit":"m"}}}})");
    const QJsonObject fine =
        object(R"({"x":90,"rate":90,"pose":{"theta":-6.28},"turns":[0,6.28],"ways":[90],"other":90})");
    QCOMPARE(beyondTurn(schema, fine), QStringList());
    QVERIFY(holdsBeyondTurn(fine)); // of whatever unit
    QVERIFY(!holdsBeyondTurn(object(R"({"pose":{"theta":6.28},"name":"90"})")));
    const QJsonObject wrong = object(R"({"pose":{"theta":-90},"turns":[0,7]})");
    QVERIFY(holdsBeyondTurn(wrong));
    QCOMPARE(beyondTurn(schema, wrong),
             QStringList({"pose.theta: -90 rad is 14.3 turns; did you mean -1.571 rad (-90 degrees)?",
                          "turns.1: 7 rad is 1.11 turns; did you mean 0.1222 rad (7 degrees)?"}));
    QJsonArray many;
    for (int i = 0; i < 100; ++i)
        many.append(90);
    QCOMPARE(beyondTurn(schema, QJsonObject{{"turns", many}}).size(), 5);
}

void TestSchemaValidator::anglesInDegrees() {
    const QJsonObject schema = object(R"({"properties":{"name":{"type":"string"},
        "pose":{"properties":{"theta":{"type":"number","unit":"rad"}}},
        "turns":{"items":{"type":"number","unit":"rad"}}}})");
    const QJsonObject typed =
        object(R"({"name":"90deg","pose":{"theta":"-90deg"},"turns":["360deg","deg",1,"1e999deg","9degs"]})");
    QVERIFY(holdsAngleText(typed));
    QVERIFY(!holdsAngleText(object(R"({"theta":"90","name":"90 degrees","x":1})")));
    const QJsonValue read = withAnglesRead(schema, typed);
    QCOMPARE(read["name"], QJsonValue("90deg")); // a text
    QCOMPARE(read["pose"]["theta"].toDouble(), -vectorlib::pi / 2);
    QCOMPARE(read["turns"], QJsonValue(QJsonArray{2 * vectorlib::pi, "deg", 1, "1e999deg", "9degs"}));
    const auto turn = SchemaValidator::make(Field::angle("by", "How far").schema());
    QVERIFY(turn && turn->check(read["turns"][0]).empty());
    const QString refusal = toString(turn->check(90));
    QVERIFY2(refusal.endsWith(" in rad: 90 rad is 14.3 turns; did you mean 1.571 rad (90 degrees)?"),
             qPrintable(refusal));
}
