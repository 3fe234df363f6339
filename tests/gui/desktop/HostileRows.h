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

inline QByteArray schemaOf(const QByteArray &value) {
    return "{\"type\":\"object\",\"properties\":{\"a\":" + value + ",\"b\":{\"type\":\"number\"}}}";
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
    for (QByteArray &topic : all.topics)
        topic.replace('\n', ' ').replace("#", word);
    all.results["session.list"] =
        QByteArray(R"([{"name":"r","session":"s","start":#,"end":#,"bytes":#,"daemons":[],"problems":[]}])");
    all.results["session.list"].replace("#", word);
    return all;
}

inline Mischief ofMethod(const char *method, const QByteArray &result) {
    Mischief mischief;
    mischief.results[method] = result;
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

inline Row row(const QString &name) {
    return Row(name);
}

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
        row(QString("every topic is ") + name) << topics;
        row(QString("every result is ") + name) << results;
        row(QString("settings.get is ") + name) << ofMethod("settings.get", json);
        row(QString("daemon.info is ") + name) << ofMethod("daemon.info", json);
        row(QString("the description is ") + name) << ofMethod("rpc.discover", json);
    }
}

inline void addMap() {
    row("pose far away") << ofTopic("pose", R"({"x":1e17,"y":-1e300,"theta":0,"outcome":"matched"})");
    row("pose at the edge") << ofTopic(
        "pose",
        R"({"x":1e6,"y":-1e6,"theta":1e6,"outcome":"<b>m","covariance":[1e12,1e12,0,1e12,1e12,0,0,0,1e12]})");
    row("covariance beyond") << ofTopic(
        "pose", R"({"x":0,"y":0,"theta":0,"covariance":[1e308,1e308,0,1e308,1e308,0,0,0,-1e308]})");
    row("numbers as text") << ofTopic("pose", R"({"x":"NaN","y":"Infinity","theta":"0"})");
    row("odometry far away") << ofTopic(
        "odometry", R"({"pose":{"x":1e300,"y":0,"theta":0},"twist":{"vx":1e300,"vy":-1e300,"omega":1e300}})");
    row("truth jumps about") << ofTopic("truth", R"({"x":%1e5,"y":-%1e5,"theta":0})", 3000);
    row("edges far away") << ofTopic("map",
                                     "{\"revision\":1,\"cleared\":true,\"size\":-5,\"edges\":" +
                                         listOf(R"({"id":%1,"x1":-1e6,"y1":-1e6,"x2":1e6,"y2":1e6})", 2000) +
                                         R"(,"removed":[-1,1e300,"x"]})");
    row("edges beyond") << ofTopic(
        "map",
        R"({"revision":1e300,"edges":[{"id":1e300,"x1":1e300},{"id":2,"x1":1e300,"y1":0,"x2":0,"y2":0},{}]})");
    row("revisions jump") << ofTopic("map", R"({"revision":%1%1,"edges":[]})", 2000);
    row("key scans far away") << ofTopic(
        "graph", "{\"revision\":1,\"cleared\":true,\"first\":0,\"size\":3000,\"poses\":" +
                     listOf("[-1e%1,1e6,1e6]", 3000) + ",\"trust\":" + listOf("-1e%1", 3000) +
                     ",\"loops\":" + listOf(R"({"from":%1,"to":-1,"weight":1e300})", 1000) + '}');
    row("key scans across the window") << ofTopic(
        "graph", "{\"revision\":1,\"cleared\":true,\"first\":0,\"size\":3000,\"poses\":" +
                     listOf("[%1e3,-%1e3,0],[-%1e3,%1e3,0]", 1500) + ",\"trust\":" + listOf("1", 3000) +
                     ",\"loops\":" + listOf(R"({"from":%1,"to":2999,"weight":0})", 2000) + '}');
    row("corrected all the time") << ofTopic(
        "graph",
        R"({"revision":%1,"cleared":true,"first":0,"size":2,"poses":[[%1,0,0],[0,%1,0]],"trust":[1,1],"loops":[]})",
        -1);
    row("graph revisions jump") << ofTopic(
        "graph",
        R"({"revision":%1%1,"cleared":false,"first":%1,"size":1e9,"poses":[],"trust":[],"loops":[]})", 2000);
    row("scan far away") << ofTopic("scan2d", "{\"turn\":-1,\"x\":" + listOf("1e%1", 300) +
                                                  ",\"y\":" + listOf("-1e%1", 300) + ",\"t\":[1e300]}");
    row("large scan") << ofTopic("scan2d", "{\"turn\":-1,\"x\":" + listOf("1", 60000) +
                                               ",\"y\":" + listOf("1", 60000) + '}');
    const auto result = [](const QByteArray &pairs, const QByteArray &segments) {
        return ofTopic("scan", R"({"stamp":1,"pose":{"x":0,"y":0,"theta":0,"outcome":"matched"},)"
                               R"("match":{"reliability":1e300,"ambiguity":-1e300,"pairs":)" +
                                   pairs + R"(},"segments":)" + segments + '}');
    };
    row("segments far away") << result("[]", listOf("[1e%1,0,1e%1,1]", 300));
    row("partners that are not there") << result("[[1,-7],[0,99],[-5,9007199254740992]]", "[[0,0,1,1]]");
    row("partners that are none") << result("[[1e300,-1e300],[0,99],[\"x\"],5]", "[[0,0,1,1]]");
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
        row(QString("setting as ") + schema) << ofMethod("settings.schema", schemaOf(schema));
    row("many settings") << ofMethod(
        "settings.schema",
        "{\"type\":\"object\",\"properties\":" + objectOf("{\"type\":\"number\",\"default\":1}", 7000) + '}');
    row("many choices") << ofMethod("settings.schema",
                                    schemaOf("{\"enum\":" + listOf("\"choice %1\"", 15000) + '}'));
    row("long names") << ofMethod(
        "settings.schema", "{\"type\":\"object\",\"properties\":{\"" + QByteArray(150000, 'W') +
                               "\":{\"type\":\"number\",\"title\":\"" + QByteArray(150000, 'W') + "\"}}}");
    Mischief array = ofMethod("settings.schema",
                              schemaOf(R"({"type":"array","items":{"type":"integer","enum":[1,2,3]}})"));
    array.results["settings.get"] = "{\"a\":" + listOf("%1", 50000) + ",\"b\":1}";
    row("a long array") << array;
    Mischief pattern = ofMethod("settings.schema", schemaOf(R"({"type":"string","pattern":"(.|\\n)*$"})"));
    pattern.results["settings.get"] = "{\"a\":\"" + QByteArray(300000, 'a') + "\"}";
    row("a long text and a pattern") << pattern;
    Mischief alternatives = ofMethod("settings.schema", schemaOf("{\"type\":\"array\",\"items\":{\"anyOf\":" +
                                                                 listOf("{\"minimum\":%1}", 5000) + "}}"));
    alternatives.results["settings.get"] = "{\"a\":" + listOf("-1", 50000) + "}";
    row("many alternatives for many values") << alternatives;
    const QByteArray texts = R"({"type":"array","items":{"type":"string"}})";
    Mischief lists =
        ofMethod("settings.schema", "{\"type\":\"object\",\"properties\":" + objectOf(texts, 100) + '}');
    lists.results["settings.get"] = objectOf(listOf("\"row\"", 90), 100);
    row("many lists of many rows") << lists;
    Mischief objects =
        ofMethod("settings.schema", schemaOf("{\"type\":\"array\",\"items\":{\"type\":\"object\","
                                             "\"properties\":" +
                                             objectOf(texts, 90) + "}}"));
    objects.results["settings.get"] =
        "{\"a\":" + listOf(objectOf("[\"x\",7,{\"y\":[]}]", 60), 90) + ",\"b\":1}";
    row("a list of large objects") << objects;
    QByteArray deep = "{}", given = "1";
    for (int i = 0; i < 40; ++i) {
        deep = R"({"type":"object","required":["a"],"properties":{"a":)" + deep + "}}";
        given = "{\"a\":" + given + '}';
    }
    Mischief nested = ofMethod("settings.schema", deep);
    nested.results["settings.get"] = given;
    row("objects in objects") << nested;
    row("lists change all the time") << [&] {
        Mischief changing = lists;
        changing.topics["settings"] = objectOf("[\"%1\",\"x\"]", 50);
        changing.messages = -1;
        return changing;
    }();
    row("settings change all the time") << ofTopic("settings", R"({"a":%1})", -1);
}

