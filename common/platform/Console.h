#pragma once

namespace hermes {

enum class StandardStream { Input, Output, Errors };

/// Whether a person sits at its other end.
bool isTerminal(StandardStream stream);

/// To be called first in main(): the standard streams carry bytes as they are, and a terminal takes them for
/// UTF-8 and obeys their escape sequences. Nothing to do but on Windows.
void prepareConsole();

} // namespace hermes
