#pragma once

#include "common/Result.h"

#include <QEventLoop>
#include <QJsonValue>
#include <QStringList>
#include <vector>

namespace hermes::ctl {

/// Lets what is printed go to a file instead of stdout, made with the first line. Error: it exists, and force
/// is off.
Result<void> setOutput(const QString &file, bool force);

/// Prints a line at once. Ends the program with status 1, and says why, when it cannot be written; a reader
/// that has gone (a pipe that was closed) is no failure, see readerIsGone().
void printLine(const QString &text);

/// One value as one line.
void printJson(const QJsonValue &value);

/// Rows with columns below each other; the first row is the heading.
void printTable(const std::vector<QStringList> &rows);

/// Checks what was printed.
void checkOutput();

/// Nobody reads stdout any more: a stream ends.
bool readerIsGone();

/// What is not of this program (a daemon's answer, the name of a file or of a client) may hold anything.
/// Control and format characters, with which a terminal is commanded, are escaped (\u001b), so that JSON
/// stays the same. All that is printed by functions of this file passes here; lines and tabs stay unless
/// isOneLine.
QString printable(const QString &text, bool isOneLine = true);

/// Prints to stderr as it is, without a line feed.
void printError(const QString &text);

/// Notes are JSON objects {"note": TEXT} from now on, one a line.
void setJsonNotes(bool on);

/// A line on stderr that is no failure.
void note(const QString &text);

/// Runs the loop until it is quit, or a signal asks for the end, or nobody reads stdout any more.
void runStream(QEventLoop &loop);

} // namespace hermes::ctl
