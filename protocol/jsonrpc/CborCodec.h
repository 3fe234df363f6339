#pragma once

#include "protocol/jsonrpc/CborContent.h"

namespace hermes {

/// The framing `cbor`: the length of the frame as 4 bytes, the highest first, then one item of CBOR; arrays
/// of numbers as typed arrays. A frame over the limit gives one error at once and is skipped without being
/// buffered.
class CborCodec : public CborContent {
public:
    static constexpr int defaultFrameLimit = 16 << 20;

    CborCodec()
        : CborContent(defaultFrameLimit) {}

    bool isMidFrame() const override { return toSkip_ > 0 || !frame_.isEmpty(); }
    void joinBatch(std::vector<QByteArray> &frames) const override;
    QByteArray forSubscription(const QByteArray &notification, quint64 subscription,
                               quint64 dropped) const override;

protected:
    std::vector<CodecFrame> splitFrames(const QByteArray &bytes) override;
    void forgetFrame() override;
    QByteArray frame(const Outgoing &message, std::optional<QString> &path) override;

private:
    QByteArray frame_; // the one begun, with its length
    quint64 toSkip_ = 0;
};

} // namespace hermes
