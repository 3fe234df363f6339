#include "daemons/recorder/TopicReturn.h"
#include "protocol/mcap/Writer.h"
#include "tests/support/DaemonClient.h"
#include "tests/support/Files.h"
#include "tests/support/Rows.h"
#include "tests/support/Texts.h"

#include <QTcpServer>

using namespace hermes;
using namespace hermes::recorder;

namespace {

constexpr std::int64_t begin_ns = 1700000000000000000;

/// A message of a topic "DAEMON/TOPIC", at a time after the beginning.
struct Told {
    const char *topic;
    double t_s;
    QByteArray data;
};

QByteArray fileOf(const std::vector<Told> &messages, const char *encoding = "json") {
    std::string bytes;
    mcap::Writer writer(
        [&bytes](std::string_view more) {
            bytes += more;
            return true;
        },
        "test", 100);
    std::map<std::string, std::uint16_t> channels;
    for (const Told &told : messages) {
        const QStringList name = QString(told.topic).split('/');
        std::uint16_t &channel = channels[told.topic];
        if (channel == 0)
            channel = writer.addChannel(
                writer.addSchema("s", "jsonschema", "{}"), told.topic, encoding,
                {{"daemon", name.value(0).toStdString()}, {"topic", name.value(1).toStdString()}});
        const auto time = std::uint64_t(begin_ns + std::int64_t(told.t_s * 1e9));
        writer.write(
            {channel, 0, time, time + 500000000, {told.data.constData(), std::size_t(told.data.size())}});
    }
    writer.finish();
    return QByteArray::fromStdString(bytes);
}

/// Shows what is replayed.
class ShowingDaemon : public Daemon {
public:
    explicit ShowingDaemon(const QString &name)
        : Daemon({name, "Shows", "For tests", 1}) {
        addTopic(Topic("state", "A state").snapshot([] { return QJsonValue("now"); }));
    }
};

} // namespace

