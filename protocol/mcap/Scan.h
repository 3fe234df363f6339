#pragma once

#include "protocol/mcap/File.h"

namespace hermes::mcap {

/// What a file has, and what its end lacks where it was cut off.
struct Found {
    Contents contents;
    bool whole = false;      ///< it ended in order
    std::uint64_t bytes = 0; ///< of the file; of one that was cut off: up to its last whole record
    std::string missing;     ///< there, before the end: the header, or the indexes of the last chunk
    std::string problem;     ///< what could not be read; empty: nothing
};

/// Reads the summary, or record by record where there is none that can be read. Fails when the file is none
/// of MCAP.
Outcome<Found> readContents(File &file);

/// Cuts a file that was cut off back to its last whole chunk and writes the end that is missing; where not
/// even its header was whole it becomes one without messages. A file that ended in order stays as it is.
/// Whenever it is interrupted, it can be called again. Not for a file that is still written. Gives what it
/// found, and the bytes that the file has now.
Outcome<Found> repair(const std::string &path);

} // namespace hermes::mcap
