#pragma once

#include "protocol/mcap/Records.h"
#include "vectorlib/error/Result.h"

#include <fstream>
#include <memory>

namespace hermes::mcap {

template <typename T>
using Outcome = vectorlib::Result<T, std::string>;

/// A file, read at any place.
class File {
public:
    /// Fails when it is no regular file. path: in UTF-8.
    static Outcome<std::unique_ptr<File>> open(const std::string &path);

    /// false: not all of it is there, or it cannot be read.
    bool read(std::uint64_t offset, std::uint64_t size, std::string &to);
    std::uint64_t size() const { return size_; }
    const std::string &path() const { return path_; }

private:
    std::string path_;
    std::uint64_t size_ = 0;
    std::ifstream stream_;
};

/// What could not be read of a file: the first of it, and how much more. What is told again counts once.
class Problems {
public:
    void add(std::uint64_t offset, const std::string &what);
    std::string text() const;

private:
    std::string first_, last_;
    std::uint64_t count_ = 0;
};

/// Reads and unpacks the records of a chunk by its offset and bytes; what its head tells is put into it.
Outcome<void> loadChunk(File &file, Chunk &chunk, std::string &records);

} // namespace hermes::mcap
