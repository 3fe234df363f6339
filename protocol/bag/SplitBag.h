#pragma once

#include "protocol/bag/Reader.h"

namespace hermes::bag {

/// Whether the folder is a bag of ROS 2: it has a metadata.yaml of one, or databases.
bool isBagFolder(const std::string &folder);

/// The files of a bag of ROS 2 as one. Fails where none can be read; files that cannot are told.
Outcome<std::unique_ptr<Reader>> openFolder(const std::string &folder);

} // namespace hermes::bag
