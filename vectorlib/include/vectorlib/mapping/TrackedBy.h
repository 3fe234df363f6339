#pragma once

namespace vectorlib {

/// What tells how a scan lies to the one before.
enum class TrackedBy {
    Map,  ///< it was found in the map where it was well expected
    Scan, ///< a scan before it, as the map did not show it or had lost the one before; a guess where neither
          ///< does
    Odometry, ///< that alone: it was lost
    Nothing,  ///< a guess, or found in the map where it was guessed
    Placed    ///< the sensor was put there, by a person or a search: the way between is not known
};

} // namespace vectorlib
