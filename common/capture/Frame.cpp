#include "common/capture/Frame.h"

#include <algorithm>
#include <iterator>

namespace hermes {

namespace {

constexpr std::uint16_t etherTypeIpv4 = 0x0800;
constexpr std::uint16_t etherTypesVlan[] = {0x8100, 0x88A8, 0x9100, 0x9200,
                                            0x9300}; // the last of older switches
constexpr std::uint8_t protocolUdp = 17;

struct Link {
    LinkType type;
    const char *name;
};
constexpr Link knownLinks[] = {
    {LinkType::Null, "BSD loopback"},
    {LinkType::Ethernet, "Ethernet"},
    {LinkType::RawLinux, "raw IP"},
    {LinkType::RawOpenBsd, "raw IP"},
    {LinkType::Raw, "raw IP"},
    {LinkType::Loop, "OpenBSD loopback"},
    {LinkType::LinuxCooked, "Linux cooked"},
    {LinkType::Ipv4, "raw IPv4"},
    {LinkType::LinuxCooked2, "Linux cooked v2"},
};

std::uint16_t word(const std::uint8_t *bytes) {
    return std::uint16_t(bytes[0] << 8 | bytes[1]);
}

std::uint32_t longWord(const std::uint8_t *bytes) {
    return std::uint32_t(word(bytes)) << 16 | word(bytes + 2);
}

void setWord(std::uint8_t *bytes, std::uint16_t value) {
    bytes[0] = std::uint8_t(value >> 8);
    bytes[1] = std::uint8_t(value);
}

void setLongWord(std::uint8_t *bytes, std::uint32_t value) {
    setWord(bytes, std::uint16_t(value >> 16));
    setWord(bytes + 2, std::uint16_t(value));
}

/// Sets offset to where IPv4 begins.
FrameFault skipLink(LinkType link, const std::uint8_t *frame, std::size_t size, std::size_t &offset) {
    std::size_t typeAt = 0; // where the EtherType stands
    switch (link) {
    case LinkType::RawLinux:
    case LinkType::RawOpenBsd:
    case LinkType::Raw:
    case LinkType::Ipv4:
        offset = 0;
        return FrameFault::None;
    case LinkType::Null:
    case LinkType::Loop:
        // The address family, in the byte order of the capturing host or the network's; IPv4 shows by its
        // version below.
        offset = 4;
        return size < offset ? FrameFault::Short : FrameFault::None;
    case LinkType::Ethernet:
        typeAt = 12;
        offset = 14;
        break;
    case LinkType::LinuxCooked:
        typeAt = 14;
        offset = 16;
        break;
    case LinkType::LinuxCooked2:
        typeAt = 0;
        offset = 20;
        break;
    }
    if (size < offset)
        return FrameFault::Short;
    std::uint16_t type = word(frame + typeAt);
    while (std::find(std::begin(etherTypesVlan), std::end(etherTypesVlan), type) !=
           std::end(etherTypesVlan)) {
        if (size < offset + 4)
            return FrameFault::Short;
        type = word(frame + offset + 2);
        offset += 4;
    }
    return type == etherTypeIpv4 ? FrameFault::None : FrameFault::NotUdp;
}

std::uint16_t headerChecksum(const std::uint8_t *header) {
    std::uint32_t sum = 0;
    for (int i = 0; i < 20; i += 2)
        sum += word(header + i);
    sum = (sum & 0xFFFF) + (sum >> 16);
    sum = (sum & 0xFFFF) + (sum >> 16);
    return std::uint16_t(~sum);
}

} // namespace

bool isKnownLinkType(int linkType) {
    return std::any_of(std::begin(knownLinks), std::end(knownLinks),
                       [linkType](const Link &link) { return int(link.type) == linkType; });
}

std::string knownLinkTypes() {
    std::string text;
    for (const Link &link : knownLinks)
        text +=
            (text.empty() ? "" : ", ") + std::string(link.name) + " (" + std::to_string(int(link.type)) + ")";
    return text;
}

FrameFault parseFrame(LinkType link, const std::uint8_t *frame, std::size_t size, Datagram &datagram) {
    std::size_t offset = 0;
    const FrameFault fault = skipLink(link, frame, size, offset);
    if (fault != FrameFault::None)
        return fault;
    const std::uint8_t *ip = frame + offset;
    const std::size_t ipSize = size - offset;
    if (ipSize < 20)
        return FrameFault::Short;
    if (ip[0] >> 4 != 4 || ip[9] != protocolUdp)
        return FrameFault::NotUdp;
    if (word(ip + 6) & 0x3FFF) // more fragments, or not the first
        return FrameFault::Fragment;
    const std::size_t headerSize = std::size_t(ip[0] & 0x0F) * 4;
    if (headerSize < 20 || ipSize < headerSize + 8)
        return FrameFault::Short;
    const std::uint8_t *udp = ip + headerSize;
    const std::size_t udpSize = word(udp + 4);
    if (udpSize < 8 || ipSize < headerSize + udpSize)
        return FrameFault::Short;
    datagram.source = longWord(ip + 12);
    datagram.destination = longWord(ip + 16);
    datagram.sourcePort = word(udp);
    datagram.destinationPort = word(udp + 2);
    datagram.payload = udp + 8;
    datagram.size = udpSize - 8;
    return FrameFault::None;
}

std::array<std::uint8_t, frameHeaderSize> makeFrameHeader(const Datagram &datagram) {
    std::array<std::uint8_t, frameHeaderSize> header{};
    for (int i = 0; i < 6; ++i)
        header[i] = 0xFF;
    header[6] = 0x02; // locally administered: 02:00:00:00:00:01
    header[11] = 0x01;
    setWord(&header[12], etherTypeIpv4);
    std::uint8_t *ip = &header[14];
    ip[0] = 0x45; // version 4, no options
    setWord(ip + 2, std::uint16_t(28 + datagram.size));
    setWord(ip + 6, 0x4000); // do not fragment
    ip[8] = 64;              // time to live
    ip[9] = protocolUdp;
    setLongWord(ip + 12, datagram.source);
    setLongWord(ip + 16, datagram.destination);
    setWord(ip + 10, headerChecksum(ip));
    std::uint8_t *udp = ip + 20;
    setWord(udp, datagram.sourcePort);
    setWord(udp + 2, datagram.destinationPort);
    setWord(udp + 4, std::uint16_t(8 + datagram.size));
    return header;
}

} // namespace hermes
