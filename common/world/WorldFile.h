#pragma once

#include "common/world/World.h"

#include <optional>

namespace hermes {

/// Reads a world from JSON: {"name", "edges": [[x1,y1,x2,y2], ...], "poses": [[x,y,theta], ...]}; poses and
/// name may be absent, anything else is refused. On failure nothing is returned and error says file, line,
/// what was found and what was expected.
std::optional<World> readWorld(const std::string &path, std::string &error);

/// The same from text; path only names it in messages.
std::optional<World> parseWorld(const std::string &text, const std::string &path, std::string &error);

} // namespace hermes
