#pragma once

#include <QObject>

namespace hermes {

/// The orderly end of a connection: says that nothing more will come, and takes what the peer still sends
/// for a second at most. A socket that is closed with bytes unread resets the connection instead, and the
/// peer loses what it was told last. Of servers, so that Windows has none: there nothing is said.
/// descriptor stays the caller's. Does nothing when too many connections are ending.
void sayFarewell(int descriptor, QObject *parent);

} // namespace hermes
