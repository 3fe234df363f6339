// The framing serial over a serial line of 115,200 baud, bytes damaged on their way in both directions: each
// call is carried out once, and a stop does not wait behind a map.
#include "DaemonFixture.h"
#include "common/Time.h"
#include "common/client/Client.h"
#include "tests/support/NoisyLine.h"
#include "tests/support/PatientClient.h"

using namespace hermes;

constexpr int damageOneIn = 200;
constexpr double bytesPerSecond = 11520;

class CountingDaemon : public TestedDaemon {
public:
    CountingDaemon() {
        addCommand(Command("count", "Counts")
                       .param(Field::integer("number", "Which"))
                       .handler([this](const Call &call) {
                           ++times[call.integer("number")];
                           return call.integer("number") * 2;
                       }));
        addCommand(Command("halt", "Stops")
                       .urgent()
                       .param(Field::integer("number", "Which"))
                       .handler([this](const Call &call) {
                           haltedAt.emplace(call.integer("number"), monotonicNow());
                           return ++halts;
                       }));
        addCommand(
            Command("store", "Takes much").param(Field::text("what", "Much")).handler([](const Call &call) {
                return call.text("what").size();
            }));
    }
    std::map<qint64, int> times;
    int halts = 0;
    std::map<qint64, double> haltedAt; // the first time each
};

struct Figures {
    double median = 0, p99 = 0, worst = 0;
};

static Figures figuresOf(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const auto at = [&values](double part) { return values[std::size_t(part * double(values.size() - 1))]; };
    return {at(0.5), at(0.99), at(1)};
}

