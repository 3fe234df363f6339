#pragma once

#include <QtGlobal>

namespace hermes {

/// Of the file descriptors that the system allows, clients leave so many to files and devices.
constexpr int spareDescriptors = 12;

/// Raises what the system allows by default, as far as it lets, so that a server of so many clients has
/// enough.
void raiseDescriptorLimit(int clients);

/// How many this process may still open, about.
int descriptorsLeft();

/// The same, when this one was opened last: the system gives the smallest number that is free.
int descriptorsLeftAfter(qintptr descriptor);

} // namespace hermes
