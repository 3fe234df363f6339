// A client that repeats its requests since frames may be lost: each is carried out once, its reply is sent as
// often as it is asked for.
#include "DaemonFixture.h"
#include "common/daemon/ReplyCache.h"
#include "protocol/jsonrpc/SerialCodec.h"
#include "tests/support/LoopbackInterface.h"

using namespace hermes;

class TestReplyCache : public QObject {
    Q_OBJECT

    /// Speaks the framing serial, frame by frame.
    class FrameClient {
    public:
        explicit FrameClient(const QString &address) {
            const QUrl url(address);
            socket.connectToHost(url.host(), quint16(url.port()));
        }
        void send(const QJsonValue &message) {
            SerialLink *const link = codec.link();
            link->send(codec.encode(message).bytes, SerialLink::Rank::Usual);
            for (QByteArray frame = link->next(); !frame.isEmpty(); frame = link->next())
                socket.write(frame);
        }
        /// What has come, when there are so many.
        std::vector<QJsonValue> replies(std::size_t count) {
            auto limit = runningTimer();
            while (got.size() < count && limit.elapsed() < 5000 * patience) {
                QTest::qWait(1);
                for (const CodecItem &item : codec.feed(socket.readAll()))
                    got.push_back(item.message);
                for (QByteArray frame = codec.link()->next(); !frame.isEmpty(); frame = codec.link()->next())
                    socket.write(frame); // reports
            }
            return std::exchange(got, {});
        }
        QJsonValue ask(const QJsonValue &message) {
            send(message);
            const auto all = replies(1);
            return all.size() == 1 ? all[0] : QJsonValue();
        }

        QTcpSocket socket;
        SerialCodec codec;
        std::vector<QJsonValue> got;
    };

    class HaltingDaemon : public TestedDaemon {
    public:
        HaltingDaemon() {
            addCommand(Command("halt", "Stops").urgent().handler([this](const Call &) { return ++halts; }));
            addCommand(Command("go", "Moves").fresh().handler([](const Call &) { return true; }));
        }
        int halts = 0;
    };

private Q_SLOTS:
    void init() {
        Log::instance().setStderr(false);
        daemon = std::make_unique<HaltingDaemon>();
        launch(*daemon, {}, "tcp://127.0.0.1:0?protocol=serial");
        client = std::make_unique<FrameClient>(daemon->server().addresses().value(0));
    }

    void cleanup() {
        client.reset();
        daemon.reset();
    }

    void aRepeatIsAnsweredNotCarriedOut() {
        const QJsonObject request = makeRequest(7, "subtract", QJsonArray{5, 3});
        const QJsonValue first = client->ask(request);
        QCOMPARE(first["result"].toInt(), 2);
        for (int i = 0; i < 3; ++i)
            QCOMPARE(client->ask(request), first);
        QCOMPARE(requests(), 1);
        QCOMPARE(repeats(), 3);
    }

    void aRepeatWhileTheFirstRunsIsSwallowed() {
        const QJsonObject request = makeRequest("slow", "later", QJsonObject());
        for (int i = 0; i < 4; ++i)
            client->send(request);
        client->send(makeRequest(1, "subtract", QJsonArray{5, 3}));
        QCOMPARE(client->replies(1).size(), size_t(1));
        QCOMPARE(daemon->replies.size(), size_t(1));
        QCOMPARE(repeats(), 3);
        daemon->replies[0].result("done");
        const auto answer = client->replies(1);
        QCOMPARE(answer.size(), size_t(1));
        QCOMPARE(answer[0]["result"].toString(), QString("done"));
        QCOMPARE(client->ask(request)["result"].toString(), QString("done"));
        QCOMPARE(daemon->replies.size(), size_t(1));
    }

