#pragma once

#include "protocol/mcap/File.h"

namespace hermes::mcap {

/// What a file has, and where its end was lost.
struct Found {
    Contents contents;
    bool whole = false;    ///< it ended in order; the rest is of a file that did not
    std::uint64_t cut = 0; ///< where the last whole record ends, but for the indexes of the last chunk
    std::string indexes;   ///< these, when they are not all there
};

/// Reads the summary, or record by record where there is none that can be read. Fails when the file is none
/// of MCAP.
Outcome<Found> readContents(File &file, Problems &problems);

} // namespace hermes::mcap