class TestTopicPlayer : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void init() {
        folder_ = std::make_unique<QTemporaryDir>();
        recording_ = {};
        taken_.clear();
        ended_.reset();
        hasRoom_ = nullptr;
        QVERIFY(folder_->isValid());
    }

    void cleanup() { player_.stop(); }

    void playsAllFilesInOrder() {
        add("a.mcap", fileOf({{"matcher/pose", 0, "1"}, {"motors/odometry", 0.5, "{\"x\":2}"}}));
        add("b.mcap", fileOf({{"matcher/pose", 1, "\"3\""},
                              {"matcher/log", 1.2, "4"},
                              {"motors/status", 1.3, "5"},
                              {"logger/scan2d", 1.4, "6"},
                              {"matcher/commands", 1.5, "7"},
                              {"x/settings", 2, "8"}}));
        add("c.mcap", fileOf({{"matcher/pose", 3, "9"}}, "ros1"));
        add("d.mcap", fileOf({}));
        start({0, false, false});
        QTRY_VERIFY(ended_);
        QCOMPARE(ended_->error().message, QString());
        QCOMPARE(told(), QStringList({"matcher/pose 1", "motors/odometry {\"x\":2}", "matcher/pose \"3\""}));
        QCOMPARE(taken_[1].stamp, double(begin_ns) * 1e-9 + 1);
    }

    // And what waits is bounded: the player reads no further.
    void waitsForRoomAndLosesNothing() {
        std::vector<Told> many;
        for (int i = 0; i < 3000; ++i)
            many.push_back({"matcher/pose", i * 1e-3, QByteArray::number(i)});
        add("a.mcap", fileOf(many));
        hasRoom_ = [calls = 0]() mutable { return ++calls % 300 != 0; };
        start({0, false, false});
        QTRY_VERIFY(ended_);
        QCOMPARE(taken_.size(), many.size());
        for (std::size_t i = 0; i < many.size(); ++i)
            QCOMPARE(taken_[i].data, many[i].data);
    }

    void keepsThePace() {
        add("a.mcap", fileOf({{"matcher/pose", 0, "1"}, {"matcher/pose", 0.2, "2"}}));
        const auto clock = runningTimer();
        start({1, false, false});
        QTRY_COMPARE(taken_.size(), std::size_t(2));
        QVERIFY(clock.elapsed() >= 200);
    }

    void aSeekTellsWhatWasBefore() {
        add("a.mcap", fileOf({{"old/state", 0, "0"}, {"matcher/map", 1, "{\"cleared\":true,\"n\":1}"}}));
        add("b.mcap", fileOf({{"matcher/map", 2, "{\"cleared\":true,\"n\":2}"},
                              {"matcher/map", 2.1, "{\"cleared\":false,\"n\":3}"},
                              {"matcher/pose", 2.2, "1"},
                              {"matcher/map", 100, "{\"cleared\":false,\"n\":4}"},
                              {"matcher/pose", 101, "2"},
                              {"matcher/pose", 101.1, "3"},
                              {"motors/state", 102, "4"},
                              {"matcher/pose", 300, "5"}}));
        add("c.mcap", fileOf({{"motors/state", 400, "6"}}));
        start({1, false, true});
        player_.playback().seek(101.05);
        const QStringList before{"old/state 0", "matcher/map {\"cleared\":true,\"n\":2}",
                                 "matcher/map {\"cleared\":false,\"n\":3}",
                                 "matcher/map {\"cleared\":false,\"n\":4}", "matcher/pose 2"};
        QTRY_COMPARE(told(),
                     before + QStringList{"matcher/pose 3"}); // that is of the quarter second after it
        taken_.clear();
        player_.playback().seek(350);
        QTRY_COMPARE(told(), QStringList({"old/state 0", "matcher/map {\"cleared\":true,\"n\":2}",
                                          "matcher/map {\"cleared\":false,\"n\":3}",
                                          "matcher/map {\"cleared\":false,\"n\":4}", "motors/state 4",
                                          "matcher/pose 5"}));
        taken_.clear();
        player_.playback().seek(0);
        QTRY_COMPARE(told(), QStringList{"old/state 0"});
        QVERIFY(!ended_);
    }

    void whatIsDamagedIsTold_data() {
        const QByteArray whole = fileOf({{"matcher/pose", 0.5, QByteArray(5000, '1')}});
        const Rows<QByteArray, bool> row("content", "isMissing");
        row("no MCAP", "nothing", false);
        row("empty", "", false);
        row("missing", whole, true);
    }
    void whatIsDamagedIsTold() {
        FETCH(QByteArray, content, bool, isMissing);
        add("a.mcap", fileOf({{"matcher/pose", 0, "1"}}));
        add("b.mcap", content, isMissing ? content.size() + 100 : content.size());
        add("c.mcap", fileOf({{"matcher/pose", 1, "2"}}));
        start({0, false, false});
        QTRY_VERIFY(ended_);
        QVERIFY(!ended_->ok());
        VERIFY_CONTAINS(ended_->error().message, "b.mcap");
        QCOMPARE(told().first(), QString("matcher/pose 1"));
        QCOMPARE(told().last(), QString("matcher/pose 2"));
    }

    void daemonsShowWhatIsGivenBack() {
        ShowingDaemon daemon("showing");
        launch(daemon);
        ConnectedClient client(asOwner(daemon.server().addresses().value(0)));
        ConnectedClient viewer(asOwner(daemon.server().addresses().value(0)));
        std::vector<TopicUpdate> seen;
        viewer.subscribe("state", {{"queue", 1000}},
                         [&](const TopicUpdate &update) { seen.push_back(update); });
        QTRY_COMPARE(seen.size(), std::size_t(1));
        TopicReturn back([&](const QString &name) { return name == "showing" ? &client : nullptr; });
        for (int i = 0; i < 100; ++i)
            while (!back.take({"showing", "state", 5.0 + i, QByteArray::number(i)}))
                QCoreApplication::processEvents(QEventLoop::WaitForMoreEvents); // the daemon answers
        QTRY_COMPARE(seen.size(), std::size_t(101));
        QVERIFY(seen[1].replayed && !seen[0].replayed);
        QCOMPARE(seen[100].stamp, 104.0);
        QCOMPARE(seen[100].json().toInt(), 99);
        QCOMPARE(back.problems(), QStringList());
        for (const RecordedMessage &wrong :
             {RecordedMessage{"absent", "state", 1, "1"}, RecordedMessage{"showing", "none", 1, "1"},
              RecordedMessage{"showing", "state", 1, "no JSON"},
              RecordedMessage{"showing", "state", 1, QByteArray(2 << 20, '1')}})
            QVERIFY(back.take(wrong));
        QTRY_COMPARE(back.problems().size(), 2);
        QTRY_VERIFY(back.problems().join("\n").contains("showing: 3 messages were not shown"));
        VERIFY_CONTAINS(back.problems().join("\n"),
                        "absent: 1 messages were not shown, the last: it does not run");
        back.end();
        QTRY_COMPARE(seen.size(), std::size_t(102));
        QCOMPARE(seen.back().json().toString(), QString("now"));
        QVERIFY(!seen.back().replayed);
    }

    void whoDoesNotAnswerKeepsNobodyWaiting() {
        QTcpServer deaf;
        QVERIFY(deaf.listen(QHostAddress::LocalHost));
        ConnectedClient client(QString("127.0.0.1:%1").arg(deaf.serverPort()));
        TopicReturn back([&](const QString &) { return &client; });
        const RecordedMessage message{"deaf", "state", 1, "1"};
        int given = 0;
        while (back.take(message))
            ++given;
        QVERIFY(given > 0);
        QTRY_COMPARE(back.problems().size(), 1);
        for (int i = 0; i < 100; ++i)
            QVERIFY(back.take(message));
        VERIFY_CONTAINS(back.problems().first(), "it does not answer");
    }

private:
    void add(const QString &name, const QByteArray &content, qint64 recorded = -1) {
        put(folder_->filePath(name), content);
        files_.append(
            QJsonObject{{"name", name}, {"bytes", double(recorded < 0 ? content.size() : recorded)}});
    }
    void start(const Playback::Options &options) {
        recording_.folder = folder_->path();
        recording_.length_s = 400;
        recording_.sidecar = {{"files", std::exchange(files_, {})}};
        const auto take = [this](const RecordedMessage &message) {
            if (hasRoom_ && !hasRoom_())
                return false;
            taken_.push_back(message);
            return true;
        };
        const auto end = [this](const Result<void> &result) {
            QMetaObject::invokeMethod(
                this, [this, result] { ended_ = result; }, Qt::QueuedConnection);
        };
        QVERIFY(player_.start(recording_, options, begin_ns, {"logger"}, take, end).ok());
    }
    QStringList told() const {
        QStringList texts;
        for (const RecordedMessage &message : taken_)
            texts << QString("%1/%2 %3").arg(message.daemon, message.topic, QString(message.data));
        return texts;
    }

    std::unique_ptr<QTemporaryDir> folder_;
    QJsonArray files_;
    StoredRecording recording_;
    std::function<bool()> hasRoom_;
    std::vector<RecordedMessage> taken_;
    std::optional<Result<void>> ended_;
    TopicPlayer player_;
};
