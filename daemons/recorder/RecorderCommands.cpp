// What the recorder offers: its settings and commands.
#include "common/client/DaemonAddress.h"
#include "common/recording/DiskError.h"
#include "common/settings/SettingsTable.h"
#include "daemons/recorder/Recorder.h"
#include "daemons/recorder/SessionExport.h"
#include "daemons/recorder/SessionFiles.h"
#include "daemons/recorder/SessionReport.h"
#include "protocol/wire/Fields.h"

namespace hermes::recorder {
namespace {

Field nameField(const char *description) {
    return Field::text("name", description).with("maxLength", 200);
}

QStringList textsOf(const QJsonValue &list) {
    return list.toVariant().toStringList();
}

SessionControl::Done<SessionState> answer(const Reply &reply) {
    return [reply](const Result<SessionState> &state) { reply.give(state); };
}

} // namespace

void Recorder::declareSettings() {
    SettingsTable table;
    table.group("Robot");
    table
        .defineList("daemons",
                    "The daemons of the robot, by name, HOST:PORT or URL; none: those at the default "
                    "ports of this host. Those that a supervisor among them starts are known, too",
                    {{"type", "string"}})
        .with("maxItems", 100);
    table.group("Recording");
    table.define("record.ring_s", 0.0,
                 "How much of all topics is kept without a session, and becomes one "
                 "when the robot stops or something fails; 0: nothing",
                 "s", 0, 600);
    table.group("Recording", SettingsTable::Applies::OnRestart);
    table.define("record.queue_bytes", 64 << 20, "Bytes of topics that may wait for the disk", "byte",
                 1 << 20, 1 << 30);
    table.declareIn(settings());
    addSetting(topicRulesField());
    settings().addRule([](const QJsonObject &values) {
        std::vector<SchemaViolation> wrong;
        const QJsonArray daemons = values["daemons"].toArray();
        for (int i = 0; i < daemons.size(); ++i)
            if (const Result<QString> address = daemonAddress(daemons[i].toString());
                !address || !checkAddress(*address))
                wrong.push_back(
                    {QString("daemons.%1").arg(i), daemons[i], "the name of a daemon, HOST:PORT or a URL"});
        return wrong;
    });
}

void Recorder::declareCommands() {
    addCommand(Command("session.start", "All loggers of the robot, and the recorder itself, record one "
                                        "session; all begin, or none does")
                   .param(nameField("Of the session: of its folder; without it the date and time").optional())
                   .param(Field::array("what", "The loggers that take part, by name; without it all",
                                       {{"type", "string"}})
                              .optional())
                   .gives<SessionState>()
                   .asyncHandler([this](const Call &call, const Reply &reply) {
                       session_.start(call.text("name"), textsOf(call.value("what")), answer(reply));
                   }));
    addCommand(Command("session.stop", "Ends the session; everything is on the disk when this returns, and "
                                       "problems tells what is missing")
                   .gives<SessionState>()
                   .asyncHandler([this](const Call &, const Reply &reply) { session_.stop(answer(reply)); }));
    addCommand(Command("session.mark", "Puts a text with the time into the session")
                   .param(Field::text("text", "What to remember").with("maxLength", 1000))
                   .example({{"text", "at the door"}}, QJsonObject{{"t_s", 12.5}, {"text", "at the door"}})
                   .answers([this](const Call &call) { return mark(call.text("text")); }));
    addCommand(Command("session.state", "What the topic session says, now")
                   .needs(Role::Observer)
                   .answers([this](const Call &) { return session_.state(); }));
    addCommand(Command("session.list", "The sessions that the loggers have, the latest first")
                   .needs(Role::Observer)
                   .param(Field::integer("max", "How many; 0: all").range(0, 1e6).byDefault(0))
                   .gives<std::vector<SessionSummary>>()
                   .asyncHandler([this](const Call &call, const Reply &reply) {
                       const auto take = [reply, max = call.integer("max")](const SessionList &list) {
                           std::vector<SessionSummary> summaries;
                           for (const RecordedSession &session : list.sessions)
                               if (max == 0 || int(summaries.size()) < max)
                                   summaries.push_back(session.summary());
                           reply.result(asJson(summaries));
                       };
                       session_.list(take);
                   }));
    addCommand(Command("session.rename", "Gives a session another name")
                   .param(nameField("Its name"))
                   .param(Field::text("to", "The new one").with("maxLength", 200))
                   .gives<SessionSummary>()
                   .asyncHandler([this](const Call &call, const Reply &reply) {
                       const QString to = call.text("to");
                       if (const Result<void> fine = checkName("to", to); !fine)
                           return reply.error(fine.error());
                       change(call.text("name"), reply,
                              [to, root = settings().text("record.folder")](
                                  RecordedSession session) -> Result<QJsonValue> {
                                  if (const Result<void> done = renameSession(session, root, to); !done)
                                      return done.error();
                                  session.name = to;
                                  return asJson(session.summary());
                              });
                   }));
    addCommand(Command("session.remove", "Removes all that was recorded of a session")
                   .param(nameField("Its name"))
                   .param(Field::boolean("confirm", "True: it is meant").byDefault(false))
                   .with("x-destructive", true)
                   .returnsNull()
                   .asyncHandler([this](const Call &call, const Reply &reply) {
                       change(call.text("name"), reply,
                              [isMeant = call.flag("confirm"), root = settings().text("record.folder")](
                                  const RecordedSession &session) -> Result<QJsonValue> {
                                  if (!isMeant)
                                      return Error(
                                          ErrorCode::NotReady,
                                          QString("\"%1\": %2 MB of %3 would be removed; "
                                                  "confirm=true does it")
                                              .arg(session.name,
                                                   QString::number(session.summary().bytes * 1e-6, 'f', 1),
                                                   session.members().join(", ")),
                                          QJsonObject{{"confirm", true}});
                                  const Result<void> done = removeSession(session, root);
                                  return done ? Result<QJsonValue>(QJsonValue()) : done.error();
                              });
                   }));
}

void Recorder::change(const QString &name, const Reply &reply,
                      std::function<Result<QJsonValue>(const RecordedSession &)> work) {
    session_.find(name, [this, reply, work = std::move(work)](const Result<RecordedSession> &session) {
        if (!session)
            return reply.error(session.error());
        if (session->goesOn() || session_.isOf(*session))
            return reply.error(Error(ErrorCode::NotReady,
                                     QString("\"%1\" is being recorded or replayed").arg(session->name)));
        changes_.start(QRunnable::create([reply, work, session = *session] { reply.give(work(session)); }));
    });
}

void Recorder::study(QThreadPool &pool, const QString &name, const Reply &reply,
                     std::function<Result<QJsonValue>(SessionReader &)> work) {
    session_.find(name, [this, &pool, reply, work = std::move(work)](const Result<RecordedSession> &session) {
        if (!session)
            return reply.error(session.error());
        pool.start(QRunnable::create([this, reply, work, folder = session->folder()] {
            Result<SessionReader> reader = SessionReader::open(folder, &isEnding_);
            reply.give(reader ? work(*reader) : reader.error());
        }));
    });
}

void Recorder::declareStudies() {
    addCommand(Command("session.info", "What a session holds: parts, topics with their gaps, marks, the way "
                                       "driven, stops and faults")
                   .needs(Role::Operator)
                   .param(nameField("Its name"))
                   .gives<SessionInfo>()
                   .asyncHandler([this](const Call &call, const Reply &reply) {
                       study(work_, call.text("name"), reply,
                             [](SessionReader &session) -> Result<QJsonValue> {
                                 return asJson(sessionInfo(session));
                             });
                   }));
    addCommand(Command("session.explain", "A page of text about a moment of a session: who drove, what was "
                                          "commanded and measured, why the robot stopped, what was wrong")
                   .needs(Role::Engineer) // as the topic commands
                   .param(nameField("Of the session"))
                   .param(Field::number("at_s", "After its beginning; without it its last stop or fault")
                              .unit("s")
                              .range(0, 1e7)
                              .optional())
                   .gives<SessionText>()
                   .asyncHandler([this](const Call &call, const Reply &reply) {
                       const auto at_s =
                           call.has("at_s") ? std::optional(call.number("at_s")) : std::optional<double>();
                       study(work_, call.text("name"), reply,
                             [at_s](SessionReader &session) -> Result<QJsonValue> {
                                 const Result<QString> text = explainSession(session, at_s);
                                 return text ? Result<QJsonValue>(asJson(SessionText{*text})) : text.error();
                             });
                   }));
    addCommand(
        Command("session.export", "Writes a session for other tools into the folder export beside its files")
            .needs(Role::Engineer)
            .param(nameField("Its name"))
            .param(Field::text("format", "csv: a table of each topic; tum: poses; carmen: a log of lidar and "
                                         "odometry; mcap: all in one file; pcap: the packets of each lidar "
                                         "in one")
                       .choices({"csv", "tum", "carmen", "mcap", "pcap"}))
            .param(
                Field::text("profile", "Of mcap: ros2 makes it a bag of ROS 2, with what hermes-ros2 tells")
                    .choices({"", "ros2"})
                    .byDefault(""))
            .param(Field::array("topics",
                                "Which, as DAEMON/TOPIC; * stands for any text. Without it all, or "
                                "those of the format",
                                {{"type", "string"}})
                       .optional())
            .gives<SessionFiles>()
            .asyncHandler([this](const Call &call, const Reply &reply) {
                study(exports_, call.text("name"), reply,
                      [topics = textsOf(call.value("topics")), format = call.text("format"),
                       profile = call.text("profile"), floor = settings().number("record.free_floor_bytes")](
                          SessionReader &session) -> Result<QJsonValue> {
                          const Result<double> room = freeBytes(session.folder());
                          const double needed = floor + (format == "pcap" ? captureBytes(session.folder())
                                                                          : 10 * session.bytes());
                          if (room && *room < needed)
                              return diskError(QString("%1: %2 MB are free, %3 MB may be needed")
                                                   .arg(session.folder())
                                                   .arg(*room * 1e-6, 0, 'f', 0)
                                                   .arg(needed * 1e-6, 0, 'f', 0),
                                               session.folder());
                          const Result<SessionFiles> files =
                              exportSession(session, format, topics, session.folder() + "/export", profile);
                          return files ? Result<QJsonValue>(asJson(*files)) : files.error();
                      });
            }));
}

void Recorder::declareReplay() {
    const Field speed = Field::number("speed", "1: real time, 0: as fast as possible").range(0, 1000);
    addCommand(
        Command("session.replay", "Replays a session: each logger its part, and all topics at their own "
                                  "daemons, marked as replayed. Wheels never move by it")
            .param(nameField("Of the session"))
            .param(Field(speed).byDefault(1))
            .param(Field::number("from_s", "Of the session").unit("s").range(0, 1e7).byDefault(0))
            .param(Field::boolean("loop", "Begin anew at its end").byDefault(false))
            .param(Field::boolean("paused", "Begin paused").byDefault(false))
            .param(Field::array("without", "Daemons whose topics stay live: scanmatcher to match anew",
                                {{"type", "string"}})
                       .optional())
            .gives<SessionState>()
            .asyncHandler([this](const Call &call, const Reply &reply) {
                SessionPlayer::Options options;
                options.speed = call.number("speed");
                options.from_s = call.number("from_s");
                options.loop = call.flag("loop");
                options.paused = call.flag("paused");
                options.without = textsOf(call.value("without"));
                session_.replay(call.text("name"), options, [this, reply](const Result<SessionState> &state) {
                    state ? showMarks(state->name, reply) : reply.error(state.error());
                });
            }));
    addCommand(
        whileReplaying(Command("session.seek", "Lets the replay go on from another time")
                           .param(Field::number("t_s", "Of the session").unit("s").range(0, 1e7)),
                       [this](const Call &call) { return session_.player().seek(call.number("t_s")); }));
    addCommand(whileReplaying(Command("session.pause", "Pauses the replay, or lets it go on")
                                  .param(Field::boolean("paused", "Whether it waits").byDefault(true)),
                              [this](const Call &call) -> Result<void> {
                                  session_.player().setPaused(call.flag("paused"));
                                  return {};
                              }));
    addCommand(whileReplaying(
        Command("session.speed", "Makes the replay faster or slower").param(speed),
        [this](const Call &call) { return session_.player().setSpeed(call.number("speed")); }));
    addCommand(whileReplaying(Command("session.loop", "Whether the replay begins anew at its end")
                                  .param(Field::boolean("loop", "It does").byDefault(true)),
                              [this](const Call &call) -> Result<void> {
                                  session_.player().setLoop(call.flag("loop"));
                                  return {};
                              }));
    addCommand(Command("session.live", "Ends the replay; when this returns all show what is")
                   .gives<SessionState>()
                   .asyncHandler([this](const Call &, const Reply &reply) { session_.live(answer(reply)); }));
}

void Recorder::showMarks(const QString &name, const Reply &reply) {
    const Reply shown([this, reply](const Result<QJsonValue> &) { reply.result(asJson(session_.state())); });
    study(work_, name, shown, [this](SessionReader &session) -> Result<QJsonValue> {
        const auto show = [this, marks = sessionMarks(session)] { session_.setMarks(marks); };
        QMetaObject::invokeMethod(this, show, Qt::QueuedConnection);
        return QJsonValue();
    });
}

Command Recorder::whileReplaying(Command command, const std::function<Result<void>(const Call &)> &action) {
    return command.gives<SessionState>().handler([this, action](const Call &call) -> Result<QJsonValue> {
        if (!session_.isReplaying())
            return Error(ErrorCode::NotReady, "nothing is replayed; session.replay begins");
        const Result<void> done = action(call);
        return done ? Result<QJsonValue>(asJson(session_.state())) : done.error();
    });
}

void Recorder::declareOwnCommands() {
    for (const Command &command : recording_.commands())
        own_.add(command);
    own_.add(source_.openCommand("Replays topics"));
    for (const Command &command : source_.replayCommands())
        own_.add(command);
    own_.add(Command("source.status", "Of the replay").handler([this](const Call &) {
        return QJsonValue(QJsonObject{{"source", asJson(source_.status())}});
    }));
}

} // namespace hermes::recorder
