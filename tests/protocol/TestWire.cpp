// Structs that travel: what a table of fields says is written, read with checks, and described.
#include "protocol/messages/Matching.h"
#include "protocol/messages/Turns.h"
#include "protocol/messages/VectorMap.h"
#include "protocol/wire/Fields.h"
#include "protocol/wire/JsonText.h"
#include "protocol/wire/JsonWriters.h"
#include "protocol/wire/Outgoing.h"

using namespace hermes;

struct Inner {
    double length = 0;
    int count = 7;
};

struct Wheels {
    std::optional<double> left;
    double right = 0;
};

struct Sample {
    QString name;
    bool on = false;
    Inner inner;
    std::vector<Inner> list;
    std::optional<double> height;
    std::optional<QString> note;
    std::optional<std::optional<double>> end;
    Wheels wheels;
    QMap<QString, double> counts;
    QJsonValue open;
    quint8 small = 0;
};

namespace hermes {

const Fields<Inner> &fieldsOf(Of<Inner>) {
    static const auto fields = Fields<Inner>()
                                   .add("length", &Inner::length, "How long", "m")
                                   .range(0, 10)
                                   .add("count", &Inner::count, "How many")
                                   .mayBeMissing();
    return fields;
}

const Fields<Wheels> &fieldsOf(Of<Wheels>) {
    static const auto fields = Fields<Wheels>()
                                   .add("left", &Wheels::left, "Speed of a wheel", "rad/s")
                                   .add("right", &Wheels::right, "Speed of a wheel", "rad/s");
    return fields;
}

const Fields<Sample> &fieldsOf(Of<Sample>) {
    static const auto fields = Fields<Sample>()
                                   .add("name", &Sample::name, "Whose")
                                   .add("on", &Sample::on, "Works")
                                   .add("inner", &Sample::inner, "Part")
                                   .add("list", &Sample::list, "Parts")
                                   .atMostElements(3)
                                   .add("height", &Sample::height, "How high", "m")
                                   .add("note", &Sample::note, "More")
                                   .choices({"dry", "wet"})
                                   .orNull()
                                   .add("end", &Sample::end, "Left out, or not known")
                                   .include(&Sample::wheels)
                                   .add("counts", &Sample::counts, "Of each kind")
                                   .add("open", &Sample::open, "Anything")
                                   .add("small", &Sample::small, "A byte");
    return fields;
}

} // namespace hermes

static QJsonObject sampleJson() {
    return {{"name", "a\"\n\u00e4"},
            {"on", true},
            {"inner", QJsonObject{{"length", 1.5}, {"count", 2}}},
            {"list", QJsonArray{QJsonObject{{"length", 0}, {"count", 1}}}},
            {"note", QJsonValue::Null},
            {"left", 0.1},
            {"right", -1e-9},
            {"counts", QJsonObject{{"bad", 3}}},
            {"open", QJsonArray{1, "x", QJsonValue::Null}},
            {"small", 255}};
}

/// No schema without the names of its members, but those declared open.
static void requireClosed(const QJsonObject &schema, const QString &path) {
    if (schema["x-open"].toBool())
        return;
    const QJsonValue type = schema["type"].isArray() ? schema["type"][0] : schema["type"];
    QVERIFY2(type.isString(), qPrintable(path));
    if (type == "array")
        requireClosed(schema["items"].toObject(), path + "[]");
    if (type != "object")
        return;
    if (schema["additionalProperties"].isObject())
        return requireClosed(schema["additionalProperties"].toObject(), path + ".*");
    QCOMPARE(schema["additionalProperties"], QJsonValue(false));
    const QJsonObject properties = schema["properties"].toObject();
    for (auto property = properties.begin(); property != properties.end(); ++property) {
        QVERIFY2(!property.value()["description"].toString().isEmpty(), qPrintable(path + property.key()));
        requireClosed(property.value().toObject(), path + '.' + property.key());
    }
}

class TestWire : public QObject {
    Q_OBJECT
private Q_SLOTS:
    // Two bytes of a frame may take a hundred of memory.
    void valuesAreLimited() {
        const auto complaint = [](const QByteArray &json) {
            WireError error;
            return WireValue::parse(json, &error) ? QString() : error.message;
        };
        QCOMPARE(complaint('[' + QByteArray("0,").repeated(1999998) + "0]"), QString());
        QCOMPARE(complaint('[' + QByteArray("0,").repeated(1999999) + "0]"),
                 QString("more than 2000000 values"));
        QVERIFY(complaint('[' + QByteArray("{},").repeated(3000000) + "0]").contains("more than"));
        WireError error;
        QVERIFY(!WireValue::parseCbor('\x9f' + QByteArray(3000000, '\xa0') + '\xff', &error));
        QVERIFY(error.message.contains("more than 2000000 values"));
    }

