#pragma once

namespace hermes {

enum class StandardStream { Input, Output, Errors };

/// Whether a person sits at its other end.
bool isTerminal(StandardStream stream);

/// How many characters a line of stdout may have: $COLUMNS, else what the terminal tells, else 80.
int terminalWidth();

/// To be called first in main(): the standard streams carry bytes as they are, and a terminal takes them for
/// UTF-8 and obeys their escape sequences. Nothing to do but on Windows.
void prepareConsole();

} // namespace hermes
