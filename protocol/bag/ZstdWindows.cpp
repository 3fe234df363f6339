#include "protocol/bag/Zstd.h"

namespace hermes::bag {

// Debian has no zstd for MinGW.
static const char *const refusal =
    "found bytes that zstd has packed, expected others: programs for Windows cannot unpack them";

bool isZstd(std::string_view begin) {
    return begin.substr(0, 4) == "\x28\xB5\x2F\xFD";
}

std::string unpackMessage(std::string_view, std::string &) {
    return refusal;
}

mcap::Outcome<UnpackedFile> UnpackedFile::of(const std::string &path) {
    return path + ": " + refusal;
}

UnpackedFile::~UnpackedFile() = default;

} // namespace hermes::bag
