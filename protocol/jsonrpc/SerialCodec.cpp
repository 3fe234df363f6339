#include "protocol/jsonrpc/SerialCodec.h"

#include <random>

namespace hermes {

// Pieces for who spoke here before must not be taken for those of this end.
SerialCodec::SerialCodec()
    : CborContent(defaultFrameLimit)
    , link_(quint16(std::random_device{}())) {}

std::vector<CodecFrame> SerialCodec::splitFrames(const QByteArray &bytes) {
    link_.setLimit(frameLimit());
    std::vector<CodecFrame> frames;
    for (SerialLink::Arrival &arrival : link_.receive(bytes)) {
        if (arrival.tooLarge)
            frames.push_back({{},
                              RpcError(ErrorCode::OverLimit,
                                       QString("message larger than %1 bytes, skipped").arg(frameLimit()))});
        else
            frames.push_back({std::move(arrival.message), std::nullopt, 0, arrival.inPieces});
    }
    return frames;
}

} // namespace hermes
