#pragma once

#include "protocol/jsonrpc/CborContent.h"
#include "protocol/serial/SerialLink.h"

namespace hermes {

/// The framing `serial`, for lines that lose and damage bytes: items of CBOR over a SerialLink. What encode()
/// gives is the item; link() makes frames of it when they are to be written.
class SerialCodec : public CborContent {
public:
    static constexpr int defaultFrameLimit = 1 << 20;

    SerialCodec();

    SerialLink *link() override { return &link_; }
    bool isMidFrame() const override { return link_.isMidFrame(); }
    void joinBatch(std::vector<QByteArray> &frames) const override { joinItems(frames); }
    QByteArray forSubscription(const QByteArray &notification, quint64 subscription,
                               quint64 dropped) const override {
        return withSubscription(notification, subscription, dropped);
    }

protected:
    std::vector<CodecFrame> splitFrames(const QByteArray &bytes) override;
    void forgetFrame() override { link_.reset(); }
    QByteArray frame(const Outgoing &message, std::optional<QString> &path) override {
        return written(message, path);
    }

private:
    SerialLink link_;
};

} // namespace hermes
