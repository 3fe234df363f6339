#include "common/daemon/CommandRegistry.h"

namespace hermes {

void CommandRegistry::add(const Command &command) {
    commands_.insert(command.name(), command);
    urgentNames_.removeAll(command.name());
    if (command.isUrgent())
        urgentNames_.append(command.name());
}

const Command *CommandRegistry::find(const QString &name) const {
    const auto found = commands_.constFind(name);
    return found == commands_.constEnd() ? nullptr : &*found;
}

void CommandRegistry::execute(const RpcRequest &request, const Call &call, const Reply &reply) const {
    const auto found = commands_.constFind(request.method);
    if (found != commands_.constEnd())
        return found->execute(request.params, call, reply);
    const QString group = request.method.section(QLatin1Char('.'), 0, 0) + QLatin1Char('.');
    QStringList near;
    for (const QString &name : commands_.keys()) {
        if (name.startsWith(group))
            near.append(name);
    }
    const QString hint = near.isEmpty() ? "rpc.discover lists what there is" : "there is " + near.join(", ");
    reply.error(Error(ErrorCode::MethodNotFound,
                      QString("method \"%1\" not found; %2").arg(request.method.left(80), hint)));
}

QJsonArray CommandRegistry::description() const {
    QJsonArray methods;
    for (const Command &command : commands_)
        if (command.isListed())
            methods.append(command.description());
    return methods;
}

} // namespace hermes
