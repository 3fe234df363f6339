// The framing cbor: its frames, the items of RFC 8949 and RFC 8746 that it takes, what it refuses.
#include "protocol/jsonrpc/CborCodec.h"
#include "protocol/jsonrpc/JsonCodec.h"
#include "protocol/messages/Turns.h"
#include "protocol/wire/Fields.h"

#include <QCborValue>

using namespace hermes;

class TestCborCodec : public QObject {
    Q_OBJECT

    static QByteArray framed(const QByteArray &item) {
        QByteArray bytes(4, '\0');
        qToBigEndian(quint32(item.size()), bytes.data());
        return bytes + item;
    }

    static QByteArray hex(const char *digits) { return QByteArray::fromHex(digits); }

    static ScanMessage scan(int points) {
        ScanMessage message;
        message.header.stamp = 1.7e9;
        message.header.frame = "sensor";
        message.t.emplace();
        for (int i = 0; i < points; ++i) {
            message.x.push_back(float(i) * 0.1f);
            message.y.push_back(-1 / float(i + 1));
            message.t->push_back(1e-30f * float(i));
            message.intensity.push_back(quint8(i));
        }
        return message;
    }

private Q_SLOTS:
    void reads_data() {
        Rows<QByteArray, QJsonValue>("item", "value");
        const auto row = [](const char *digits, const QJsonValue &value) {
            QTest::newRow(digits) << hex(digits) << value;
        };
        // RFC 8949, appendix A, without what JSON cannot hold.
        row("00", 0);
        row("17", 23);
        row("1818", 24);
        row("1903e8", 1000);
        row("1b000000e8d4a51000", 1000000000000.0);
        row("1bffffffffffffffff", 18446744073709551615.0);
        row("3bffffffffffffffff", -18446744073709551616.0);
        row("20", -1);
        row("3903e7", -1000);
        row("3b7fffffffffffffff", -9223372036854775808.0);
        row("f90000", 0.0);
        row("f93c00", 1.0);
        row("fb3ff199999999999a", 1.1);
        row("f97bff", 65504.0);
        row("fa47c35000", 100000.0);
        row("fb7e37e43c8800759c", 1.0e+300);
        row("f90001", 5.960464477539063e-8);
        row("f4", false);
        row("f5", true);
        row("f6", QJsonValue());
        row("60", "");
        row("6449455446", "IETF");
        row("62225c", "\"\\");
        row("62c3bc", QString::fromUtf8("\u00fc"));
        row("64f0908591", QString::fromUtf8("\xf0\x90\x85\x91"));
        row("80", QJsonArray());
        row("8301820203820405", QJsonArray{1, QJsonArray{2, 3}, QJsonArray{4, 5}});
        row("a0", QJsonObject());
        row("a26161016162820203", QJsonObject{{"a", 1}, {"b", QJsonArray{2, 3}}});
        row("7f657374726561646d696e67ff", "streaming");
        row("9fff", QJsonArray());
        row("9f018202039f0405ffff", QJsonArray{1, QJsonArray{2, 3}, QJsonArray{4, 5}});
        row("bf61610161629f0203ffff", QJsonObject{{"a", 1}, {"b", QJsonArray{2, 3}}});
        row("d9d9f783010203", QJsonArray{1, 2, 3}); // says of itself that it is CBOR
        row("d855820102", QJsonArray{1, 2});        // a tag that means nothing here
        row("c11a514b67b0", 1363896240);            // a time
    }

    void reads() {
        FETCH(QByteArray, item, QJsonValue, value);
        CborCodec codec;
        const auto items = codec.feed(framed(item));
        QCOMPARE(items.size(), size_t(1));
        QVERIFY2(!items[0].error, items[0].error ? qPrintable(items[0].error->message) : "");
        QCOMPARE(items[0].message, value);
        // And back.
        const auto again = codec.feed(codec.encode(value).bytes);
        QCOMPARE(again.at(0).message, value);
    }

