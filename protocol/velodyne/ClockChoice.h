#pragma once

#include <string_view>

namespace hermes::velodyne {

/// Whose clock tells when a sensor measured: the sensor's, which a GPS sets; the receiver's; or the sensor's
/// once a GPS has set it, and the receiver's until then.
enum class ClockChoice { Gps, Host, Auto };

/// Of "gps" and "host"; Auto for all else.
inline ClockChoice clockChoiceFromText(std::string_view text) {
    return text == "gps" ? ClockChoice::Gps : text == "host" ? ClockChoice::Host : ClockChoice::Auto;
}

} // namespace hermes::velodyne
