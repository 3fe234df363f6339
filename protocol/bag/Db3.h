#pragma once

#include "protocol/bag/Reader.h"

namespace hermes::bag {

/// A database of a bag of ROS 2 (rosbag2_storage_sqlite3): the tables topics and messages. Messages may be
/// packed by zstd one by one. Memory: numbers of 24 bytes a message at most, which SQLite may put into a
/// file, and the message itself. Fails where the program was built without SQLite, or the tables are not
/// those.
Outcome<std::unique_ptr<Reader>> openDb3(const std::string &path);

} // namespace hermes::bag
