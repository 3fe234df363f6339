#pragma once

#include "common/Outcome.h"
#include "common/world/World.h"

namespace hermes {

/// Reads a world from JSON: {"name", "edges": [[x1,y1,x2,y2], ...], "poses": [[x,y,theta], ...], "people":
/// [[speed,x1,y1,x2,y2, ...], ...]}; all but edges may be absent, anything else is refused.
Outcome<World> readWorld(const std::string &path);

/// The same from text; path only names it in messages.
Outcome<World> parseWorld(const std::string &text, const std::string &path);

} // namespace hermes
