#include "protocol/jsonrpc/JsonCodec.h"
#include "protocol/wire/JsonText.h"

using namespace hermes;

Q_DECLARE_METATYPE(hermes::Greeting::Speaker)

// Framing and strict parsing.
class TestJsonCodec : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void accepts_data() {
        const Rows<QByteArray, QJsonValue> row("line", "value");
        row("object", "{\"a\":1}", QJsonValue(QJsonObject{{"a", 1}}));
        row("array", " [1,2]", QJsonValue(QJsonArray{1, 2}));
        row("number", "-2.5e3", QJsonValue(-2500));
        row("string", "\"x\"", QJsonValue("x"));
        row("null", "null", QJsonValue());
        row("carriage return", "{\"a\":true}\r", QJsonValue(QJsonObject{{"a", true}}));
        row("same key in two objects", "[{\"a\":1},{\"a\":1}]",
            QJsonValue(QJsonArray{QJsonObject{{"a", 1}}, QJsonObject{{"a", 1}}}));
        row("key as value", "{\"a\":\"a\",\"b\":\"a\"}", QJsonValue(QJsonObject{{"a", "a"}, {"b", "a"}}));
        row("braces in a string", "[\"{\\\"a\\\":[[[\"]", QJsonValue(QJsonArray{"{\"a\":[[["}));
        row("UTF-8", "\"\xc3\xa4\"", QJsonValue(QString::fromUtf8("\xc3\xa4")));
        row("2^53", "9007199254740992", QJsonValue(9007199254740992.0));
    }

    void accepts() {
        FETCH(QByteArray, line, QJsonValue, value);
        JsonCodec codec;
        const auto items = codec.feed(line + '\n');
        QCOMPARE(items.size(), size_t(1));
        QVERIFY2(!items[0].error, items[0].error ? qPrintable(items[0].error->message) : "");
        QCOMPARE(items[0].message, value);
        QCOMPARE(codec.counters().messagesIn, quint64(1));
    }

    void refuses_data() {
        const Rows<QByteArray> row("line");
        row("not JSON", "hello");
        row("cut object", "{\"a\":1");
        row("cut string", "{\"a");
        row("cut escape", "\"\\");
        row("two values", "1 2");
        row("two values, comma", "1,2");
        row("closes the wrapping array", "1],[2");
        row("garbage behind", "{} x");
        row("trailing comma", "{\"a\":1,}");
        row("repeated key", "{\"a\":1,\"b\":{\"a\":2},\"a\":3}");
        row("repeated key, escaped", "{\"a\":1,\"\\u0061\":3}");
        row("overlong UTF-8", "\"\xc0\xaf\"");
        row("lone continuation", "\"\x80\"");
        row("bare byte", "\xff");
        row("NUL", QByteArray("{\"a\":\0}", 7));
        row("NaN", "[NaN]");
        row("number too large", "[1e999]");
        row("control character in a string", "\"a\tb\"");
        row("unknown escape", "\"a\\x\"");
        row("no digit before the point", ".5");
        row("no digit after the point", "[1.]");
        row("nested 101", QByteArray(101, '[') + QByteArray(101, ']'));
        row("nested 100000", QByteArray(100000, '['));
        row("closing only", "]]]]");
    }

    void refuses() {
        QFETCH(QByteArray, line);
        JsonCodec codec;
        const auto items = codec.feed(line + "\n{\"next\":1}\n");
        QCOMPARE(items.size(), size_t(2));
        QVERIFY(items[0].error);
        QVERIFY(items[0].error->is(ErrorCode::ParseError));
        QVERIFY(!items[1].error); // the next line is untouched
        QCOMPARE(codec.counters().malformed, quint64(1));
    }

    void sameMessagesAtEverySplit() {
        const QByteArray stream = "{\"a\":\"\xc3\xa4\"}\r\n\n[1]\nnonsense\n{\"b\":{}}\n";
        for (int cut = 0; cut <= stream.size(); ++cut) {
            JsonCodec codec;
            auto items = codec.feed(stream.left(cut));
            for (const CodecItem &item : codec.feed(stream.mid(cut)))
                items.push_back(item);
            QCOMPARE(items.size(), size_t(4));
            QCOMPARE(items[0].message, QJsonValue(QJsonObject{{"a", QString::fromUtf8("\xc3\xa4")}}));
            QCOMPARE(items[1].message, QJsonValue(QJsonArray{1}));
            QVERIFY(items[2].error);
            QCOMPARE(items[3].message, QJsonValue(QJsonObject{{"b", QJsonObject()}}));
        }
    }

    void oversizedLineIsSkippedOnce() {
        JsonCodec codec;
        codec.setFrameLimit(10);
        auto items = codec.feed("[1,2,3,4,5,6");
        QCOMPARE(items.size(), size_t(1)); // told at once, not at its end
        QVERIFY(items[0].error->is(ErrorCode::OverLimit));
        QVERIFY(codec.feed(",7,8,9,10").empty());
        items = codec.feed(",11]\n[2]\n");
        QCOMPARE(items.size(), size_t(1));
        QCOMPARE(items[0].message, QJsonValue(QJsonArray{2}));
        QCOMPARE(codec.counters().oversized, quint64(1));
    }

    void limitIsExact_data() {
        const Rows<QByteArray, bool> row("line", "fits");
        row("at the limit", "[111,2222]\n", true);
        row("at the limit with CR", "[111,2222]\r\n", true);
        row("one more", "[1111,2222]\n", false);
        row("one more with CR", "[1111,2222]\r\n", false);
    }

    void limitIsExact() {
        FETCH(QByteArray, line, bool, fits);
        JsonCodec codec;
        codec.setFrameLimit(10);
        const auto items = codec.feed(line + "[1]\n");
        QCOMPARE(items.size(), size_t(2));
        QCOMPARE(!items[0].error, fits);
        QVERIFY(!items[1].error);
    }

    void hugeLineIsNotBuffered() {
        JsonCodec codec;
        codec.setFrameLimit(1000);
        int errors = 0;
        for (int i = 0; i < 1000; ++i)
            errors += int(codec.feed(QByteArray(1 << 16, 'x')).size());
        QCOMPARE(errors, 1);
    }

    void emptyLinesAreIgnored() { QVERIFY(JsonCodec().feed("\n\r\n  \n").empty()); }

    void resetForgetsBegunLine() {
        JsonCodec codec;
        codec.feed("{\"a\":");
        codec.reset();
        const auto items = codec.feed("[1]\n");
        QCOMPARE(items.size(), size_t(1));
        QVERIFY(!items[0].error);
    }

    void encodesOneLine() {
        JsonCodec codec;
        const auto frame =
            codec.encode(QJsonObject{{"text", "two\nlines"}, {"list", QJsonArray{1, QJsonObject()}}});
        QVERIFY(!frame.error);
        QCOMPARE(frame.bytes.count('\n'), 1);
        QVERIFY(frame.bytes.endsWith('\n'));
        QCOMPARE(codec.encode(QJsonValue("x")).bytes, QByteArray("\"x\"\n"));
    }

    void notFiniteNumbersAreNamed() {
        JsonCodec codec;
        const QJsonObject data{{"pose", QJsonArray{1, QJsonObject{{"x", std::nan("")}}}}};
        const auto frame = codec.encode(data);
        QVERIFY(frame.error);
        QVERIFY(frame.bytes.isEmpty());
        VERIFY_CONTAINS(frame.error->message, "pose.1.x");
        QVERIFY(codec.encode(QJsonArray{INFINITY}).error);
        QCOMPARE(codec.counters().refused, quint64(2));
    }

    void randomBytesNeverCrash() {
        const uint seed = 20240607;
        QRandomGenerator random(seed);
        JsonCodec codec;
        codec.setFrameLimit(4096);
        const QByteArray alphabet = "{}[]\",:\\u0019eE+-.ntf\n \r\xff\xc3";
        for (int round = 0; round < 2000; ++round) {
            QByteArray bytes;
            for (int i = random.bounded(200); i > 0; --i)
                bytes.append(alphabet[random.bounded(alphabet.size())]);
            codec.feed(bytes);
        }
        codec.feed("\n");
        QCOMPARE(codec.feed("[1]\n").size(), size_t(1));
    }

    void unknownCodecIsNull() {
        QVERIFY(!makeCodec("morse"));
        QVERIFY(makeCodec("json"));
        QCOMPARE(codecNames(), QStringList({"json", "cbor", "serial"}));
        QVERIFY_EXCEPTION_THROWN(addCodec("json", makeCodecOf<JsonCodec>), std::invalid_argument);
        QCOMPARE(codecNames(), QStringList({"json", "cbor", "serial"}));
    }

    void knowsWhoSpeaks_data() {
        using Speaker = Greeting::Speaker;
        const Rows<QByteArray, Greeting::Speaker> row("text", "speaker");
        const QByteArray body = "Host: x\r\n\r\n{\"jsonrpc\":\"2.0\",\"method\":\"a\"}\n";
        row("POST", "POST / HTTP/1.1\r\n" + body, Speaker::Http);
        row("GET of a WebSocket", "GET /chat HTTP/1.1\r\n" + body, Speaker::Http);
        row("OPTIONS", "OPTIONS * HTTP/1.1\r\n" + body, Speaker::Http);
        row("invented method", "x!#$%&'*+-.^_`|~9 / HTTP/1.1\r\n" + body, Speaker::Http);
        row("very long method", QByteArray(70000, 'm') + " / HTTP/1.1\r\n" + body, Speaker::Http);
        row("HTTP/2", "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n" + body, Speaker::Http);
        row("after white space", "\r\n \tPOST / HTTP/1.1\r\n" + body, Speaker::Http);
        row("TLS 1.3", QByteArray("\x16\x03\x01\x02\x00\x01", 6) + body, Speaker::Tls);
        row("message", "{\"jsonrpc\":\"2.0\",\"method\":\"a\"}\n", Speaker::Ours);
        row("batch", "\n [1]\n", Speaker::Ours);
        row("words", "hello world\n", Speaker::Ours);
        row("one word", "hello\nPOST / HTTP/1.1\r\n", Speaker::Ours);
        row("text", "\"POST / HTTP\"\n", Speaker::Ours);
        for (const char *line :
             {"POST  / HTTP/1.1", "POST http://h/ HTTP/1.1", "CONNECT h:1 HTTP/1.1", "POST ?x HTTP/1.1",
              "POST\t/ HTTP/1.1", "\vPOST x HTTP/1.0", "{} x HTTP/1.1", " / HTTP/1.1"})
            row(line, line + QByteArray("\r\n") + body, Speaker::Http);
        row("no version", "say HTTP/1.x\r\n", Speaker::Ours);
        row("a message about HTTP", "{\"a\":\" HTTP/1.1\"}\n", Speaker::Ours);
        row("half of one", "POST ", Speaker::Unknown);
        row("nothing", "", Speaker::Unknown);
        row("length of a frame", QByteArray("\0\0\1", 3), Speaker::Ours);
        row("zeros", QByteArray(10, '\0'), Speaker::Ours);
        row("half of TLS", "\x16 {}\n", Speaker::Ours);
        row("a line that has not ended", "{\"a\":", Speaker::Unknown);
    }

    void knowsWhoSpeaks() {
        FETCH(QByteArray, text, Greeting::Speaker, speaker);
        for (const int piece : {text.size() + 1, 1, 3}) {
            JsonCodec codec;
            codec.watchForStrangers();
            size_t items = 0;
            for (int i = 0; i < text.size(); i += piece)
                items += codec.feed(text.mid(i, piece)).size();
            QCOMPARE(codec.greeting().speaker(), speaker);
            if (codec.greeting().isForeign())
                QCOMPARE(items, size_t(0));
            QCOMPARE(codec.feed("\n[1]\n").empty(), codec.greeting().isForeign());
            codec.reset();
            QCOMPARE(codec.feed("[1]\n").size(), size_t(1));
        }
    }
};
