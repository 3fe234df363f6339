#pragma once

#include <QString>

namespace hermes::ctl {

/// What may stand at the end of a command line, one candidate a line: TEXT, a tab, what it is. Asks the
/// daemon that the line names, for a second at most; silent when it does not run. A TEXT that ends in "=" is
/// to be gone on with; ":files" stands for the names of files. line: from the program's name to the cursor.
int printCandidates(const QString &line);

} // namespace hermes::ctl
