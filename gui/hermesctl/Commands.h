#pragma once

#include "gui/hermesctl/Arguments.h"
#include "gui/hermesctl/Connection.h"
#include "gui/hermesctl/Output.h"

namespace hermes::ctl {

/// A command of hermesctl that speaks to one daemon: prints its result.
using DaemonCommand = Result<void> (*)(Client &client, const Arguments &arguments);

/// One that speaks to all of a robot, or to nobody.
using RobotCommand = Result<void> (*)(const Arguments &arguments);

/// The daemons that answer at their default ports on a host, one a line: name, state, version, address.
Result<void> listDaemons(const Arguments &arguments);

/// Finds what is plugged in, through the supervisor, and writes the settings for it.
Result<void> setUp(const Arguments &arguments);

Result<void> stopRobots(const Arguments &arguments);
Result<void> emergencyStopRobots(const Arguments &arguments);

/// All loggers begin one session, or none does and the error tells what was taken back.
Result<void> recordStart(const Arguments &arguments);
/// Error: what is missing or does not agree.
Result<void> recordStop(const Arguments &arguments);
/// A text into the recordings of all loggers that have marks.
Result<void> recordMark(const Arguments &arguments);
Result<void> recordStatus(const Arguments &arguments);
Result<void> recordList(const Arguments &arguments);
/// All loggers of a session replay it, until its end or SIGINT; then they are live again.
Result<void> replay(const Arguments &arguments);
/// Keys for TLS, in the folder of this user: docs/security.md.
Result<void> keysInit(const Arguments &arguments);
Result<void> keysIssue(const Arguments &arguments);
Result<void> keysRevoke(const Arguments &arguments);
Result<void> keysList(const Arguments &arguments);
/// Shows a code, and gives new keys to the one computer that proves it.
Result<void> keysPair(const Arguments &arguments);
/// Gets the keys of this user from a computer that waits for the code.
Result<void> keysJoin(const Arguments &arguments);
/// Prints the script that completes command lines in a shell.
Result<void> completion(const Arguments &arguments);

Result<void> discover(Client &client, const Arguments &arguments);
Result<void> call(Client &client, const Arguments &arguments);
Result<void> getSettings(Client &client, const Arguments &arguments);
Result<void> setSettings(Client &client, const Arguments &arguments);
Result<void> showLog(Client &client, const Arguments &arguments);
Result<void> document(Client &client, const Arguments &arguments);
/// The reference of all daemons on one page.
Result<void> documentAll(const Arguments &arguments);
/// Prints a topic until the count is reached, as one JSON object a line or as CSV.
Result<void> watch(Client &client, const Arguments &arguments);

/// Drives a robot with a velocity, or by keys, while it runs; the robot stands when it is back. Error also:
/// it has not confirmed that it stands.
Result<void> drive(Client &client, const Arguments &arguments);
/// Error: no velocity, and no terminal for keys.
Result<void> checkDrive(const Arguments &arguments);

/// Calls and waits: as long as the daemon answers other requests, or for the time-out of the command line.
Result<QJsonValue> ask(Client &client, const Arguments &arguments, const QString &method,
                       const QJsonValue &params = QJsonObject(),
                       Client::Repeats repeats = Client::Repeats::Usual);

} // namespace hermes::ctl