    void sameIdOtherContentIsNew() {
        QCOMPARE(client->ask(makeRequest(1, "subtract", QJsonArray{5, 3}))["result"].toInt(), 2);
        QCOMPARE(client->ask(makeRequest(1, "subtract", QJsonArray{5, 4}))["result"].toInt(), 1);
        QCOMPARE(client->ask(makeRequest("1", "subtract", QJsonArray{5, 4}))["result"].toInt(), 1);
        QVERIFY(client->ask(makeRequest(1, "large", QJsonObject{{"bytes", 10}}))["result"].isString());
        QCOMPARE(requests(), 4);
        QCOMPARE(repeats(), 0);
    }

    void withoutIdNothingIsKept() {
        const QJsonObject notification = makeNotification("subtract", QJsonArray{5, 3});
        client->send(notification);
        client->send(notification);
        const QJsonObject nullId = makeRequest(QJsonValue::Null, "subtract", QJsonArray{5, 3});
        client->ask(nullId);
        client->ask(nullId);
        QCOMPARE(requests(), 4);
        QCOMPARE(repeats(), 0);
    }

    void batchesAreRepeatedToo() {
        const QJsonArray batch{makeRequest(1, "subtract", QJsonArray{5, 3}),
                               makeNotification("subtract", QJsonArray{1, 1}),
                               makeRequest(2, "subtract", QJsonArray{5, 4})};
        const QJsonValue first = client->ask(batch);
        QCOMPARE(first.toArray().size(), 2);
        QCOMPARE(first.toArray().at(1)["result"].toInt(), 1);
        QCOMPARE(client->ask(batch), first);
        QCOMPARE(requests(), 3);
    }

    void errorsAreKept() {
        const QJsonObject request = makeRequest(1, "fault", QJsonObject());
        const QJsonValue first = client->ask(request);
        QCOMPARE(first["error"]["code"].toInt(), int(ErrorCode::DeviceFault));
        QCOMPARE(client->ask(request), first);
        QCOMPARE(requests(), 1);
    }

    // Also with an id that a stop has had before it was released.
    void aStopStopsEachTime() {
        const QJsonObject request = makeRequest(1, "halt", QJsonObject());
        for (int i = 1; i <= 3; ++i)
            QCOMPARE(client->ask(request)["result"].toInt(), i);
        QCOMPARE(repeats(), 0);
    }

    void aStopInABatchStopsEachTime() {
        const QJsonArray batch{makeRequest(7, "halt", QJsonObject()),
                               makeRequest(8, "subtract", QJsonArray{5, 3})};
        const QJsonValue first = client->ask(batch);
        QCOMPARE(first.toArray().size(), 2);
        QCOMPARE(client->ask(batch), first);
        QCOMPARE(daemon->halts, 2);
    }

    void whatWasAskedBeforeAStopIsVoid_data() {
        const Rows<QJsonValue, QJsonValue, bool> row("stop", "id", "isVoid");
        row("before", QJsonValue(100), QJsonValue(99), true);
        row("long before", QJsonValue(10000), QJsonValue(6000), true);
        row("after", QJsonValue(100), QJsonValue(101), false);
        row("of another program", QJsonValue(4000000000.0), QJsonValue(7), false);
        row("a text", QJsonValue(100), QJsonValue("99"), false);
        row("the stop has a text", QJsonValue("100"), QJsonValue(99), false);
    }

    // Its first copy was lost, and the stop has overtaken the repeat.
    void whatWasAskedBeforeAStopIsVoid() {
        FETCH(QJsonValue, stop, QJsonValue, id, bool, isVoid);
        QJsonObject go = makeRequest(0, "go", QJsonObject());
        go["id"] = id;
        QJsonObject halt = makeRequest(0, "halt", QJsonObject());
        halt["id"] = stop;
        QVERIFY(client->ask(halt)["result"].isDouble());
        if (stop.isDouble()) { // an older stop that comes again changes nothing
            halt["id"] = stop.toDouble() - 50;
            QVERIFY(client->ask(halt)["result"].isDouble());
        }
        QCOMPARE(client->ask(go)["error"]["code"].toInt(), isVoid ? int(ErrorCode::NotReady) : 0);
        go["params"] = QJsonArray(); // else it would be a repeat
        QCOMPARE(client->ask(QJsonArray{go}).toArray().at(0)["error"]["code"].toInt(),
                 isVoid ? int(ErrorCode::NotReady) : 0);
    }