    void refuses_data() {
        const Rows<QByteArray, QString> row("item", "why");
        row("nothing", "", "");
        row("cut off number", hex("1903"), "");
        row("cut off text", hex("6449"), "4 bytes of text expected, there are 2");
        row("text of 2^63 bytes", hex("7b800000000000000061"), "");
        row("text of 2 GB", hex("7a7fffffff61"), "bytes of text expected");
        row("array of 2^32", hex("9b000000010000000001"), "");
        row("array without end", hex("9f01"), "");
        row("map without a value", hex("bf6161ff"), "");
        row("half a map", hex("a16161"), "");
        row("key twice", hex("a2616101616102"), "occurs twice");
        row("number as a key", hex("a10102"), "a key that is no text");
        row("bytes", hex("4401020304"), "bytes, expected a typed array");
        row("half a float", hex("d8554501020304ff"), "multiple of 4");
        row("typed array of 2^40 bytes", hex("d8555b0000010000000000"),
            sizeof(std::size_t) < 8 ? "too large" : "more than there are"); // the first is said by Qt
        row("floats of 16 bytes", hex("d85750000102030405060708090a0b0c0d0e0f"),
            "bytes, expected a typed array");
        row("floats that are not finite", hex("d855480000c03f0000c07f"), "not finite");
        row("doubles, the same", hex("d852487ff0000000000000"), "not finite");
        row("infinity", hex("f97c00"), "not finite");
        row("not a number", hex("fb7ff8000000000000"), "not finite");
        row("undefined", hex("f7"), "JSON does not have");
        row("simple value", hex("f0"), "JSON does not have");
        row("wrong UTF-8", hex("61ff"), "");
        row("half of a surrogate pair", hex("63eda080"), "");
        row("bytes after it", hex("0000"), "bytes after the value");
        row("break", hex("ff"), "");
        row("reserved", hex("1c"), "");
        row("a long array that is broken after a text", hex("9a20ffff7f6161ff"), "");
        row("a long map, the same", hex("ba20ffff7f61616161ff"), "");
        row("deep", QByteArray(200, char(0x81)) + '\0', "nested deeper than 100 levels");
        row("deep without lengths", QByteArray(200, char(0x9f)), "nested deeper than 100 levels");
        row("deep in maps", hex("a16161").repeated(200) + '\0', "nested deeper than 100 levels");
        row("only tags", QByteArray(1000, char(0xc1)), "");
        row("JSON", "{\"a\":1}", "");
    }

    void refuses() {
        FETCH(QByteArray, item, QString, why);
        CborCodec codec;
        const auto items = codec.feed(framed(item) + framed("\x80"));
        QCOMPARE(items.size(), size_t(2)); // in step again at once
        QVERIFY(items[0].error && items[0].error->is(ErrorCode::ParseError));
        VERIFY_CONTAINS(items[0].error->message, why);
        QCOMPARE(items[1].message, QJsonValue(QJsonArray()));
        QCOMPARE(codec.counters().malformed, quint64(1));
    }

    void readsTypedArrays_data() {
        Rows<QByteArray, QJsonArray>("item", "values");
        const auto row = [](const char *name, const char *digits, const QJsonArray &values) {
            QTest::newRow(name) << hex(digits) << values;
        };
        row("uint8", "d840430001ff", {0, 1, 255});
        row("uint8 clamped", "d8444200ff", {0, 255});
        row("uint16 big", "d841440001ff00", {1, 65280});
        row("uint16 little", "d8454401000 0ff", {1, 65280});
        row("uint32 big", "d84244ffffffff", {4294967295.0});
        row("uint32 little", "d8464400000080", {2147483648.0});
        row("uint64 big", "d843480000000000000005", {5});
        row("uint64 little", "d847480500000000000000", {5});
        row("sint8", "d84842ff7f", {-1, 127});
        row("sint16 big", "d84942fffe", {-2});
        row("sint16 little", "d84d42feff", {-2});
        row("sint32 big", "d84a44fffffffe", {-2});
        row("sint32 little", "d84e44feffffff", {-2});
        row("sint64 big", "d84b48fffffffffffffffe", {-2});
        row("sint64 little", "d84f48feffffffffffffff", {-2});
        row("float big", "d851483fc00000c0000000", {1.5, -2});
        row("float little", "d855480000c03f000000c0", {1.5, -2});
        row("double big", "d852483ff8000000000000", {1.5});
        row("double little", "d85648000000000000f83f", {1.5});
        row("empty", "d85540", {});
        row("in chunks", "d8555f4300 00c0413f44000000c0ff", {1.5, -2});
        row("tagged twice", "d9d9f7d8554400 00c03f", {1.5});
    }

