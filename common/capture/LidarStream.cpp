#include "common/capture/LidarStream.h"

namespace hermes {

using velodyne::PacketFault;
using velodyne::TurnAssembler;

void LidarStream::take(const Datagram &datagram, std::initializer_list<TurnAssembler *> assemblers) {
    if (datagram.size == velodyne::positionPacketSize) {
        if (!choice_.isFromTaken(datagram) ||
            gps_.feed(datagram.payload, datagram.size) != velodyne::PositionFault::None)
            return;
        for (TurnAssembler *assembler : assemblers)
            if (assembler)
                assembler->follow(gps_.state().utc_ns);
        return;
    }
    const PacketFault fault = velodyne::DataPacket::check(datagram.payload, datagram.size, options_.model);
    if (fault == PacketFault::None && !choice_.takes(datagram)) {
        ++otherSensors_;
        return;
    }
    if (fault != PacketFault::None && !isDamaged(datagram, fault)) {
        ++other_;
        return;
    }
    for (TurnAssembler *assembler : assemblers)
        if (assembler)
            assembler->feed(datagram.payload, datagram.size, datagram.stamp_ns);
}

bool LidarStream::isDamaged(const Datagram &datagram, PacketFault fault) const {
    if (fault == PacketFault::Model)
        return choice_.isWanted(datagram);
    const bool likely =
        choice_.taken() || datagram.destinationPort == options_.sensor.port.value_or(options_.dataPort);
    return likely && choice_.mayTake(datagram);
}

} // namespace hermes