/// All names that a daemon has to give, of so many of these letters.
inline Mischief namesOf(const QByteArray &letters, int count) {
    const QByteArray name = letters.repeated(count), quoted = '"' + name + '"';
    Mischief all;
    all.results["daemon.info"] = "{\"name\":" + quoted + ",\"title\":" + quoted + ",\"host\":" + quoted +
                                 ",\"description_hash\":\"2\"}";
    all.results["daemon.status"] = "{\"state\":" + quoted + R"(,"health":[{"name":)" + quoted +
                                   R"(,"level":"warn","message":)" + quoted + "}]}";
    all.results["rpc.discover"] = R"({"methods":[{"name":)" + quoted + R"(,"summary":)" + quoted +
                                  R"(,"params":[{"name":)" + quoted +
                                  R"(,"schema":{"type":"number"}}]}],"x-topics":[{"name":)" + quoted +
                                  R"(,"description":)" + quoted + "}]}";
    all.results["settings.schema"] = "{\"type\":\"object\",\"properties\":{" + quoted +
                                     R"(:{"type":"number","title":)" + quoted + R"(,"group":)" + quoted +
                                     "}}}";
    all.results["settings.get"] = '{' + quoted + ":1}";
    all.results["session.list"] = R"([{"name":)" + quoted + R"(,"session":)" + quoted +
                                  R"(,"start":1,"bytes":1,"daemons":[)" + quoted + R"(],"problems":[)" +
                                  quoted + "]}]";
    return all;
}

