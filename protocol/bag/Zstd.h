#pragma once

#include "protocol/mcap/File.h"

#include <string>
#include <string_view>

namespace hermes::bag {

/// Whether bytes begin as zstd packs them.
bool isZstd(std::string_view begin);

/// A message that was packed alone. Gives why that fails; empty: it is done.
std::string unpackMessage(std::string_view packed, std::string &to);

/// A file that was packed as a whole, in a file of its own without its name's last extension. It goes when
/// this does.
class UnpackedFile {
public:
    /// Fails where it is damaged, or much larger than any that was packed so.
    static mcap::Outcome<UnpackedFile> of(const std::string &path);
    UnpackedFile(UnpackedFile &&other) noexcept
        : path_(std::move(other.path_)) {
        other.path_.clear();
    }
    UnpackedFile(const UnpackedFile &) = delete;
    ~UnpackedFile();

    const std::string &path() const { return path_; }

private:
    explicit UnpackedFile(std::string path)
        : path_(std::move(path)) {}

    std::string path_;
};

} // namespace hermes::bag
