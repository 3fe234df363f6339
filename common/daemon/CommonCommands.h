#pragma once

namespace hermes {

class CommandRegistry;
class Daemon;
class TopicHub;

/// Adds the commands and topics that every daemon has (docs/protocol.md).
void addCommonCommands(Daemon &daemon, CommandRegistry &commands, TopicHub &topics);

} // namespace hermes
