#pragma once

#include <filesystem>

namespace hermes {

/// Whether the system takes two absolute paths for the same: on Windows whatever the case of their letters.
bool isSameName(const std::filesystem::path &one, const std::filesystem::path &other);

/// Whether it is a device by its name alone, in whatever folder: NUL and the like of Windows.
bool isDeviceName(const std::filesystem::path &path);

} // namespace hermes
