#pragma once

#include "common/daemon/Daemon.h"
#include "protocol/messages/Sessions.h"
#include "protocol/wire/Fields.h"

#include <QtTest>

namespace hermes {

/// A recorder in the process of the test: does what it is asked for in words only, and tells its state when
/// that changes.
class FakeRecorder : public Daemon {
public:
    FakeRecorder()
        : Daemon({"recorder", "Recorder", "For tests"}) {
        addTopic(Topic("session", "What it does").carries<SessionState>().snapshot([this] {
            return Outgoing(state);
        }));
        addRecording();
        addReplay();
        addList();
        if (prepare({"recorder", "--listen", "tcp://127.0.0.1:0"}) || !launch())
            qFatal("the recorder does not start");
    }
    ~FakeRecorder() override { shutDown(); }

    QString address() { return server().addresses().value(0).section("//", -1).section('?', 0, 0); }
    void tell() { publish("session", state); }
    /// Answers what waits, and holds back no more.
    void letGo() {
        holds = false;
        for (const auto &work : std::exchange(held_, {}))
            work();
    }

    SessionState state = [] {
        SessionState idle;
        idle.state = "idle";
        return idle;
    }();
    std::vector<SessionSummary> sessions; ///< the latest first
    QStringList asked;                    ///< "METHOD {params}", without session.list
    QString refusal;                      ///< of all that is asked for, but the list
    bool holds = false;                   ///< answers wait

private:
    using Work = std::function<void(const Call &)>;

    void add(const QString &method, const std::vector<Field> &params, const Work &work,
             const std::function<QJsonValue()> &answer = {}) {
        Command command(method, "For tests");
        for (const Field &param : params)
            command.param(param);
        command.asyncHandler([=](const Call &call, const Reply &reply) {
            if (method != "session.list")
                asked.append(method + ' ' + QJsonDocument(call.params).toJson(QJsonDocument::Compact));
            const auto obey = [=] {
                if (!refusal.isEmpty() && method != "session.list")
                    return reply.error(Error(ErrorCode::NotReady, refusal));
                work(call);
                tell();
                reply.result(answer ? answer() : asJson(state));
            };
            holds ? held_.push_back(obey) : obey();
        });
        addCommand(command);
    }
    static Field name() { return Field::text("name", "Of the session"); }
    void addRecording() {
        add("session.start", {name().optional()}, [this](const Call &call) {
            state = {};
            state.state = "recording";
            state.name = call.has("name") ? call.text("name") : "2026-10-07_09-30-00";
            state.session = "id of " + state.name;
            state.start = 1.7e9 + 1000;
        });
        add("session.stop", {}, [this](const Call &) {
            state.state = "idle";
            sessions.insert(sessions.begin(), {state.name,
                                               state.session,
                                               state.start,
                                               state.start + state.duration_s,
                                               state.bytes,
                                               {"recorder"},
                                               state.problems,
                                               state.duration_s});
        });
        add("session.mark", {Field::text("text", "What")}, [this](const Call &call) {
            state.marks.push_back({state.duration_s, call.text("text")});
        });
    }
    void addReplay() {
        add("session.replay", {name()}, [this](const Call &call) {
            state.state = "replaying";
            state.name = call.text("name");
            state.replay = SessionReplay{0, 20, 1, false, false};
        });
        add("session.live", {}, [this](const Call &) {
            state.state = "idle";
            state.replay.reset();
        });
        add("session.seek", {Field::number("t_s", "Where")},
            [this](const Call &call) { state.replay->position_s = call.number("t_s"); });
        add("session.pause", {Field::boolean("paused", "Waits")},
            [this](const Call &call) { state.replay->paused = call.flag("paused"); });
        add("session.speed", {Field::number("speed", "How fast")},
            [this](const Call &call) { state.replay->speed = call.number("speed"); });
        add("session.loop", {Field::boolean("loop", "Begins anew")},
            [this](const Call &call) { state.replay->loop = call.flag("loop"); });
    }
    void addList() {
        const auto none = [](const Call &) {};
        add("session.list", {Field::integer("max", "So many")}, none, [this] {
            QJsonArray list;
            for (const SessionSummary &one : sessions)
                list.append(asJson(one));
            return list;
        });
        add("session.rename", {name(), Field::text("to", "Its new name")}, [this](const Call &call) {
            for (SessionSummary &one : sessions)
                if (one.name == call.text("name"))
                    one.name = call.text("to");
        });
        add("session.remove", {name(), Field::boolean("confirm", "Meant")}, [this](const Call &call) {
            sessions.erase(std::remove_if(sessions.begin(), sessions.end(),
                                          [&](const auto &one) { return one.name == call.text("name"); }),
                           sessions.end());
        });
        add("session.explain", {name()}, none, [] {
            return QJsonObject{{"text", "12.34 s: motor.estop by anna\n<b>and no more</b>"}};
        });
    }

    std::vector<std::function<void()>> held_;
};

} // namespace hermes