    void goesAroundUnchanged() {
        ReadReport report;
        const auto sample = readMessage<Sample>(WireValue(sampleJson()), report);
        QVERIFY2(sample, qPrintable(report.text()));
        QCOMPARE(report.unknown, quint64(0));
        QCOMPARE(sample->inner.count, 2);
        QVERIFY(!sample->height && !sample->note);
        QCOMPARE(asJson(*sample), QJsonValue(sampleJson()));
        JsonTextWriter writer;
        Outgoing(*sample).write(writer);
        QCOMPARE(*parseJson(writer.bytes(), nullptr), QJsonValue(sampleJson()));
        QVERIFY(!writer.bytes().contains('\n'));
    }

    void namesWhatIsWrong_data() {
        const Rows<QString, QJsonValue, QString> row("member", "value", "text");
        row("missing", "name", QJsonValue::Undefined, "member name: found nothing, expected a text");
        row("number for text", "name", 5, "member name: found 5, expected a text");
        row("text for number", "left", "1", "member left: found text \"1\", expected a number");
        row("null that must not be", "on", QJsonValue::Null, "member on: found null, expected true or false");
        row("no object", "inner", QJsonArray{1}, "member inner: found an array of 1, expected an object");
        row("inside", "inner", QJsonObject{{"length", "x"}},
            "member inner.length: found text \"x\", expected a number from 0 to 10");
        row("out of range", "inner", QJsonObject{{"length", 11}},
            "member inner.length: found 11, expected a number from 0 to 10");
        row("in a list", "list", QJsonArray{QJsonObject{{"length", 1}}, 5}, "member list.1: found 5");
        row("too many", "list", QJsonArray{1, 2, 3, 4},
            "found an array of 4, expected an array of at most 3");
        row("in a map", "counts", QJsonObject{{"bad", "many"}}, "member counts.bad: found text \"many\"");
        row("a fraction", "small", 1.5, "member small: found 1.5, expected a whole number from 0 to 255");
        row("beyond a byte", "small", 256, "member small: found 256, expected a whole number from 0 to 255");
        row("optional of a wrong type", "height", "high", "member height: found text \"high\"");
    }

    void namesWhatIsWrong() {
        FETCH(QString, member, QJsonValue, value, QString, text);
        QJsonObject json = sampleJson();
        value.isUndefined() ? json.remove(member) : void(json[member] = value);
        ReadReport report;
        QVERIFY(!readMessage<Sample>(WireValue(json), report));
        VERIFY_CONTAINS(report.text(), text);
        QVERIFY(!readMessage<Sample>(WireValue(), report = {}));
        QVERIFY(!readMessage<Sample>(WireValue(QJsonValue(5)), report = {}));
    }

    void leavesUnknownAloneAndCounts() {
        QJsonObject json = sampleJson();
        json["new"] = 1;
        json["inner"] = QJsonObject{{"length", 1}, {"colour", "red"}}; // count may be missing
        ReadReport report;
        const auto sample = readMessage<Sample>(WireValue(json), report);
        QVERIFY2(sample, qPrintable(report.text()));
        QCOMPARE(report.unknown, quint64(2));
        QCOMPARE(sample->inner.count, 7);
    }

    void refusesNumbersThatAreNone() {
        ScanMessage scan;
        scan.x = {1, 2, std::numeric_limits<float>::quiet_NaN()};
        JsonTextWriter text;
        Outgoing(scan).write(text);
        QVERIFY(text.hasRefused());
        QCOMPARE(text.refused(), QString("x.2"));
        QVERIFY(asJson(scan).isUndefined());
        MatchMessage match;
        match.ms.vectorize = std::numeric_limits<double>::infinity();
        JsonTextWriter other;
        Outgoing(match).write(other);
        QCOMPARE(other.refused(), QString("ms.vectorize"));
    }

    void floatsAreShortAndExact() {
        std::mt19937 random(1);
        std::uniform_real_distribution<float> length(-100, 100);
        ScanMessage scan;
        for (int i = 0; i < 10000; ++i)
            scan.x.push_back(length(random));
        scan.x.insert(scan.x.end(), {0.1f, -0.0f, 1e-38f, std::numeric_limits<float>::max(),
                                     std::numeric_limits<float>::denorm_min()});
        scan.y = scan.x;
        JsonTextWriter writer;
        Outgoing(scan).write(writer);
        QVERIFY(writer.bytes().contains("[") && writer.bytes().contains("0.1,"));
        WireError error;
        const auto value = WireValue::parse(writer.bytes(), &error);
        QVERIFY2(value, qPrintable(error.message));
        ReadReport report;
        const auto read = readMessage<ScanMessage>(*value, report);
        QVERIFY2(read, qPrintable(report.text()));
        QCOMPARE(read->x, scan.x);
        const auto byJson = readMessage<ScanMessage>(WireValue(asJson(scan)), report);
        QCOMPARE(byJson->x, scan.x);
    }

