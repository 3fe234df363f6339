// hermesctl watch: the messages of a topic.
#include "common/platform/Console.h"
#include "common/progress/Progress.h"
#include "gui/hermesctl/Commands.h"
#include "gui/hermesctl/CsvTable.h"

#include <QEventLoop>
#include <QJsonArray>
#include <QTimer>
#include <optional>

namespace hermes::ctl {
namespace {

/// Prints messages, counts what is missing between them, and tells of it at the end.
class Watcher {
public:
    Watcher(Client &client, const Arguments &arguments)
        : client_(client)
        , arguments_(arguments)
        , left_(arguments.count) {}

    /// Until the count is reached, the end is asked for, or the daemon refuses.
    Result<void> run() {
        if (arguments_.csv) {
            if (const auto begun = beginTable(); !begun)
                return begun;
        }
        const bool isSeen = arguments_.out.isEmpty() && isTerminal(StandardStream::Output);
        if (arguments_.count > 0 && !isSeen)
            progress_.emplace("message");
        Result<void> result;
        QObject::connect(&client_, &Client::subscriptionFailed, &loop_, [&](int, const RpcError &error) {
            result = error;
            loop_.quit();
        });
        QObject::connect(&client_, &Client::disconnected, &loop_,
                         [this](const QString &reason) { onDisconnected(reason); });
        QObject::connect(&client_, &Client::connected, &loop_, [this] { isLost_ = false; });
        QJsonObject options{{"queue", 100}};
        if (arguments_.rate_hz > 0)
            options.insert("max_rate_hz", arguments_.rate_hz);
        client_.subscribe(arguments_.words.at(1), options,
                          [this](const TopicUpdate &update) { onMessage(update); });
        silence_.setSingleShot(true);
        QObject::connect(&silence_, &QTimer::timeout, &loop_, [&] {
            if (!arguments_.timeoutIsGiven)
                return note(QString("no message of %1 yet; hermesctl list shows what is wrong with a daemon")
                                .arg(arguments_.words.at(1)));
            result = Error(ErrorCode::TimedOut, QString("%1: no message within %2 s")
                                                    .arg(arguments_.words.at(1))
                                                    .arg(double(arguments_.timeout.count()) / 1000));
            loop_.quit();
        });
        silence_.start(arguments_.timeout);
        runStream(loop_);
        progress_.reset();
        tellWhatIsMissing();
        return result;
    }

private:
    Result<void> beginTable() {
        const auto topics = ask(client_, arguments_, "topics.list");
        if (!topics)
            return topics.error();
        for (const QJsonValue &topic : topics->toArray()) {
            if (topic["name"].toString() == arguments_.words.at(1))
                table_ = CsvTable(topic["schema"].toObject());
        }
        if (const auto header = table_.header())
            printHeader(*header);
        return {};
    }

    void printHeader(const QString &header) {
        hasHeader_ = true;
        printLine(header);
    }

    void onDisconnected(const QString &reason) {
        if (std::exchange(isLost_, true))
            return;
        ++interruptions_;
        droppedBefore_ += dropped_;
        dropped_ = 0;
        note(QString("%1; trying again").arg(reason));
    }

    void onMessage(const TopicUpdate &update) {
        if (arguments_.count > 0 && left_ == 0)
            return; // more came in the same read than were asked for
        arguments_.timeoutIsGiven ? silence_.start() : silence_.stop();
        dropped_ = update.dropped;
        arguments_.csv ? printRow(update) : printMessage(update);
        if (readerIsGone() || (arguments_.count > 0 && --left_ == 0))
            loop_.quit();
        if (progress_)
            progress_->update(arguments_.count - left_, arguments_.count);
    }

    void printRow(const TopicUpdate &update) {
        const QJsonValue data = update.json();
        table_.begin(data);
        if (!hasHeader_)
            printHeader(*table_.header());
        printLine(table_.line(QString::number(update.stamp, 'f', 6), update.seq, update.dropped, data));
    }

    static void printMessage(const TopicUpdate &update) {
        QJsonObject message{{"stamp", update.stamp},
                            {"seq", double(update.seq)},
                            {"dropped", double(update.dropped)},
                            {"data", update.json()}};
        if (update.replayed)
            message.insert("replayed", true);
        printJson(message);
    }

    void tellWhatIsMissing() const {
        if (const quint64 all = droppedBefore_ + dropped_; all > 0)
            note(QString("%1 messages are missing: they were dropped because they were not read in time "
                         "(column or member dropped)")
                     .arg(all));
        if (interruptions_ > 0)
            note(QString("the connection was lost %1 times: what was published meanwhile is missing")
                     .arg(interruptions_));
        if (const auto &rejected = client_.rejected(); rejected.unreadable > 0)
            note(QString("%1 messages could not be read; the last: %2")
                     .arg(rejected.unreadable)
                     .arg(rejected.last));
        const auto &missing = table_.withoutColumn();
        for (auto one = missing.begin(); one != missing.end(); ++one)
            note(QString("%1 came in %2 messages after the header: it has no column")
                     .arg(one.key())
                     .arg(one.value()));
    }

    Client &client_;
    const Arguments &arguments_;
    QEventLoop loop_;
    QTimer silence_; ///< without --timeout only until the first message
    CsvTable table_{{}};
    int left_;
    std::optional<Progress> progress_;
    bool hasHeader_ = false;
    bool isLost_ = false;
    quint64 dropped_ = 0; ///< over this connection
    quint64 droppedBefore_ = 0;
    int interruptions_ = 0;
};

} // namespace

Result<void> watch(Client &client, const Arguments &arguments) {
    return Watcher(client, arguments).run();
}

} // namespace hermes::ctl
