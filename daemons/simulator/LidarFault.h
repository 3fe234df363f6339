#pragma once

#include <random>

namespace hermes::simulator {

/// What the simulated sensor does wrong.
struct LidarFault {
    enum class Kind { None, Silence, Loss };

    Kind kind = Kind::None;
    double share = 0; ///< of the packets that a Loss drops, 0 to 1

    /// Whether the next packet is not sent.
    template <typename Random>
    bool swallows(Random &random) const {
        if (kind == Kind::Loss)
            return std::uniform_real_distribution<double>()(random) < share;
        return kind == Kind::Silence;
    }
};

} // namespace hermes::simulator
