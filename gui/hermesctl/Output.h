#pragma once

#include "common/Result.h"

#include <QEventLoop>
#include <QJsonValue>
#include <QString>

namespace hermes::ctl {

/// Lets what is printed go to a file instead of stdout, made with the first line. Error: it exists, and force
/// is off.
Result<void> setOutput(const QString &file, bool force);

/// Prints a line at once. Ends the program with status 1, and says why, when it cannot be written; a reader
/// that has gone (a pipe that was closed) is no failure, see readerIsGone().
void printLine(const QString &text);

/// One value as one line.
void printJson(const QJsonValue &value);

/// Checks what was printed by other means.
void checkOutput();

/// Nobody reads stdout any more: a stream ends.
bool readerIsGone();

/// Anybody on the network may announce anything: nothing that a terminal would take for more than text.
QString printable(QString text);

/// Notes are JSON objects {"note": TEXT} from now on, one a line.
void setJsonNotes(bool on);

/// A line on stderr that is no failure.
void note(const QString &text);

/// Runs the loop until it is quit, or a signal asks for the end, or nobody reads stdout any more.
void runStream(QEventLoop &loop);

} // namespace hermes::ctl
