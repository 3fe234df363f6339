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

/// Starts a simulated robot with its daemons at their usual ports; it has ended when it is back.
Result<void> simulate(const Arguments &arguments);
/// Error: a kind of drive that cannot be simulated.
Result<void> checkSimulate(const Arguments &arguments);
/// Kinds of drive that a simulated robot with this base can have.
QStringList kinematicsOf(const QString &base);

Result<void> stopRobots(const Arguments &arguments);
Result<void> emergencyStopRobots(const Arguments &arguments);

/// Keys for TLS, in the folder of this user: docs/security.md.
Result<void> keysInit(const Arguments &arguments);
Result<void> keysRos(const Arguments &arguments);
/// Error: --role is none that a certificate can have.
Result<void> checkKeyRole(const Arguments &arguments);
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
/// Has the recorder, which is the first word, do what the second word of the command says, and tells what
/// came of it. Error also: what is missing of a session. A replay is shown until its end or a signal, which
/// ends it.
Result<void> session(Client &recorder, const Arguments &arguments);
/// The reference of all daemons on one page.
Result<void> documentAll(const Arguments &arguments);
/// Prints a topic until the count is reached, as one JSON object a line or as CSV.
Result<void> watch(Client &client, const Arguments &arguments);

/// Drives a robot with a velocity, or by keys, while it runs; the robot stands when it is back. Error also:
/// it has not confirmed that it stands.
Result<void> drive(Client &client, const Arguments &arguments);
/// Error: no velocity, and no terminal for keys.
Result<void> checkDrive(const Arguments &arguments);
/// Tries what a robot base or a laser scanner of another maker has to do, and tells what does not hold.
Result<void> conformMotor(Client &client, const Arguments &arguments);
Result<void> conformScanner(Client &client, const Arguments &arguments);
/// "vx", "vy", "omega".
const QStringList &velocityNames();

/// For programs (--json) a value as one line, for people a text.
void print(const Arguments &arguments, const QJsonValue &value, const QString &text);

/// Calls and waits: as long as the daemon answers other requests, or for the time-out of the command line.
Result<QJsonValue> ask(Client &client, const Arguments &arguments, const QString &method,
                       const QJsonValue &params = QJsonObject(),
                       Client::Repeats repeats = Client::Repeats::Usual);

/// The same; a refusal may tell when the same is taken, which is waited for, or that a person has to confirm,
/// who is asked.
Result<QJsonValue> askAgain(Client &client, const Arguments &arguments, const QString &method,
                            QJsonObject params);

} // namespace hermes::ctl