    void readsTypedArrays() {
        FETCH(QByteArray, item, QJsonArray, values);
        CborCodec codec;
        const auto items = codec.feed(framed(item));
        QVERIFY2(!items[0].error, items[0].error ? qPrintable(items[0].error->message) : "");
        QCOMPARE(items[0].message.toArray(), values);
        WireError error;
        const auto view = WireValue::parseCbor(item, &error);
        QCOMPARE(view->kind(), WireView::Kind::Array);
        QCOMPARE(view->size(), size_t(values.size()));
        QCOMPARE(view->described(), QString("an array of %1").arg(values.size()));
        QCOMPARE((*view)["x"].kind(), WireView::Kind::Undefined);
        QCOMPARE((*view)[std::size_t(values.size())].kind(), WireView::Kind::Undefined);
        std::vector<double> numbers(size_t(values.size()));
        QCOMPARE(view->numbers(numbers.data()), numbers.size());
        for (int i = 0; i < values.size(); ++i) {
            QCOMPARE(numbers[size_t(i)], values[i].toDouble());
            QCOMPARE((*view)[size_t(i)].kind(), WireView::Kind::Number);
            QCOMPARE((*view)[size_t(i)].number(), values[i].toDouble());
            QCOMPARE((*view)[size_t(i)].toJson(), values[i]);
            QCOMPARE((*view)[size_t(i)].integer().has_value(), values[i].toDouble() != 1.5);
            QCOMPARE((*view)[size_t(i)].size(), size_t(0));
        }
    }

    // What is packed is read with the same limits, and told by the same path.
    void numbersOfMessagesAreChecked() {
        CborCodec codec;
        const auto problem = [&codec](const QJsonObject &changes, const QByteArray &from = {},
                                      const QByteArray &to = {}) {
            QJsonObject data = asJson(scan(3)).toObject();
            for (auto member = changes.begin(); member != changes.end(); ++member)
                data.insert(member.key(), member.value());
            QByteArray bytes = codec.encode(from.isEmpty() ? Outgoing(data) : Outgoing(scan(3))).bytes;
            bytes.replace(from, to);
            WireError error;
            const auto value = WireValue::parseCbor(bytes.mid(4), &error);
            ReadReport report;
            if (!value)
                return error.message;
            return readMessage<ScanMessage>(*value, report) ? QString() : report.text();
        };
        QCOMPARE(problem({}), QString());
        QCOMPARE(problem({}, "\x01", "\x01"), QString());
        QVERIFY(problem({{"intensity", QJsonArray{0, 256, 1}}}).contains("intensity.1"));
        const float bad = std::numeric_limits<float>::quiet_NaN(), good = scan(3).x[1];
        const QByteArray badBytes(reinterpret_cast<const char *>(&bad), 4),
            goodBytes(reinterpret_cast<const char *>(&good), 4);
        const QString text = problem({}, goodBytes, badBytes);
        VERIFY_CONTAINS(text, "not finite");
        // Shorts where bytes are expected: those that fit.
        std::vector<quint8> bytes(3);
        WireError error;
        const auto shorts = WireValue::parseCbor(hex("d84546ff0000010200"), &error); // 255, 256, 2
        QCOMPARE(shorts->numbers(bytes.data()), size_t(1));
        QCOMPARE(bytes[0], quint8(255));
    }

    void sameMessagesAtEverySplit() {
        CborCodec codec;
        const QByteArray bytes = codec.encode(QJsonObject{{"a", 1}}).bytes + framed("") +
                                 codec.encode(scan(20)).bytes + framed("\xff");
        CborCodec whole;
        const auto expected = whole.feed(bytes);
        QCOMPARE(expected.size(), size_t(4));
        for (int piece = 1; piece < bytes.size(); piece += 1 + piece / 8) {
            CborCodec split;
            std::vector<CodecItem> items;
            for (int i = 0; i < bytes.size(); i += piece)
                for (const CodecItem &item : split.feed(bytes.mid(i, piece)))
                    items.push_back(item);
            QCOMPARE(items.size(), expected.size());
            for (size_t i = 0; i < items.size(); ++i)
                QCOMPARE(items[i].message, expected[i].message);
            QVERIFY(!split.isMidFrame());
        }
        codec.feed("\0\0\0\5ab");
        QVERIFY(!codec.isMidFrame()); // the literal ends at its first zero
        codec.feed(QByteArray("\0\0\0\5ab", 6));
        QVERIFY(codec.isMidFrame());
        codec.reset();
        QVERIFY(!codec.isMidFrame());
    }

    void oversizedFrameIsSkipped() {
        CborCodec codec;
        codec.setFrameLimit(1000);
        const QByteArray exact = framed(codec.encode(QString(995, 'x')).bytes.mid(4));
        QCOMPARE(exact.size(), 4 + 998);
        QCOMPARE(codec.feed(exact).at(0).message, QJsonValue(QString(995, 'x')));
        const auto items = codec.feed(framed(QByteArray(1001, '\0')) + framed(hex("01")));
        QCOMPARE(items.size(), size_t(2));
        QVERIFY(items[0].error->is(ErrorCode::OverLimit));
        QCOMPARE(items[1].message, QJsonValue(1));
        // 4 GB are refused at once, and not waited for in memory.
        QCOMPARE(codec.feed("\xff\xff\xff\xff").size(), size_t(1));
        for (int i = 0; i < 100; ++i)
            QVERIFY(codec.feed(QByteArray(1 << 16, 'x')).empty());
        QVERIFY(codec.isMidFrame());
    }

