// Every framing over every carrier, also over one that cuts what it carries into pieces and delays it: a
// daemon and a client say the same to each other.
#include "DaemonFixture.h"
#include "common/client/Client.h"
#include "common/interface/InterfaceRegistry.h"
#include "tests/support/FaultyInterface.h"

using namespace hermes;

namespace {

/// With FOLDER and PORT.
struct Carrier {
    const char *name;
    const char *listen;
    const char *connect;
    int mostBytes; ///< of a frame; a pseudo-terminal holds 4096
};

const Carrier carriers[] = {
    {"tcp", "tcp://127.0.0.1:0", "tcp://127.0.0.1:PORT", 500000},
    {"local", "local://FOLDER/socket", "local://FOLDER/socket", 500000},
    {"udp", "udp://127.0.0.1:0", "udp://127.0.0.1:0?peer=127.0.0.1:PORT", 20000},
    {"serial line", "pty://FOLDER/line", "serial://FOLDER/line?baud=115200", 3000},
};

} // namespace

class TestChannels : public QObject, DaemonFixture {
    Q_OBJECT
private Q_SLOTS:
    void initTestCase() { Log::instance().setStderr(false); }
    void cleanup() { tearDown(); }
    void sayTheSame_data();
    void sayTheSame();
};

void TestChannels::sayTheSame_data() {
    QTest::addColumn<QString>("protocol");
    QTest::addColumn<int>("carrier");
    QTest::addColumn<bool>("faulty");
    for (const QString &protocol : codecNames())
        for (int i = 0; i < int(std::size(carriers)); ++i)
            for (const bool faulty : {false, true})
                QTest::addRow("%s over %s%s", qPrintable(protocol), carriers[i].name,
                              faulty ? ", in pieces" : "")
                    << protocol << i << faulty;
}

void TestChannels::sayTheSame() {
    QFETCH(QString, protocol);
    QFETCH(int, carrier);
    QFETCH(bool, faulty);
    const Carrier &kind = carriers[carrier];
    if (faulty && QString(kind.name) == "udp")
        return; // a datagram comes whole or not at all
    QTemporaryDir folder;
    const auto with = [&protocol](QString url) {
        return url + (url.contains('?') ? '&' : '?') + "protocol=" + protocol;
    };
    daemon = std::make_unique<TestedDaemon>();
    QVERIFY(!daemon->prepare(
        {"tested", "--listen", with(QString(kind.listen).replace("FOLDER", folder.path()))}));
    QVERIFY(daemon->launch());
    const QString url = with(QString(kind.connect)
                                 .replace("FOLDER", folder.path())
                                 .replace("PORT", QString::number(QUrl(address()).port())));
    const auto inner = makeInterface(*InterfaceUrl::parse(url), nullptr);
    QVERIFY(inner);
    Interface *carried = *inner;
    if (faulty)
        carried = new FaultyInterface(carried, {0, 0, 0.7, 3, 7}, nullptr);
    Client client;
    client.connectTo(new Channel(carried, makeCodec(protocol), nullptr));
    QVERIFY(client.waitConnected());

    const auto result = [&client](const QString &method, const QJsonArray &params) {
        const auto answer = client.callAndWait(method, params);
        return answer ? *answer : QJsonValue(answer.error().message);
    };
    for (int i = 0; i < 50; ++i)
        QCOMPARE(result("subtract", {i, 0.5}), QJsonValue(i - 0.5));
    QCOMPARE(result("large", {kind.mostBytes}), QJsonValue(QString(kind.mostBytes, 'x')));
    QVERIFY(client.callAndWait("nothing").error().is(ErrorCode::MethodNotFound));
    QCOMPARE(client.callAndWait("fault").error().data["device"].toString(), QString("t0"));
    QVERIFY(client.callAndWait("subtract", QJsonArray{"\u00e4\n\"", 1}).error().is(ErrorCode::InvalidParams));
    QVERIFY(client.callAndWait("nan").error().is(ErrorCode::InternalError));

    std::vector<int> sizes;
    client.subscribe("numbers", {{"queue", 100}}, [&](const TopicUpdate &update) {
        std::vector<float> numbers(update.data["x"].size());
        QCOMPARE(update.data["x"].numbers(numbers.data()), numbers.size());
        for (size_t i = 0; i < numbers.size(); ++i)
            QCOMPARE(numbers[i], float(i) * 0.1f);
        sizes.push_back(int(numbers.size()));
    });
    QTRY_VERIFY(daemon->hasSubscribers("numbers"));
    const std::vector<int> sent{0, 1, 2, 3, 10, kind.mostBytes / 40};
    for (const int size : sent)
        daemon->publish("numbers", Outgoing::writtenBy([size](WireWriter &out) {
                            std::vector<float> numbers;
                            for (int i = 0; i < size; ++i)
                                numbers.push_back(float(i) * 0.1f);
                            out.beginObject();
                            out.key("x");
                            out.numbers(numbers.data(), numbers.size());
                            out.endObject();
                        }));
    QTRY_COMPARE(sizes, sent);
    QCOMPARE(client.rejected().unreadable, 0);
    QCOMPARE(daemon->server().counters()["malformed_frames"].toInt(), 0);
}

QTEST_GUILESS_MAIN(TestChannels)
#include "TestChannels.moc"