inline void addPanels() {
    row("many methods and topics") << ofMethod(
        "rpc.discover", "{\"methods\":" + listOf("{\"name\":\"m%1\"}", 9000) +
                            ",\"x-topics\":" + listOf("{\"name\":\"t%1\"}", 9000) + '}');
    row("methods without sense") << ofMethod(
        "rpc.discover", R"({"methods":[{"name":"<b>x","summary":"<img src=x>","params":)"
                        R"([5,{"name":7},{"name":"p","schema":{"type":{}}}]},{"name":"<b>x"},{"name":""},7],)"
                        R"("x-topics":[{"name":"a"},{"name":"a"},{}]})");
    row("much health") << ofMethod(
        "daemon.status", "{\"state\":\"" + QByteArray(1000, 'W') + "\",\"health\":" +
                             listOf(R"({"name":"<b>n%1","level":"<i>?","message":"<img src=x>"})", 4000) +
                             '}');
    row("status changes all the time")
        << ofTopic("status", R"({"state":"s%1","health":[{"name":"n","level":"error","message":"%1"}]})", -1);
    row("processes at odd ports") << ofTopic(
        "processes",
        R"({"robot":"<b>r","processes":[{"port":0},{"port":70000},{"port":-1},{"port":"x"},{"port":1e300,"name":5},7,{"port":1,"pid":-1,"cpu":1e300,"memory_bytes":1e300}]})");
    row("many processes") << ofTopic(
        "processes", "{\"robot\":\"" + QByteArray(2000, 'W') +
                         "\",\"processes\":" + listOf("{\"port\":3%1,\"name\":\"p%1\"}", 5000) + '}');
    row("power beyond") << ofTopic(
        "power",
        R"({"controllers":[{"ready":true,"battery_v":1e300,"temperature_c":1e300,"current_a":[1e300,-1e308]}]})");
    row("log without sense") << ofTopic(
        "log", R"({"stamp":1e300,"level":"fatal","source":"<b>","text":"line %1\nforged\u0000\u202e"})", 500);
    row("long log") << ofTopic(
        "log", "{\"stamp\":-1,\"level\":\"error\",\"text\":\"" + QByteArray(100000, 'W') + "\"}", 30);
    row("log all the time") << ofTopic("log", R"({"stamp":%1,"level":"error","text":"%1"})", -1);
    row("sessions without sense") << ofMethod(
        "session.list",
        R"([5,null,{"name":"<b>x","start":1e300,"end":-1e300,"bytes":1e300},{"name":7,"start":"x","bytes":-1}])");
    const QByteArray session = R"("session":"s","start":%1,"bytes":1,"daemons":["<b>"],"problems":["<i>"]})";
    row("many sessions") << ofMethod("session.list", listOf(R"({"name":"r%1",)" + session, 3000));
    row("one session many times") << ofMethod("session.list", listOf(R"({"name":"r",)" + session, 3000));
    const QByteArray counted = R"("counts":{},"losses":{"<b>":1e308,"a":-1},"problem":"<i>"})";
    row("sessions beyond") << ofTopic(
        "session",
        R"({"state":"recording","name":"<b>r","session":"","start":-1e300,"duration_s":1e300,"bytes":1e300,)"
        R"("free_bytes":1e308,"left_s":1e300,"parts":)" +
            listOf(R"({"daemon":"<b>%1","state":"failed","bytes":-1,)" + counted, 500) + R"(,"marks":)" +
            listOf(R"({"t_s":1e300,"text":"<b>%1"})", 500) + R"(,"problems":)" + listOf(R"("<b>%1")", 500) +
            R"(,"silent":)" + listOf(R"("<b>%1")", 500) + '}');
    row("numbers beyond") << ofTopic("free", R"({"a":1e308,"b":-1e308,"c":"NaN","d":%1e300})", 50);
    row("arrays of changing length") << ofTopic("free", R"([%1,[%1],{"a":%1}])", 50);
    row("numbers all the time") << ofTopic("free", R"({"a":%1,"b":-%1})", -1);
    Mischief stamps = ofTopic("free", R"({"a":%1})", 50);
    stamps.stamp = "1e300";
    row("stamps beyond") << stamps;
    stamps.stamp = "nan";
    row("stamps that are none") << stamps;
    stamps.stamp = "-inf";
    row("endless stamps") << stamps;
    stamps.stamp = "0";
    row("stamps of 1970") << stamps;
    stamps.stamp = "4102444800";
    row("stamps of 2100") << stamps;
    row("values that change their type") << [] {
        Mischief changing = ofTopic("free", R"({"a":%1,"b":[%1]})", 10);
        changing.then = {R"({"a":"%1","b":{"c":%1}})",
                         R"({"a":null,"b":%1})",
                         R"({"a":{"d":[true]},"b":[[%1]]})",
                         R"({"a":[%1,"x"],"b":false})",
                         R"([%1])",
                         R"("%1")",
                         "%1"};
        return changing;
    }();
    row("names from right to left") << namesOf(QByteArray("\xe2\x80\xae\xd7\xa9\xd7\x9c\xd7\x95\xd7\x9d"),
                                               10);
    row("names of 10,000 letters") << namesOf("W", 10000);
    row("names of 10,000 letters from right to left") << namesOf("\xd7\xa9", 10000);
    row("numbers that are none") << withoutNumbers("nan");
    row("endless numbers") << withoutNumbers("inf");
    Mischief motors =
        ofMethod("motor.state", R"({"latched":{"<b>":"<i>x","y":5},"control":{"held":true,"holder":7}})");
    motors.isMotors = true;
    row("motors without sense") << motors;
    motors.results["motor.state"] = "{\"latched\":" + objectOf("\"why\"", 10000) +
                                    ",\"control\":{\"held\":true,\"holder\":\"" + QByteArray(5000, 'W') +
                                    "\"}}";
    motors.results["settings.get"] = R"({"vx":1e300,"vy":-1,"omega":"x"})";
    row("motors beyond") << motors;
}

