#pragma once

#include <QString>

namespace hermes::ctl {

/// Whether somebody can be asked: stdin and stderr are terminals.
bool canAsk();

/// A line from stdin, asked for on stderr, in small letters without blanks around it. Where nothing can be
/// read any more it is "q".
QString answerTo(const QString &question);

/// Whether the answer is "y" or "yes"; all else is no.
bool isConfirmed(const QString &question);

} // namespace hermes::ctl
