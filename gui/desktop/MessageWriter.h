#pragma once

#include <QString>

namespace hermes::desktop {

/// While it lives, what Qt and the window have to say on stderr is written in a thread of its own: a terminal
/// whose output is held (Ctrl+S), or a pipe that nobody reads, holds up no event loop, and so no STOP. What
/// waits is 1000 lines at most; the rest is counted. Its end waits 0.2 s for what is left.
class MessageWriter {
public:
    MessageWriter();
    ~MessageWriter();

    MessageWriter(const MessageWriter &) = delete;
    MessageWriter &operator=(const MessageWriter &) = delete;
};

} // namespace hermes::desktop
