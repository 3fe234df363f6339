#pragma once

#include "common/daemon/Command.h"
#include "protocol/jsonrpc/JsonRpc.h"

#include <QMap>

namespace hermes {

/// The commands of a daemon, by name.
class CommandRegistry {
public:
    /// A second command of the same name replaces the first.
    void add(const Command &command) { commands.insert(command.name(), command); }

    /// Runs what the request asks for. An unknown method is an error that names the nearest known ones.
    void execute(const RpcRequest &request, const Call &call, const Reply &reply) const;

    /// The method objects of an OpenRPC document, ordered by name.
    QJsonArray description() const;

private:
    QMap<QString, Command> commands;
};

} // namespace hermes