inline void addWire() {
    Mischief twice;
    twice.reply += twice.reply;
    row("replies twice") << twice;
    Mischief other;
    other.reply =
        "{\"jsonrpc\":\"2.0\",\"id\":9%1.5,\"result\":%2}\n{\"jsonrpc\":\"2.0\",\"id\":1e300,\"result\":1}\n";
    row("replies that nobody asked for") << other;
    Mischief error;
    error.reply =
        R"({"jsonrpc":"2.0","id":%1,"error":{"code":1e300,"message":"<b>no","data":{"errors":[{"path":5},7]}}})"
        "\n";
    row("errors only") << error;
    Mischief batch;
    batch.reply = "[" + batch.reply.trimmed() + ",5,[],{\"jsonrpc\":\"2.0\"}]\n";
    row("batches") << batch;
    row("no answer") << ofNoise("\n");
    row("no JSON") << ofNoise("HTTP/1.1 200 OK\r\n\r\n<html>\n\xff\xfe\n");
    row("no JSON-RPC") << ofNoise(
        "5\n[]\n{}\n\"x\"\n{\"jsonrpc\":\"1.0\"}\n{\"jsonrpc\":\"2.0\",\"id\":{}}\n");
    row("closes in a message") << ofNoise("{\"jsonrpc\":\"2.0\",\"id\":1,\"res", false, true);
    row("bytes without end") << ofNoise(QByteArray(4000, 'x'), true);
    row("zeros without end") << ofNoise(QByteArray(4000, '\0'), true);
    row("empty lines without end") << ofNoise(QByteArray(4000, '\n'), true);
    row("errors without end") << ofNoise("x\n", true);
    row("requests without end") << ofNoise("{\"jsonrpc\":\"2.0\",\"id\":1,\"method\":\"daemon.info\"}\n",
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
    row("topics that nobody asked for") << ofNoise(
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
