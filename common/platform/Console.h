#pragma once

namespace hermes {

enum class StandardStream { Input, Output, Errors };

/// Whether a person sits at its other end.
bool isTerminal(StandardStream stream);

/// How many characters a line of stdout may have: $COLUMNS, else what the terminal tells, else 80.
int terminalWidth();

/// To be called first in main(). On Windows the standard streams carry bytes as they are then, and a terminal
/// takes them for UTF-8 and obeys their escape sequences. Elsewhere a closed stderr leads nowhere then: what
/// is written to it would go into the next file that is opened.
void prepareConsole();

} // namespace hermes