    void everyOtherDecoderReadsIt() {
        CborCodec codec;
        const QByteArray bytes = codec.encode(scan(5)).bytes;
        QCborParserError error;
        const QCborMap map = QCborValue::fromCbor(bytes.mid(4), &error).toMap();
        QCOMPARE(error.error, QCborError(QCborError{QCborError::NoError}));
        QCOMPARE(map[QLatin1String("frame")].toString(), QString("sensor"));
        QCOMPARE(quint64(map[QLatin1String("x")].tag()), quint64(85)); // floats, the lowest byte first
        QCOMPARE(map[QLatin1String("x")].taggedValue().toByteArray().size(), 20);
        QCOMPARE(quint64(map[QLatin1String("intensity")].tag()), quint64(64));
        QCOMPARE(map[QLatin1String("intensity")].taggedValue().toByteArray(), hex("0001020304"));
    }

    void notFiniteNumbersAreNamed() {
        CborCodec codec;
        ScanMessage message = scan(5);
        message.y[3] = std::numeric_limits<float>::infinity();
        const EncodedFrame frame = codec.encode(message);
        QVERIFY(frame.error && frame.error->message.contains("y.3"));
        QCOMPARE(codec.counters().refused, quint64(1));
    }

    void batchesAreOneFrame() {
        CborCodec codec;
        for (int count : {1, 2, 100}) {
            std::vector<QByteArray> frames;
            QJsonArray expected;
            for (int i = 0; i < count; ++i) {
                expected.append(QJsonObject{{"id", i}});
                frames.push_back(codec.encode(expected.last()).bytes);
            }
            codec.joinBatch(frames);
            QByteArray all;
            for (const QByteArray &piece : frames)
                all += piece;
            const auto items = codec.feed(all);
            QCOMPARE(items.size(), size_t(1));
            QCOMPARE(items[0].message, QJsonValue(expected));
        }
    }

    void subscriptionsAreAdded() {
        CborCodec codec;
        const QByteArray frame = codec.encodeTopic("scan2d", 7, 1.5, scan(4)).bytes;
        const auto items = codec.feed(codec.forSubscription(frame, 3, quint64(1) << 40));
        QCOMPARE(items.size(), size_t(1));
        const QJsonValue params = items[0].message["params"];
        QCOMPARE(params["subscription"].toInt(), 3);
        QCOMPARE(params["dropped"].toDouble(), 1099511627776.0);
        QCOMPARE(params["seq"].toInt(), 7);
        QCOMPARE(params["topic"].toString(), QString("scan2d"));
        ReadReport report;
        const auto read = readMessage<ScanMessage>(items[0].data, report);
        QVERIFY2(read, qPrintable(report.text()));
        QVERIFY(read->x == scan(4).x && *read->t == *scan(4).t && read->intensity == scan(4).intensity);
        // As by the other framing, but for the digits of floats.
        JsonCodec json;
        const auto same =
            json.feed(json.forSubscription(json.encodeTopic("scan2d", 7, 1.5, scan(4)).bytes, 3, 0));
        QCOMPARE(same[0].data["stamp"].number(), items[0].data["stamp"].number());
        QCOMPARE(float(same[0].data["y"][2].number()), float(items[0].data["y"][2].number()));
    }

    void damagedBytesNeverCrash() {
        CborCodec codec;
        const QByteArray whole = codec.encodeTopic("scan2d", 7, 1.5, scan(30)).bytes;
        QRandomGenerator random(1);
        for (int round = 0; round < 20000; ++round) {
            QByteArray bytes = whole.mid(4);
            for (auto i = random.bounded(4) + 1; i > 0; --i)
                bytes[random.bounded(bytes.size())] = char(random.bounded(256));
            const auto items = codec.feed(
                framed(bytes.left(random.bounded(2) ? bytes.size() : random.bounded(bytes.size()))));
            QCOMPARE(items.size(), size_t(1));
            if (!items[0].error) {
                ReadReport report;
                readMessage<ScanMessage>(items[0].data, report);
                codec.encode(items[0].message);
            }
        }
    }
};