    void otherFramingsKeepNothing() {
        TestedDaemon plain;
        launch(plain);
        RawClient raw(plain.server().addresses().value(0));
        raw.ask("subtract", QJsonArray{5, 3});
        raw.ask("subtract", QJsonArray{5, 3});
        QCOMPARE(plain.server().counters()["requests"].toInt(), 2);
    }

    void aLargeReplyIsNotSentTwiceAtOnce() {
        const QJsonObject request = makeRequest(1, "large", QJsonObject{{"bytes", 20000}});
        for (int i = 0; i < 5; ++i)
            client->send(request);
        QCOMPARE(client->replies(1).size(), size_t(1));
        QCOMPARE(requests(), 1);
        client->send(makeRequest(2, "subtract", QJsonArray{5, 3}));
        const auto next = client->replies(1);
        QCOMPARE(next.size(), size_t(1));
        QCOMPARE(next[0]["id"].toInt(), 2);                                // no second one came before
        QCOMPARE(client->ask(request)["result"].toString().size(), 20000); // whoever asks again gets it again
        QCOMPARE(requests(), 2);
    }

    void boundsOfTheCache() {
        using Known = ReplyCache::Known;
        Channel channel(LoopbackInterface::pair(this).first, makeCodec("serial"), nullptr);
        channel.open();
        ReplyCache cache;
        const auto key = [](int number) { return QByteArray::number(number); };
        const auto begin = [&](int number, double now) { return cache.begin(key(number), channel, now); };
        const auto answer = [&](int number, int bytes, double now) {
            cache.answer(key(number), {QByteArray(bytes, 'x'), 0}, Channel::Rank::Usual, now);
        };
        // Count: the oldest is forgotten, but never one that runs.
        QCOMPARE(begin(-1, 0), Known::New);
        for (int i = 0; i < 3000; ++i) {
            QCOMPARE(begin(i, i * 0.01), Known::New);
            answer(i, 10, i * 0.01);
        }
        QCOMPARE(cache.size(), ReplyCache::maxEntries);
        QCOMPARE(begin(-1, 30), Known::Repeat);
        QCOMPARE(begin(2999, 30), Known::Repeat);
        QCOMPARE(begin(0, 30), Known::New);
        // Age, since it was wanted last.
        QCOMPARE(begin(2999, 320), Known::Repeat);
        QCOMPARE(begin(2999, 600), Known::Repeat);
        QCOMPARE(begin(2998, 600), Known::New);
        QCOMPARE(begin(2999, 901), Known::New);
        // Bytes: it is still known that there was a reply.
        ReplyCache large;
        for (int i = 0; i < 30; ++i) {
            large.begin(key(i), channel, 0);
            large.answer(key(i), {QByteArray(100000, 'x'), 0}, Channel::Rank::Usual, 0);
        }
        QVERIFY(large.bytes() <= ReplyCache::maxBytes);
        QVERIFY(large.bytes() > ReplyCache::maxBytes - 100000);
        QCOMPARE(large.begin(key(0), channel, 1), Known::Lost);
        QCOMPARE(large.begin(key(29), channel, 1), Known::Repeat);
        const qint64 before = large.bytes();
        large.begin(key(30), channel, 1);
        large.answer(key(30), {QByteArray(2 << 20, 'x'), 0}, Channel::Rank::Usual,
                     1); // takes no other one's place
        QCOMPARE(large.bytes(), before);
        QCOMPARE(large.begin(key(30), channel, 1), Known::Lost);
        large.forget(key(30));
        QCOMPARE(large.begin(key(30), channel, 1), Known::New);
    }

private:
    int requests() const { return daemon->server().counters()["requests"].toInt(); }
    int repeats() const { return daemon->server().counters()["line_repeated_requests"].toInt(); }

    std::unique_ptr<HaltingDaemon> daemon;
    std::unique_ptr<FrameClient> client;
};
