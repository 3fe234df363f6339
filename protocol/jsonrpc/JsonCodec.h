#pragma once

#include "protocol/jsonrpc/Codec.h"

namespace hermes {

/// The framing `json`: one JSON value a line, UTF-8, ended by LF (CR LF accepted); empty lines are ignored.
/// A line over the limit gives one error at once and is skipped up to its LF without being buffered.
class JsonCodec : public Codec {
public:
    static constexpr int defaultFrameLimit = 1 << 20;

    JsonCodec()
        : Codec(defaultFrameLimit) {}

    bool isMidFrame() const override { return skipping_ || !line_.isEmpty(); }
    void joinBatch(std::vector<QByteArray> &frames) const override;
    QByteArray forSubscription(const QByteArray &notification, quint64 subscription,
                               quint64 dropped) const override;

protected:
    std::vector<CodecFrame> splitFrames(const QByteArray &bytes) override;
    std::optional<WireValue> parse(const QByteArray &frame, WireError *error) const override;
    void forgetFrame() override;
    QByteArray frame(const Outgoing &message, std::optional<QString> &path) override;

private:
    void append(const char *bytes, int size, std::vector<CodecFrame> &frames);
    void finishLine(std::vector<CodecFrame> &frames);

    QByteArray line_; // the line begun, without its LF
    bool skipping_ = false;
};

} // namespace hermes
