#pragma once

#include "protocol/bag/Reader.h"

namespace hermes::bag {

/// A recording in MCAP, of ROS 1, ROS 2 or another writer. Messages may be packed by zstd one by one.
Outcome<std::unique_ptr<Reader>> openMcap(const std::string &path);

} // namespace hermes::bag