class TestSerialLine : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void init() {
        Log::instance().setStderr(false);
        line = std::make_unique<NoisyLine>(bytesPerSecond);
        startDaemon();
        client = newClient();
        QVERIFY(client->waitConnected());
    }

    void cleanup() {
        client.reset();
        daemon.reset();
        line.reset();
    }

    void eachCallOnceOnADamagedLine() {
        const QByteArray given = qgetenv("HERMES_CALLS");
        const int calls = given.isEmpty() ? 150 : given.toInt(), atOnce = 4;
        damage();
        int begun = 0, ended = 0, failed = 0;
        std::vector<double> took_s;
        const double start = monotonicNow();
        std::function<void()> callNext = [&] {
            if (begun == calls)
                return;
            const int number = begun++;
            const double at = monotonicNow();
            client->call(
                "count", QJsonObject{{"number", number}},
                [&, number, at](const Result<QJsonValue> &result) {
                    failed += !result || result->toInt() != 2 * number;
                    took_s.push_back(monotonicNow() - at);
                    ++ended;
                    callNext();
                },
                std::chrono::seconds(60));
        };
        for (int i = 0; i < atOnce; ++i)
            callNext();
        while (ended < calls)
            QTest::qWait(10);
        const double seconds = monotonicNow() - start;
        int twice = 0;
        for (const auto &[number, times] : daemon->times)
            twice += times > 1;
        const Figures figures = figuresOf(took_s);
        qInfo("%d calls in %.1f s (%.1f a second): %d carried out, %d lost, %d twice; a call took %.0f ms "
              "(median), %.0f "
              "ms (99 %%), %.0f ms at most",
              calls, seconds, calls / seconds, int(daemon->times.size()), failed, twice, figures.median * 1e3,
              figures.p99 * 1e3, figures.worst * 1e3);
        printLink();
        QCOMPARE(int(daemon->times.size()), calls);
        QCOMPARE(failed, 0);
        QCOMPARE(twice, 0);
        QVERIFY(counter("line_damaged_frames") > 0);
    }

    void stopDoesNotWaitBehindAMap_data() {
        const Rows<bool, bool, bool> row("ofDaemon", "ofClient", "isDamaged");
        row("a large reply", true, false, false);
        row("a large request", false, true, false);
        row("both", true, true, false);
        row("both, damaged", true, true, true);
    }

    void stopDoesNotWaitBehindAMap() {
        FETCH(bool, ofDaemon, bool, ofClient, bool, isDamaged);
        if (isDamaged)
            damage();
        const int bytes = 1000000, stops = 30;
        int under = 0;
        const auto done = [&under](const Result<QJsonValue> &) { --under; };
        if (ofDaemon) {
            ++under;
            client->call("large", QJsonObject{{"bytes", bytes}}, done, std::chrono::minutes(10));
        }
        if (ofClient) {
            ++under;
            client->call("store", QJsonObject{{"what", QString(bytes, 'y')}}, done, std::chrono::minutes(10));
        }
        const quint64 idle = line->passed();
        QTRY_VERIFY(line->passed() > idle + 3000); // the line is full
        const quint64 before = line->passed();
        const double start = monotonicNow();
        std::vector<double> stopped_s, answered_s;
        for (int i = 0; i < stops; ++i) {
            const double at = monotonicNow();
            const auto result = client->callAndWait("halt", QJsonObject{{"number", i}},
                                                    std::chrono::seconds(30), Client::Repeats::AtOnce);
            QVERIFY(result);
            answered_s.push_back(monotonicNow() - at);
            stopped_s.push_back(daemon->haltedAt.at(i) - at);
            QTest::qWait(37 + i % 13);
        }
        QCOMPARE(under, int(ofDaemon) + int(ofClient)); // it was on its way all the time
        const double used = double(line->passed() - before) / (monotonicNow() - start) / bytesPerSecond;
        const Figures stopped = figuresOf(stopped_s), answered = figuresOf(answered_s);
        for (const auto &[what, figures] : {std::pair("stopped", stopped), std::pair("answered", answered)})
            qInfo("%d stops, %s after %.1f ms (median), %.1f ms (99 %%), %.1f ms at most", stops, what,
                  figures.median * 1e3, figures.p99 * 1e3, figures.worst * 1e3);
        qInfo("%d frames came; the line was used by %.0f %% of a way", daemon->halts, used * 100);
        QVERIFY(daemon->halts >= stops); // a stop stops each time that it comes
        QVERIFY(stopped.median < 0.05 * slowness);
        QVERIFY(stopped.p99 <
                (isDamaged ? 0.2 : 0.05) * slowness); // chance: all of the first repeats may be lost
        QVERIFY(isDamaged || answered.p99 < 0.05 * slowness);
        QVERIFY(used > 0.5);
    }

    void muchArrivesOnADamagedLine() {
        damage();
        const double start = monotonicNow();
        const auto large = client->callAndWait("large", QJsonArray{15000}, std::chrono::seconds(60));
        QVERIFY2(large, large ? "" : qPrintable(large.error().message));
        QCOMPARE(large->toString(), QString(15000, 'x'));
        const double until = monotonicNow();
        const auto stored =
            client->callAndWait("store", QJsonArray{QString(15000, 'y')}, std::chrono::seconds(60));
        QVERIFY2(stored, stored ? "" : qPrintable(stored.error().message));
        QCOMPARE(stored->toInt(), 15000);
        qInfo("15,000 bytes: %.1f s from the daemon, %.1f s to it", until - start, monotonicNow() - until);
        printLink();
    }

    void topicsAndAMapShareTheLine() {
        int got = 0;
        bool inOrder = true;
        double last = 0;
        client->subscribe("numbers", {}, [&](const TopicUpdate &update) {
            ++got;
            inOrder = inOrder && double(update.seq) > last;
            last = double(update.seq);
        });
        QTRY_VERIFY(daemon->hasSubscribers("numbers"));
        bool done = false;
        client->call(
            "large", QJsonArray{20000}, [&done](const Result<QJsonValue> &result) { done = result.ok(); },
            std::chrono::seconds(60));
        QTimer publisher;
        int published = 0;
        QObject::connect(&publisher, &QTimer::timeout, this, [&] {
            daemon->publish("numbers", QJsonObject{{"text", QString(published++ % 2 ? 20 : 600, 'z')}});
        });
        publisher.start(20);
        const double start = monotonicNow();
        QTRY_VERIFY_WITH_TIMEOUT(done, 20000 * slowness);
        const double seconds = monotonicNow() - start;
        qInfo("%d messages of a topic, of %d published, beside 20,000 bytes in %.1f s", got, published,
              seconds);
        QVERIFY(got > 5);
        QVERIFY(inOrder);
        QVERIFY(counter("dropped_topic_messages") > 0); // only the newest waits
    }

    void clientBeginsAnewInTheMiddle() {
        client->call(
            "large", QJsonArray{300000}, [](const Result<QJsonValue> &) {}, std::chrono::minutes(5));
        client->subscribe("numbers", {}, nullptr);
        QTRY_VERIFY(daemon->hasSubscribers("numbers"));
        const quint64 begun = line->passed();
        QTRY_VERIFY(line->passed() >
                    begun + 15000); // beyond the window: the new one cannot have the beginning
        client.reset();
        client = newClient();
        QVERIFY(client->waitConnected());
        QCOMPARE(client->callAndWait("count", QJsonArray{1})->toInt(), 2);
        QCOMPARE(client->callAndWait("large", QJsonArray{3000}, std::chrono::seconds(20))->toString(),
                 QString(3000, 'x'));
        QTRY_COMPARE(daemon->server().counters()["line_abandoned_messages"].toInt(), 1);
        daemon->publish("numbers", 1); // what the first one subscribed to ends
        QTRY_VERIFY(!daemon->hasSubscribers("numbers"));
    }

    void subscriptionsHoldOnADamagedLine() {
        damage();
        for (int i = 0; i < 10; ++i) {
            QStringList got;
            const int handle = client->subscribe(
                "state", {}, [&got](const TopicUpdate &update) { got.append(update.json().toString()); });
            QTRY_VERIFY(daemon->hasSubscribers("state"));
            QTRY_COMPARE(got, QStringList{"all"}); // its beginning is not lost
            client->unsubscribe(handle);
            QTRY_VERIFY(!daemon->hasSubscribers("state"));
        }
    }

    void batchesWaitForEachOther() {
        client.reset();
        const auto channel =
            Channel::make("serial://" + line->device(1) + "?baud=115200&protocol=serial", this);
        QVERIFY(channel);
        int replies = 0;
        connect(*channel, &Channel::message, this, [&replies](const QJsonValue &message) {
            for (const QJsonValue &reply : message.toArray())
                replies += reply["result"].isDouble();
        });
        (*channel)->open();
        for (int batch = 0; batch < 3; ++batch) {
            QJsonArray requests;
            for (int i = 0; i < 40; ++i)
                requests.append(makeRequest(batch * 100 + i, "count", QJsonArray{batch * 100 + i}));
            QVERIFY((*channel)->send(requests, Channel::Rank::Topic));
        }
        QTRY_COMPARE_WITH_TIMEOUT(replies, 120, 10000 * slowness);
        QCOMPARE(daemon->times.size(), size_t(120));
        delete *channel;
    }

    void aSlowCommandIsRepeatedSeldom() {
        for (int i = 0; i < 10; ++i) // what is usual is known then
            QVERIFY(client->callAndWait("count", QJsonArray{i}));
        const quint64 before = client->repeats();
        std::vector<QString> results;
        const auto keep = [&results](const Result<QJsonValue> &result) {
            results.push_back(result ? result->toString() : result.error().message);
        };
        client->call("later", QJsonObject(), keep);
        QTest::qWait(3000);
        QCOMPARE(daemon->replies.size(), size_t(1));
        const quint64 repeats = client->repeats() - before;
        qInfo("repeated %llu times in 3 s", repeats);
        QVERIFY(repeats >= 2 && repeats <= 12);
        daemon->replies[0].result("done");
        QTRY_COMPARE(results, std::vector<QString>{"done"});
        client->call("later", QJsonObject(), keep, std::chrono::milliseconds(500));
        QTRY_COMPARE(results.size(), size_t(2));
        const quint64 then = client->repeats(); // nobody waits any more
        QTest::qWait(1500);
        QCOMPARE(client->repeats(), then);
        QCOMPARE(daemon->replies.size(), size_t(2));
    }

    void aStopOvertakesWhatItsClientAskedBefore() {
        int answered = 0, countedAtHalt = -1;
        for (int i = 0; i < 50; ++i)
            client->call(
                "count", QJsonObject{{"number", i}},
                [&answered](const Result<QJsonValue> &result) { answered += result.ok(); },
                std::chrono::seconds(20));
        const auto halted = [&](const Result<QJsonValue> &) { countedAtHalt = int(daemon->times.size()); };
        client->call("halt", QJsonObject{{"number", 1}}, halted, std::chrono::seconds(5),
                     Client::Repeats::AtOnce);
        QTRY_VERIFY(countedAtHalt >= 0);
        QVERIFY2(countedAtHalt < 10, saying(countedAtHalt));
        QTRY_COMPARE_WITH_TIMEOUT(answered, 50, 15000); // repeated
        for (const auto &[number, times] : daemon->times)
            QCOMPARE(times, 1);
    }

    void whatWouldBeLateIsNotSent() {
        int failed = 0;
        for (int i = 0; i < 50; ++i)
            client->call(
                "count", QJsonObject{{"number", i}},
                [&failed](const Result<QJsonValue> &result) {
                    failed += !result && result.error().is(ErrorCode::OverLimit);
                },
                std::chrono::seconds(5), Client::Repeats::None);
        QTRY_VERIFY(failed >= 40);
        QTRY_COMPARE(int(daemon->times.size()), 50 - failed);
    }

    void aPortThatComesBackIsHeardAgain() {
        QTemporaryDir folder;
        const QString port = folder.filePath("port");
        const auto plugIn = [&port] {
            auto made = std::make_unique<NoisyLine>(bytesPerSecond);
            QFile::remove(port);
            QFile::link(made->device(0), port);
            return made;
        };
        auto adapter = plugIn();
        CountingDaemon other;
        QVERIFY(!other.prepare({"tested", "--listen", "serial://" + port + "?baud=115200&protocol=serial",
                                "--listen", "tcp://127.0.0.1:0"}));
        QVERIFY(other.launch());
        RawClient beside(other.server().addresses().value(1));
        const auto health = [&beside] {
            const QJsonArray items = beside.ask("daemon.status")["result"].toObject()["health"].toArray();
            for (const QJsonValue &item : items)
                if (item["name"] == "channel")
                    return item.toObject();
            return QJsonObject();
        };
        QCOMPARE(health()["level"].toString(), QString("ok"));
        adapter.reset(); // unplugged
        QTRY_COMPARE(health()["level"].toString(), QString("error"));
        QVERIFY(health()["message"].toString().contains("the device is gone"));
        adapter = plugIn();
        ConnectedClient hopeful("serial://" + adapter->device(1) + "?baud=115200&protocol=serial");
        QVERIFY(hopeful.callAndWait("count", QJsonArray{1}));
        QCOMPARE(health()["level"].toString(), QString("ok"));
    }

    void aDaemonThatStartsAnewIsSubscribedAgain() {
        client->subscribe("numbers", {}, nullptr);
        client->subscribe("state", {}, nullptr);
        QTRY_VERIFY(daemon->hasSubscribers("numbers"));
        QVERIFY(client->callAndWait("daemon.info")); // after it has heard who is there
        daemon.reset();
        startDaemon();
        QVERIFY(!daemon->hasSubscribers("numbers"));
        QTRY_VERIFY_WITH_TIMEOUT(daemon->hasSubscribers("numbers") && daemon->hasSubscribers("state"), 15000);
    }

