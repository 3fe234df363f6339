#pragma once

#include <string>
#include <string_view>

namespace hermes::mcap {

/// Unpacks what zstd packed, to as many bytes as `to` has, or fewer. Gives why that fails; empty: it is done.
std::string unpackZstd(std::string_view packed, std::string &to);
/// The same of one or more frames of lz4. Always fails where the program was built without liblz4.
std::string unpackLz4(std::string_view packed, std::string &to);

} // namespace hermes::mcap
