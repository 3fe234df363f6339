#pragma once

#include "common/capture/Datagram.h"

#include <array>
#include <string>

namespace hermes {

/// What the link layer of a capture is, as far as it is understood. The values are those of tcpdump.org's
/// registry, and those that systems give raw IP.
enum class LinkType : int {
    Null = 0, ///< BSD loopback
    Ethernet = 1,
    RawLinux = 12,
    RawOpenBsd = 14,
    Raw = 101,
    Loop = 108, ///< OpenBSD loopback
    LinuxCooked = 113,
    Ipv4 = 228,
    LinuxCooked2 = 276,
};

/// Why a frame gives no datagram.
enum class FrameFault {
    None,
    NotUdp,   ///< another protocol, IPv6 included: nothing to do with us
    Fragment, ///< a part of a fragmented datagram
    Short,    ///< cut, or lengths that contradict each other
};

bool isKnownLinkType(int linkType);
/// All of them by name and number, for messages.
std::string knownLinkTypes();

/// Finds the datagram in a frame; its payload points into the frame. 802.1Q and 802.1ad tags, and those that
/// came before the standard, are stepped over. The UDP length and the captured length count: the position
/// packets of real sensors carry a wrong total length of IPv4.
FrameFault parseFrame(LinkType link, const std::uint8_t *frame, std::size_t size, Datagram &datagram);

constexpr std::size_t frameHeaderSize = 42;   ///< Ethernet 14, IPv4 20, UDP 8
constexpr std::size_t maximumPayload = 65507; ///< what UDP over IPv4 can carry

/// Ethernet, IPv4 and UDP headers of the datagram, with a true checksum of the IPv4 header and none of UDP.
/// Link addresses are made up: broadcast, from a locally administered address.
std::array<std::uint8_t, frameHeaderSize> makeFrameHeader(const Datagram &datagram);

} // namespace hermes