private:
    void startDaemon() {
        daemon = std::make_unique<CountingDaemon>();
        launch(*daemon, {}, "serial://" + line->device(0) + "?baud=115200&protocol=serial");
    }
    std::unique_ptr<Client> newClient() {
        auto made = std::make_unique<Client>();
        made->connectTo("serial://" + line->device(1) + "?baud=115200&protocol=serial");
        return made;
    }
    double counter(const char *name) const {
        return daemon->server().counters()[QLatin1String(name)].toDouble();
    }

    void printLink() const {
        qInfo(
            "line: %llu bytes, %llu damaged; daemon: %g frames in, %g out, %g damaged, %g requests repeated, "
            "%g pieces repeated, %g messages abandoned; client repeated %llu",
            line->passed(), line->damaged(), counter("line_frames_in"), counter("line_frames_out"),
            counter("line_damaged_frames"), counter("line_repeated_requests"),
            counter("line_repeated_pieces"), counter("line_abandoned_messages"), client->repeats());
    }

    void damage() {
        qInfo("one byte in %d is damaged", damageOneIn);
        line->setDamage(damageOneIn, newSeed());
    }

    std::unique_ptr<NoisyLine> line;
    std::unique_ptr<CountingDaemon> daemon;
    std::unique_ptr<Client> client;
};
