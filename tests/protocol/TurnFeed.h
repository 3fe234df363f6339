#pragma once

#include "protocol/velodyne/TurnAssembler.h"
#include "tests/support/Sensor.h"

constexpr std::int64_t second_ns = 1000000000;

/// Gives the sensor's packet of that number to the assembler, 0.2 ms after it was sent.
inline hermes::velodyne::PacketFault feed(hermes::velodyne::TurnAssembler &assembler, const Sensor &sensor,
                                          int number) {
    const auto bytes = sensor.packet(number);
    return assembler.feed(bytes.data(), bytes.size(), sensor.stamp(number) + 200000);
}
