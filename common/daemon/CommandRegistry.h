#pragma once

#include "common/daemon/Command.h"
#include "protocol/jsonrpc/JsonRpc.h"

#include <QMap>
#include <QStringList>

namespace hermes {

/// The commands of a daemon, by name.
class CommandRegistry {
public:
    /// A second command of the same name replaces the first.
    void add(const Command &command);
    const Command *find(const QString &name) const;
    /// The names of the urgent ones.
    const QStringList &urgent() const { return urgentNames_; }

    /// Runs what the request asks for. An unknown method is an error that names the nearest known ones.
    void execute(const RpcRequest &request, const Call &call, const Reply &reply) const;

    /// The method objects of an OpenRPC document, ordered by name, of those that are listed.
    QJsonArray description() const;

private:
    QMap<QString, Command> commands_;
    QStringList urgentNames_;
};

} // namespace hermes
