#pragma once

#include "protocol/mcap/Contents.h"
#include "vectorlib/error/Result.h"

#include <fstream>

namespace hermes::mcap {

template <typename T>
using Outcome = vectorlib::Result<T, std::string>;

/// A file, read at any place. It notes what could not be read.
class File {
public:
    /// Fails when it is no regular file. path: in UTF-8.
    static Outcome<File> open(const std::string &path);

    /// false: not all of it is there, or it cannot be read.
    bool read(std::uint64_t offset, std::uint64_t size, std::string &to);
    /// Reads and unpacks the records of a chunk by its offset and bytes; what its head tells is put into it.
    /// false: it cannot be read, which is noted.
    bool load(Chunk &chunk, std::string &records);
    std::uint64_t size() const { return size_; }
    const std::string &path() const { return path_; }

    /// Gives false.
    bool note(std::uint64_t offset, const std::string &problem);
    /// The first that was noted, and how much more; what is noted again counts once. Empty: nothing.
    std::string problem() const;

private:
    std::string path_;
    std::uint64_t size_ = 0;
    std::ifstream stream_;
    std::string first_, last_; ///< problems
    std::uint64_t problems_ = 0;
};

} // namespace hermes::mcap
