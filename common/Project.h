#pragma once

#include <QString>

namespace hermes {

/// The version of the project, e.g. "0.1.0".
QString projectVersion();

/// The version of the command protocol that daemons speak.
QString protocolVersion();

/// The port on which a daemon of that name listens unless set otherwise; 0 for an unknown name.
quint16 defaultPort(const QString &daemonName);

/// The names that defaultPort knows, in the order of their ports.
QStringList daemonNames();

} // namespace hermes
