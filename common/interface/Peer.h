#pragma once

#include <optional>

namespace hermes {

/// Who is at the other end of an interface, as far as the system tells.
struct Peer {
    enum class Place {
        Elsewhere, ///< of a network or a line
        Computer,  ///< a program of this computer, over its network stack
        UnixSocket ///< the same, over a socket that web pages cannot reach
    };
    Place place = Place::Elsewhere;
    std::optional<unsigned> user; ///< of that program, where the system knows
};

} // namespace hermes
