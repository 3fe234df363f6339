#pragma once

#include <string>
#include <string_view>

namespace hermes::bag {

/// Unpacks what bzip2 packed, to as many bytes as `to` has, or fewer. Gives why that fails; empty: it is
/// done. Always fails where the program was built without libbz2.
std::string unpackBzip2(std::string_view packed, std::string &to);

} // namespace hermes::bag