    void doublesAreExact() {
        std::mt19937_64 random(2);
        for (int i = 0; i < 20000; ++i) {
            const quint64 bits = random();
            double number = 0;
            memcpy(&number, &bits, sizeof number);
            if (!std::isfinite(number))
                continue;
            const QByteArray text = compactJson(QJsonArray{number});
            const auto value = WireValue::parse(text, nullptr);
            QVERIFY2(value, text.constData());
            QCOMPARE((*value)[std::size_t(0)].number(), number);
        }
        for (const auto &[text, number] :
             {std::pair("0e-30", 0.0), std::pair("0.00000000000000000000000e40", 0.0),
              std::pair("-1e-999", 0.0), std::pair("18446744073709551616", 0x1p64)})
            QCOMPARE(WireValue::parse(text, nullptr)->number(), number);
        QVERIFY(!WireValue::parse("1e999", nullptr) && !WireValue::parse("-1000e306", nullptr));
        WireError error;
        for (const char *cut : {"\"\\udc00\"", "{\"a\\udc00\":1}", "\"\\ud800\"", "\"\xe2", "\"\xf0\x9f",
                                "\"\\u00", "[\"a", "tr", "-", "1e"})
            QVERIFY2(!WireValue::parse(cut, &error), cut);
        QVERIFY(!WireValue::parse(QByteArray("{}\0 ", 4), &error));
        QCOMPARE(error.message, QString("a zero byte"));
        QCOMPARE(compactJson(QJsonValue(qint64(9007199254740993))), QByteArray("9007199254740993"));
        QCOMPARE(compactJson(1700000000.25), QByteArray("1700000000.25"));
    }

    void decimalsAreRoundedOnce() {
        std::mt19937_64 random(3);
        QByteArrayList texts{"-0.0", "0.000000000000001", "9.99999999999999", "99999999999999.9",
                             "-123456789012345.6"};
        for (int i = 0; i < 100000; ++i) {
            const int length = 2 + int(random() % 17), point = 1 + int(random() % quint64(length - 1));
            QByteArray text(point == 1 ? "" : QByteArray(1, char('1' + random() % 9)));
            while (text.size() < length)
                text += char('0' + random() % 10);
            texts.append((random() % 2 ? "-" : "") + text.insert(point, '.'));
        }
        for (const QByteArray &text : texts) {
            const auto read = WireValue::parse(text, nullptr);
            QVERIFY2(read, text);
            const double expected = std::strtod(text.constData(), nullptr), found = read->number();
            QVERIFY2(found == expected && std::signbit(found) == std::signbit(expected), text);
        }
    }

    void describesAll() {
        const QJsonObject schema = schemaOf<Sample>();
        requireClosed(schema, "sample");
        for (const QJsonObject &one :
             {schemaOf<ScanMessage>(), schemaOf<CloudMessage>(), schemaOf<OdometryMessage>(),
              schemaOf<TruthMessage>(), schemaOf<MapMessage>(), schemaOf<ScanResult>()})
            requireClosed(one, one["properties"].toObject().keys().join(' '));
        const QJsonValue properties = schema.value("properties");
        const QJsonValue length = schemaOf<Inner>().value("properties")["length"];
        QCOMPARE(length["unit"], QJsonValue("m"));
        QCOMPARE(length["maximum"], QJsonValue(10));
        QCOMPARE(properties["note"]["enum"], QJsonValue(QJsonArray{"dry", "wet", QJsonValue::Null}));
        QCOMPARE(properties["note"]["type"], QJsonValue(QJsonArray{"string", "null"}));
        QVERIFY(schema["required"].toArray().contains("note") &&
                !schema["required"].toArray().contains("height"));
        QCOMPARE(properties["small"]["maximum"], QJsonValue(255));
        QCOMPARE(properties["list"]["maxItems"], QJsonValue(3));
    }

    void hugeNumbersAreNoIntegers() {
        for (const double huge : {1e300, -1e300, 9.3e18}) {
            MapMessage map;
            map.removed = {1};
            QJsonObject json = asJson(map).toObject();
            json["removed"] = QJsonArray{huge};
            ReadReport report;
            QVERIFY(!readMessage<MapMessage>(WireValue(json), report));
            VERIFY_CONTAINS(report.text(), "member removed.0");
        }
    }

    void leftOutIsNotNull() {
        const QJsonValue leftOut = QJsonValue::Undefined;
        for (const QJsonValue &end : {leftOut, QJsonValue(QJsonValue::Null), QJsonValue(1.5)}) {
            QJsonObject json = sampleJson();
            json["end"] = end;
            ReadReport report;
            const auto sample = readMessage<Sample>(WireValue(json), report);
            QVERIFY2(sample, qPrintable(report.text()));
            QCOMPARE(sample->end.has_value(), !end.isUndefined());
            QCOMPARE(asJson(*sample), QJsonValue(json));
        }
        QCOMPARE(schemaOf<Sample>()["properties"].toObject()["end"].toObject()["type"],
                 QJsonValue(QJsonArray{"number", "null"}));
        QVERIFY(!schemaOf<Sample>()["required"].toArray().contains("end"));
    }
};
