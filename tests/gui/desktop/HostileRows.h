#pragma once

#include "tests/gui/desktop/FakeDaemon.h"

namespace hermes {

/// A list of so many elements, in which %1 counts.
inline QByteArray listOf(const QByteArray &element, int count) {
    QByteArray list = "[";
    for (int i = 0; i < count; ++i)
        list += (i == 0 ? "" : ",") + QByteArray(element).replace("%1", QByteArray::number(i));
    return list + ']';
}

/// In CBOR, as long as the largest frame.
inline QByteArray manyEmptyLists() {
    return '\x9f' + QByteArray((320 << 10) - 2, '\x80') + '\xff';
}

/// An object of so many members.
inline QByteArray objectOf(const QByteArray &value, int count) {
    QByteArray object = "{";
    for (int i = 0; i < count; ++i)
        object += (i == 0 ? "\"m" : ",\"m") + QByteArray::number(i) + "\":" + value;
    return object + '}';
}

/// A schema of objects.
inline QByteArray withProperties(const QByteArray &properties) {
    return "{\"type\":\"object\",\"properties\":" + properties + '}';
}

inline QByteArray schemaOf(const QByteArray &value) {
    return withProperties("{\"a\":" + value + ",\"b\":{\"type\":\"number\"}}");
}

inline QByteArray inBrackets(const QByteArray &inner, int depth) {
    return QByteArray(depth, '[') + inner + QByteArray(depth, ']');
}

inline Mischief ofTopic(const char *topic, const QByteArray &data, int messages = 3) {
    Mischief mischief;
    mischief.topics[topic] = data;
    mischief.messages = messages;
    return mischief;
}

/// With this in place of each #, and no line in two.
inline Mischief filled(Mischief mischief, const QByteArray &word) {
    for (auto *const texts : {&mischief.topics, &mischief.results})
        for (QByteArray &text : *texts)
            text.replace('\n', ' ').replace("#", word);
    return mischief;
}

/// Such as only CBOR has, in place of all numbers of what is shown of a robot.
inline Mischief withoutNumbers(const QByteArray &word) {
    Mischief all;
    all.isMotors = true;
    all.topics = {
        {"odometry", R"({"pose":{"x":#,"y":#,"theta":#},"twist":{"vx":#,"vy":#,"omega":#},
            "covariance":[#,#,#,#,#,#,#,#,#],"mono":#})"},
        {"pose", R"({"x":#,"y":#,"theta":#,"outcome":"matched","scan":0,"covariance":[#,#,#,#,#,#,#,#,#]})"},
        {"map", R"({"revision":1,"cleared":true,"size":1,"removed":[],
            "edges":[{"id":1,"x1":#,"y1":#,"x2":#,"y2":#}]})"},
        {"scan2d", R"({"turn":0,"stamp":#,"duration_s":#,"x":[#],"y":[#],"t":[#],"laser":1,"frame":"l"})"},
        {"truth", R"({"stamp":#,"pose":{"x":#,"y":#,"theta":#},"twist":{"vx":#,"vy":#,"omega":#}})"},
        {"power", R"({"controllers":[{"ready":true,"battery_v":#,"temperature_c":#,"current_a":[#,#]}]})"},
        {"log", R"({"stamp":#,"level":"error","source":"a","text":"b"})"},
        {"session", R"({"state":"replaying","name":"r","session":"s","start":#,"duration_s":#,"bytes":#,
            "left_s":#,"parts":[],"marks":[{"t_s":#,"text":"m"}],"problems":[],"silent":[],
            "replay":{"position_s":#,"duration_s":#,"speed":#,"paused":false,"loop":true}})"},
        {"free", R"({"a":#,"b":[#,#]})"}};
    all.results["session.list"] =
        R"([{"name":"r","session":"s","start":#,"end":#,"duration_s":#,"bytes":#,"daemons":[],"problems":[]}])";
    return filled(all, word);
}

inline Mischief ofMethod(const char *method, const QByteArray &result) {
    Mischief mischief;
    mischief.results[method] = result;
    return mischief;
}

/// Settings of this schema that have these values.
inline Mischief ofForm(const QByteArray &schema, const QByteArray &values) {
    Mischief form = ofMethod("settings.schema", schema);
    form.results["settings.get"] = values;
    return form;
}

inline Mischief ofReply(const QByteArray &reply) {
    Mischief mischief;
    mischief.reply = reply;
    return mischief;
}

inline Mischief ofNoise(const QByteArray &noise, bool isEndless = false, bool closes = false) {
    Mischief mischief;
    mischief.noise = noise;
    mischief.isEndless = isEndless;
    mischief.closes = closes;
    return mischief;
}

/// From one that has agreed on CBOR.
inline Mischief ofCbor(const QByteArray &noise, bool isEndless = false) {
    Mischief mischief = ofNoise(noise, isEndless);
    mischief.agrees = true;
    return mischief;
}

/// A row of the long version (HERMES_HOSTILE=1), once in each framing; the short one takes every fourth in
/// CBOR and every eighth in JSON.
class Row {
public:
    explicit Row(const QString &name)
        : name_(name) {}
    void operator<<(Mischief mischief) const {
        static int count = 0;
        const bool isLong = qEnvironmentVariableIntValue("HERMES_HOSTILE");
        if (isLong || count % 4 == 0)
            QTest::newRow(qPrintable(name_)) << mischief;
        mischief.knowsCbor = false;
        if (isLong || count % 8 == 2)
            QTest::newRow(qPrintable(name_ + ", in JSON")) << mischief;
        ++count;
    }

private:
    const QString name_;
};

inline void addNonsenseEverywhere() {
    const QByteArray rich = "\"<img src='file:///dev/zero'><h1>\\u202e\\u0000&amp;\"";
    const std::vector<std::pair<const char *, QByteArray>> nonsense{
        {"null", "null"},
        {"a number", "1e300"},
        {"a text", rich},
        {"a long text", '"' + QByteArray(300000, 'W') + '"'},
        {"a list", "[1,null,\"x\",{},[]]"},
        {"lists in lists", inBrackets("1", 99)},
        {"too deep", inBrackets("1", 5000)},
        {"many numbers", listOf("%1", 50000)},
        {"many zeros", listOf("0", 150000)},
        {"many objects", listOf("{}", 50000)},
        {"many members", objectOf("1", 20000)}};
    for (const auto &[name, json] : nonsense) {
        Mischief topics, results;
        for (const char *const topic :
             {"map", "graph", "pose", "scan", "scan2d", "odometry", "truth", "power", "status", "settings",
              "log", "processes", "free", "cloud", "session"})
            topics.topics[topic] = json;
        for (const char *const method : {"daemon.status", "settings.schema", "session.list", "log.tail",
                                         "topics.subscribe", "fake.call"})
            results.results[method] = json;
        Row(QString("every topic is ") + name) << topics;
        Row(QString("every result is ") + name) << results;
        Row(QString("settings.get is ") + name) << ofMethod("settings.get", json);
        Row(QString("daemon.info is ") + name) << ofMethod("daemon.info", json);
        Row(QString("the description is ") + name) << ofMethod("rpc.discover", json);
    }
}

inline void addMap() {
    Row("pose far away") << ofTopic("pose", R"({"x":1e17,"y":-1e300,"theta":0,"outcome":"matched"})");
    Row("pose at the edge") << ofTopic(
        "pose",
        R"({"x":1e6,"y":-1e6,"theta":1e6,"outcome":"<b>m","covariance":[1e12,1e12,0,1e12,1e12,0,0,0,1e12]})");
    Row("covariance beyond") << ofTopic(
        "pose", R"({"x":0,"y":0,"theta":0,"covariance":[1e308,1e308,0,1e308,1e308,0,0,0,-1e308]})");
    Row("numbers as text") << ofTopic("pose", R"({"x":"NaN","y":"Infinity","theta":"0"})");
    Row("odometry far away") << ofTopic(
        "odometry", R"({"pose":{"x":1e300,"y":0,"theta":0},"twist":{"vx":1e300,"vy":-1e300,"omega":1e300}})");
    Row("truth jumps about") << ofTopic("truth", R"({"x":%1e5,"y":-%1e5,"theta":0})", 3000);
    Row("edges far away") << ofTopic("map",
                                     "{\"revision\":1,\"cleared\":true,\"size\":-5,\"edges\":" +
                                         listOf(R"({"id":%1,"x1":-1e6,"y1":-1e6,"x2":1e6,"y2":1e6})", 2000) +
                                         R"(,"removed":[-1,1e300,"x"]})");
    Row("edges beyond") << ofTopic(
        "map",
        R"({"revision":1e300,"edges":[{"id":1e300,"x1":1e300},{"id":2,"x1":1e300,"y1":0,"x2":0,"y2":0},{}]})");
    Row("revisions jump") << ofTopic("map", R"({"revision":%1%1,"edges":[]})", 2000);
    Row("key scans far away") << ofTopic(
        "graph", "{\"revision\":1,\"cleared\":true,\"first\":0,\"size\":3000,\"poses\":" +
                     listOf("[-1e%1,1e6,1e6]", 3000) + ",\"trust\":" + listOf("-1e%1", 3000) +
                     ",\"loops\":" + listOf(R"({"from":%1,"to":-1,"weight":1e300})", 1000) + '}');
    Row("key scans across the window") << ofTopic(
        "graph", "{\"revision\":1,\"cleared\":true,\"first\":0,\"size\":3000,\"poses\":" +
                     listOf("[%1e3,-%1e3,0],[-%1e3,%1e3,0]", 1500) + ",\"trust\":" + listOf("1", 3000) +
                     ",\"loops\":" + listOf(R"({"from":%1,"to":2999,"weight":0})", 2000) + '}');
    Row("corrected all the time") << ofTopic(
        "graph",
        R"({"revision":%1,"cleared":true,"first":0,"size":2,"poses":[[%1,0,0],[0,%1,0]],"trust":[1,1],"loops":[]})",
        -1);
    Row("graph revisions jump") << ofTopic(
        "graph",
        R"({"revision":%1%1,"cleared":false,"first":%1,"size":1e9,"poses":[],"trust":[],"loops":[]})", 2000);
    Row("scan far away") << ofTopic("scan2d", "{\"turn\":-1,\"x\":" + listOf("1e%1", 300) +
                                                  ",\"y\":" + listOf("-1e%1", 300) + ",\"t\":[1e300]}");
    Row("large scan") << ofTopic("scan2d", "{\"turn\":-1,\"x\":" + listOf("1", 60000) +
                                               ",\"y\":" + listOf("1", 60000) + '}');
    const auto result = [](const QByteArray &pairs, const QByteArray &segments) {
        return ofTopic("scan", R"({"stamp":1,"pose":{"x":0,"y":0,"theta":0,"outcome":"matched"},)"
                               R"("match":{"reliability":1e300,"ambiguity":-1e300,"pairs":)" +
                                   pairs + R"(},"segments":)" + segments + '}');
    };
    Row("segments far away") << result("[]", listOf("[1e%1,0,1e%1,1]", 300));
    Row("partners that are not there") << result("[[1,-7],[0,99],[-5,9007199254740992]]", "[[0,0,1,1]]");
    Row("partners that are none") << result("[[1e300,-1e300],[0,99],[\"x\"],5]", "[[0,0,1,1]]");
}

inline void addForms() {
    for (const char *const schema :
         {R"({"type":5})", R"({"type":["number",7]})", R"({"pattern":"("})", R"({"pattern":"(a+)+$"})",
          R"({"$ref":"http://far/away"})", R"({"$ref":"#/properties/a"})", R"({"multipleOf":0})",
          R"({"multipleOf":0.0,"type":"integer","increment":-1})", R"({"minimum":"x"})", R"({"enum":5})",
          R"({"enum":[]})", R"({"type":"array","uniqueItems":true})", R"({"properties":5})",
          R"({"properties":{"":{"properties":{}}}})", R"({"anyOf":[{"$ref":"#"}]})", R"(5)",
          R"({"minLength":1e300})",
          R"({"title":"<b>&a","description":"<img src=x>","unit":"<i>m","group":"<u>g","type":"number"})"})
        Row(QString("setting as ") + schema) << ofMethod("settings.schema", schemaOf(schema));
    Row("many settings") << ofMethod("settings.schema",
                                     withProperties(objectOf("{\"type\":\"number\",\"default\":1}", 7000)));
    Row("many choices") << ofMethod("settings.schema",
                                    schemaOf("{\"enum\":" + listOf("\"choice %1\"", 15000) + '}'));
    Row("long names") << ofMethod("settings.schema", withProperties("{\"" + QByteArray(150000, 'W') +
                                                                    "\":{\"type\":\"number\",\"title\":\"" +
                                                                    QByteArray(150000, 'W') + "\"}}"));
    Row("a long array") << ofForm(schemaOf(R"({"type":"array","items":{"type":"integer","enum":[1,2,3]}})"),
                                  "{\"a\":" + listOf("%1", 50000) + ",\"b\":1}");
    Row("a long text and a pattern") << ofForm(schemaOf(R"({"type":"string","pattern":"(.|\\n)*$"})"),
                                               "{\"a\":\"" + QByteArray(300000, 'a') + "\"}");
    Row("many alternatives for many values") << ofForm(
        schemaOf("{\"type\":\"array\",\"items\":{\"anyOf\":" + listOf("{\"minimum\":%1}", 5000) + "}}"),
        "{\"a\":" + listOf("-1", 50000) + "}");
    const QByteArray texts = R"({"type":"array","items":{"type":"string"}})";
    const Mischief lists = ofForm(withProperties(objectOf(texts, 100)), objectOf(listOf("\"row\"", 90), 100));
    Row("many lists of many rows") << lists;
    Row("a list of large objects") << ofForm(
        schemaOf("{\"type\":\"array\",\"items\":" + withProperties(objectOf(texts, 90)) + '}'),
        "{\"a\":" + listOf(objectOf("[\"x\",7,{\"y\":[]}]", 60), 90) + ",\"b\":1}");
    QByteArray deep = "{}", given = "1";
    for (int i = 0; i < 40; ++i) {
        deep = R"({"type":"object","required":["a"],"properties":{"a":)" + deep + "}}";
        given = "{\"a\":" + given + '}';
    }
    Row("objects in objects") << ofForm(deep, given);
    Mischief changing = lists;
    changing.topics["settings"] = objectOf("[\"%1\",\"x\"]", 50);
    changing.messages = -1;
    Row("lists change all the time") << changing;
    Row("settings change all the time") << ofTopic("settings", R"({"a":%1})", -1);
}

/// All names that a daemon has to give, of so many of these letters.
inline Mischief namesOf(const QByteArray &letters, int count) {
    Mischief all;
    all.results = {
        {"daemon.info", R"({"name":#,"title":#,"host":#,"description_hash":"2"})"},
        {"daemon.status", R"({"state":#,"health":[{"name":#,"level":"warn","message":#}]})"},
        {"rpc.discover",
         R"({"methods":[{"name":#,"summary":#,"params":[{"name":#,"schema":{"type":"number"}}]}],
            "x-topics":[{"name":#,"description":#}]})"},
        {"settings.schema", R"({"type":"object","properties":{#:{"type":"number","title":#,"group":#}}})"},
        {"settings.get", "{#:1}"},
        {"session.list", R"([{"name":#,"session":#,"start":1,"bytes":1,"daemons":[#],"problems":[#]}])"}};
    return filled(all, '"' + letters.repeated(count) + '"');
}

inline void addPanels() {
    Row("many methods and topics") << ofMethod(
        "rpc.discover", "{\"methods\":" + listOf("{\"name\":\"m%1\"}", 9000) +
                            ",\"x-topics\":" + listOf("{\"name\":\"t%1\"}", 9000) + '}');
    Row("methods without sense") << ofMethod(
        "rpc.discover", R"({"methods":[{"name":"<b>x","summary":"<img src=x>","params":)"
                        R"([5,{"name":7},{"name":"p","schema":{"type":{}}}]},{"name":"<b>x"},{"name":""},7],)"
                        R"("x-topics":[{"name":"a"},{"name":"a"},{}]})");
    Row("much health") << ofMethod(
        "daemon.status", "{\"state\":\"" + QByteArray(1000, 'W') + "\",\"health\":" +
                             listOf(R"({"name":"<b>n%1","level":"<i>?","message":"<img src=x>"})", 4000) +
                             '}');
    Row("status changes all the time")
        << ofTopic("status", R"({"state":"s%1","health":[{"name":"n","level":"error","message":"%1"}]})", -1);
    Row("processes at odd ports") << ofTopic(
        "processes",
        R"({"robot":"<b>r","processes":[{"port":0},{"port":70000},{"port":-1},{"port":"x"},{"port":1e300,"name":5},7,{"port":1,"pid":-1,"cpu":1e300,"memory_bytes":1e300}]})");
    Row("many processes") << ofTopic(
        "processes", "{\"robot\":\"" + QByteArray(2000, 'W') +
                         "\",\"processes\":" + listOf("{\"port\":3%1,\"name\":\"p%1\"}", 5000) + '}');
    Row("power beyond") << ofTopic(
        "power",
        R"({"controllers":[{"ready":true,"battery_v":1e300,"temperature_c":1e300,"current_a":[1e300,-1e308]}]})");
    Row("log without sense") << ofTopic(
        "log", R"({"stamp":1e300,"level":"fatal","source":"<b>","text":"line %1\nforged\u0000\u202e"})", 500);
    Row("long log") << ofTopic(
        "log", "{\"stamp\":-1,\"level\":\"error\",\"text\":\"" + QByteArray(100000, 'W') + "\"}", 30);
    Row("log all the time") << ofTopic("log", R"({"stamp":%1,"level":"error","text":"%1"})", -1);
    Row("sessions without sense") << ofMethod(
        "session.list",
        R"([5,null,{"name":"<b>x","start":1e300,"end":-1e300,"duration_s":-1e300,"bytes":1e300},{"name":7,"start":"x","bytes":-1}])");
    const QByteArray session = R"("session":"s","start":%1,"bytes":1,"daemons":["<b>"],"problems":["<i>"]})";
    Row("many sessions") << ofMethod("session.list", listOf(R"({"name":"r%1",)" + session, 3000));
    Row("one session many times") << ofMethod("session.list", listOf(R"({"name":"r",)" + session, 3000));
    const QByteArray counted = R"("counts":{},"losses":{"<b>":1e308,"a":-1},"problem":"<i>"})";
    Row("sessions beyond") << ofTopic(
        "session",
        R"({"state":"recording","name":"<b>r","session":"","start":-1e300,"duration_s":1e300,"bytes":1e300,)"
        R"("free_bytes":1e308,"left_s":1e300,"parts":)" +
            listOf(R"({"daemon":"<b>%1","state":"failed","bytes":-1,)" + counted, 500) + R"(,"marks":)" +
            listOf(R"({"t_s":1e300,"text":"<b>%1"})", 500) + R"(,"problems":)" + listOf(R"("<b>%1")", 500) +
            R"(,"silent":)" + listOf(R"("<b>%1")", 500) + '}');
    Row("numbers beyond") << ofTopic("free", R"({"a":1e308,"b":-1e308,"c":"NaN","d":%1e300})", 50);
    Row("arrays of changing length") << ofTopic("free", R"([%1,[%1],{"a":%1}])", 50);
    Row("numbers all the time") << ofTopic("free", R"({"a":%1,"b":-%1})", -1);
    Mischief stamps = ofTopic("free", R"({"a":%1})", 50);
    for (const auto &[name, stamp] : {std::pair("stamps beyond", "1e300"),
                                      {"stamps that are none", "nan"},
                                      {"endless stamps", "-inf"},
                                      {"stamps of 1970", "0"},
                                      {"stamps of 2100", "4102444800"}}) {
        stamps.stamp = stamp;
        Row(name) << stamps;
    }
    Mischief changing = ofTopic("free", R"({"a":%1,"b":[%1]})", 10);
    changing.then = {R"({"a":"%1","b":{"c":%1}})",
                     R"({"a":null,"b":%1})",
                     R"({"a":{"d":[true]},"b":[[%1]]})",
                     R"({"a":[%1,"x"],"b":false})",
                     R"([%1])",
                     R"("%1")",
                     "%1"};
    Row("values that change their type") << changing;
    Row("names from right to left") << namesOf("\xe2\x80\xae\xd7\xa9\xd7\x9c\xd7\x95\xd7\x9d", 10);
    Row("names of 10,000 letters") << namesOf("W", 10000);
    Row("names of 10,000 letters from right to left") << namesOf("\xd7\xa9", 10000);
    Row("numbers that are none") << withoutNumbers("nan");
    Row("endless numbers") << withoutNumbers("inf");
    Mischief motors =
        ofMethod("motor.state", R"({"latched":{"<b>":"<i>x","y":5},"control":{"held":true,"holder":7}})");
    motors.isMotors = true;
    Row("motors without sense") << motors;
    motors.results["motor.state"] = R"({"latched":)" + objectOf("\"why\"", 10000) +
                                    R"(,"control":{"held":true,"holder":")" + QByteArray(5000, 'W') + "\"}}";
    motors.results["settings.get"] = R"({"vx":1e300,"vy":-1,"omega":"x"})";
    Row("motors beyond") << motors;
}

inline void addWire() {
    const QByteArray good = Mischief().reply;
    Row("replies twice") << ofReply(good + good);
    Row("replies that nobody asked for") << ofReply("{\"jsonrpc\":\"2.0\",\"id\":9%1.5,\"result\":%2}\n{"
                                                    "\"jsonrpc\":\"2.0\",\"id\":1e300,\"result\":1}\n");
    Row("errors only") << ofReply(
        R"({"jsonrpc":"2.0","id":%1,"error":{"code":1e300,"message":"<b>no","data":{"errors":[{"path":5},7]}}})"
        "\n");
    Row("batches") << ofReply("[" + good.trimmed() + ",5,[],{\"jsonrpc\":\"2.0\"}]\n");
    Row("no answer") << ofNoise("\n");
    Row("no JSON") << ofNoise("HTTP/1.1 200 OK\r\n\r\n<html>\n\xff\xfe\n");
    Row("no JSON-RPC") << ofNoise(
        "5\n[]\n{}\n\"x\"\n{\"jsonrpc\":\"1.0\"}\n{\"jsonrpc\":\"2.0\",\"id\":{}}\n");
    Row("closes in a message") << ofNoise("{\"jsonrpc\":\"2.0\",\"id\":1,\"res", false, true);
    Row("bytes without end") << ofNoise(QByteArray(4000, 'x'), true);
    Row("zeros without end") << ofNoise(QByteArray(4000, '\0'), true);
    Row("empty lines without end") << ofNoise(QByteArray(4000, '\n'), true);
    Row("errors without end") << ofNoise("x\n", true);
    Row("requests without end") << ofNoise("{\"jsonrpc\":\"2.0\",\"id\":1,\"method\":\"daemon.info\"}\n",
                                           true);
    QTest::newRow("lines after the agreement")
        << ofCbor("{\"jsonrpc\":\"2.0\",\"id\":1,\"result\":1}\n", true);
    QTest::newRow("a frame of 4 GB") << ofCbor(QByteArray(4000, '\xff'), true);
    QTest::newRow("frames of nothing") << ofCbor(QByteArray(4000, '\0'), true);
    QTest::newRow("the largest frames, of empty lists")
        << ofCbor(QByteArray::fromHex("00050000") + manyEmptyLists(), true);
    QTest::newRow("lists without end")
        << ofCbor(QByteArray::fromHex("00001000") + QByteArray(0x1000, '\x9f'), true);
    QTest::newRow("texts, arrays and lists longer than all")
        << ofCbor(QByteArray::fromHex("00000006 7a7fffffff61"
                                      "0000000c d8557b7fffffffffffffff61"
                                      "0000000b d8555b7fffffffffffffff"
                                      "00000009 9b7fffffffffffffff"
                                      "00000009 bbffffffffffffffff")
                      .replace(' ', ""),
                  true);
    Row("topics that nobody asked for") << ofNoise(
        "{\"jsonrpc\":\"2.0\",\"method\":\"topic\",\"params\":{\"subscription\":0,\"data\":1}}\n", true);
}

/// What no daemon should say, a row of the column "mischief" each.
inline void addHostileRows() {
    QTest::addColumn<Mischief>("mischief");
    addNonsenseEverywhere();
    addMap();
    addForms();
    addPanels();
    addWire();
}

} // namespace hermes
