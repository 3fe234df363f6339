#pragma once

#include "common/Result.h"
#include "common/interface/Interface.h"
#include "common/interface/InterfaceUrl.h"

#include <QStringList>

namespace hermes {

class Listener;

/// The interface for a URL, closed, to be opened as a client. Error when the scheme is unknown or something
/// it needs is missing.
Result<Interface *> makeInterface(const InterfaceUrl &url, QObject *parent);

/// The listener for a URL, not yet listening.
Result<Listener *> makeListener(const InterfaceUrl &url, QObject *parent);

/// Whether others on the network can reach what listens there.
bool isReachable(const InterfaceUrl &url);

/// Whether strangers on the network can command what listens there: they reach it, and need no certificate.
bool isOpenToNetwork(const InterfaceUrl &url);

QStringList interfaceSchemes();

} // namespace hermes
