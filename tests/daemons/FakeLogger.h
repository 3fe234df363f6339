#pragma once

#include "common/Log.h"
#include "common/client/Client.h"
#include "common/daemon/Daemon.h"
#include "tests/common/LoggerFixture.h"

namespace hermes {

/// A logger in the process of the test: records a text, and replays nothing, in a while.
class FakeLogger : public Daemon {
public:
    /// asked: what loggers were asked for their source, in order, "NAME: what".
    FakeLogger(const QString &name, const QString &root, QStringList &asked, bool replays)
        : Daemon({name, name, "For tests"})
        , name_(name)
        , asked_(asked)
        , recording(name, settings(), health(), writer) {
        addCommands(recording.commands());
        if (replays)
            addSourceCommands();
        if (prepare({name, "--listen", "tcp://127.0.0.1:0", "--set", "record.folder=" + root, "--set",
                     "record.free_floor_bytes=0", "--set", "record.free_warn_bytes=0"}) ||
            !launch())
            qFatal("%s does not start", qPrintable(name));
    }
    ~FakeLogger() override { shutDown(); }

    QString address() { return server().addresses().value(0); }

    int openDelay_ms = 0;
    QString openError;       ///< of the next replays
    int positionsToEnd = 3;  ///< that are told before a replay ends
    QString source = "live"; ///< its state
    double delay_s = -1;     ///< of the last replay
    double speed = -1;       ///< that it goes at
    QJsonObject told;        ///< of its source, in place of what is so

protected:
    Result<void> start() override {
        recording.open();
        return {};
    }
    void stop() override { recording.close(); }

private:
    void addSourceCommands() {
        addCommand(Command("source.open", "Opens")
                       .param(Field::boolean("live", "Live").optional())
                       .param(Field::text("recording", "Which").optional())
                       .param(Field::number("speed", "Speed").byDefault(1))
                       .param(Field::boolean("paused", "Waits").byDefault(false))
                       .param(Field::number("delay_s", "Delay").byDefault(0))
                       .asyncHandler([this](const Call &call, const Reply &reply) { open(call, reply); }));
        addCommand(Command("source.pause", "Waits")
                       .param(Field::boolean("paused", "Waits"))
                       .handler([this](const Call &call) {
                           paused_ = call.flag("paused");
                           return obey(paused_ ? ": waits" : ": is released");
                       }));
        addCommand(Command("source.seek", "Seeks")
                       .param(Field::number("t_s", "Where").range(0, 1e7))
                       .handler([this](const Call &call) {
                           return obey(QString(": sought to %1").arg(call.number("t_s")));
                       }));
        addCommand(Command("source.speed", "Speed")
                       .param(Field::number("speed", "Speed"))
                       .handler([this](const Call &call) {
                           speed = call.number("speed");
                           return obey(QString(": goes at %1").arg(speed));
                       }));
        addCommand(Command("source.status", "Where it is").handler([this](const Call &) {
            if (source == "replay" && !paused_ && --positionsLeft_ <= 0)
                source = "ended";
            return QJsonObject{{"source", state()}};
        }));
    }
    /// As a replay does; NotReady at its end.
    Result<QJsonValue> obey(const QString &what) {
        if (source != "replay")
            return Error(ErrorCode::NotReady, "no replay is running");
        asked_.append(name_ + what);
        return state();
    }
    void open(const Call &call, const Reply &reply) {
        if (call.flag("live")) {
            asked_.append(name_ + ": live");
            source = "live";
            return reply.result(state());
        }
        const auto opened = [this, reply, call] {
            asked_.append(name_ + (call.flag("paused") ? ": opened, waits" : ": opened, runs"));
            if (!openError.isEmpty())
                return reply.error(Error(ErrorCode::InputOutput, openError));
            source = "replay";
            delay_s = call.number("delay_s");
            speed = call.number("speed");
            paused_ = call.flag("paused");
            positionsLeft_ = positionsToEnd;
            reply.result(state());
        };
        QTimer::singleShot(openDelay_ms, this, opened);
    }
    QJsonObject state() const {
        QJsonObject state{{"state", source}, {"position_s", 1}, {"duration_s", 2}, {"paused", paused_}};
        for (auto one = told.begin(); one != told.end(); ++one)
            state[one.key()] = one.value();
        return state;
    }

    const QString name_;
    QStringList &asked_;
    int positionsLeft_ = 0;
    bool paused_ = false;

public:
    TextWriter writer;
    Recording recording;
};

/// Loggers in the process of the test, and connections to them.
class FakeLoggers {
public:
    FakeLogger &add(const QString &name, bool replays) {
        loggers.push_back(std::make_unique<FakeLogger>(name, root.path(), asked, replays));
        clients.push_back(std::make_unique<Client>());
        if (!clients.back()->connectTo(loggers.back()->address()) || !clients.back()->waitConnected())
            qFatal("%s does not answer", qPrintable(name));
        return *loggers.back();
    }
    bool isRecording() const {
        return std::any_of(loggers.begin(), loggers.end(),
                           [](const auto &logger) { return logger->recording.isActive(); });
    }

    QTemporaryDir root;
    QStringList asked;
    std::vector<std::unique_ptr<FakeLogger>> loggers;
    std::vector<std::unique_ptr<Client>> clients;
};

} // namespace hermes
